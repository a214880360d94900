// What clvr asks of HDF5 files. Only in a DecodingChild: damaged files may crash the library.
#pragma once
#include "host/io/volume/samples.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// One data set of numbers, or of something else.
struct Hdf5Dataset {
    std::string path;                     ///< from the file's root
    std::vector<std::int64_t> dims;       ///< slowest axis first, as HDF5 and NumPy count
    std::optional<SampleType> type;       ///< nothing where the values are no real numbers
    std::string type_name;                ///< "i16", "text", "compound", ...
    std::vector<std::int64_t> chunk_dims; ///< empty where the values are not in chunks
};

/// An open file; what it throws names it.
class Hdf5File {
public:
    /// Throws Error{input} where the library cannot open it.
    explicit Hdf5File(std::string path);
    ~Hdf5File();
    Hdf5File(const Hdf5File&) = delete;
    Hdf5File& operator=(const Hdf5File&) = delete;

    const std::string& path() const { return path_; }
    bool is_group(const std::string& object) const;
    bool is_dataset(const std::string& object) const;
    /// The data sets in a group and in the groups inside it, in the order of their names; at most some thousands.
    std::vector<Hdf5Dataset> datasets(const std::string& group) const;
    Hdf5Dataset dataset(const std::string& path) const;

    /// The values of an attribute as numbers; empty where it is not there or holds none.
    std::vector<double> numbers(const std::string& object, const std::string& attribute) const;
    /// The texts of an attribute; empty where it is not there or holds none.
    std::vector<std::string> texts(const std::string& object, const std::string& attribute) const;
    /// An attribute as one text, also where each letter is a value of its own, as Imaris writes; empty where it is not there.
    std::string text(const std::string& object, const std::string& attribute) const;

    /// All values of a small data set as numbers; empty where it is not there, holds none or more than a million.
    std::vector<double> values(const std::string& dataset) const;

    /// Throws Error{input} unless the values of `d` can be in the file and its filters are there to decode them.
    void check_readable(const Hdf5Dataset& d) const;
    using Receive = std::function<void(const void* values, std::size_t bytes)>;
    /// The values start[i] <= index[i] < start[i] + count[i], in pieces, in the order of the file's axes, as samples of d.type in this
    /// machine's byte order. Call check_readable before. Throws Error{input}.
    void read(const Hdf5Dataset& d, const std::vector<std::uint64_t>& start, const std::vector<std::uint64_t>& count,
              const Receive& receive) const;

private:
    void find_datasets(const std::string& group, int depth, std::vector<Hdf5Dataset>& found, int& visited) const;

    std::string path_;
    std::int64_t id_ = -1;
};

} // namespace clvr

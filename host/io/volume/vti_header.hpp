// The XML of a VTK image file: grid, pieces, arrays, and how and where their values are written.
#pragma once
#include "host/io/volume/vti_data.hpp"
#include "host/io/volume/vtk_arrays.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// The values of one array in one piece.
struct VtiValues {
    enum class Format { text, base64, appended } format = Format::text;
    std::string_view inline_text; ///< text and base64; lives as long as the header
    std::uint64_t offset = 0;     ///< appended: in the file
    bool appended_base64 = false;
};

class VtiHeader {
public:
    /// Throws Error{input}: no XML, another kind of VTK file, no array, sizes that do not fit.
    VtiHeader(const std::string& path, std::vector<std::string>& decisions);
    ~VtiHeader();
    VtiHeader(const VtiHeader&) = delete;
    VtiHeader& operator=(const VtiHeader&) = delete;

    const VtkGrid& grid() const { return grid_; }
    bool spaced() const { return spaced_; }
    /// Of the first piece: the others must have the same.
    const std::vector<VtkArray>& arrays() const { return arrays_; }
    const VtiCoding& coding() const { return coding_; }
    std::uint64_t file_size() const { return file_size_; }
    const std::string& path() const { return path_; }

    /// How many time steps the file holds of an array; 1 where it has no times.
    std::int64_t time_steps(const VtkArray& array) const;
    std::size_t pieces() const { return extents_.size(); }
    /// First and last point of a piece on each axis, counted from the grid's first.
    const std::array<std::int64_t, 6>& extent(std::size_t piece) const { return extents_[piece]; }
    /// Throws Error{input} where the piece lacks the array or has it otherwise.
    VtiValues values(std::size_t piece, const VtkArray& array, int time_step) const;

private:
    struct Xml;
    void take_coding(std::vector<std::string>& decisions);
    void take_grid();
    void take_pieces();
    void take_arrays();
    std::array<std::int64_t, 6> extent_of(const char* text, const char* name) const;

    std::string path_;
    std::uint64_t file_size_ = 0;
    std::unique_ptr<Xml> xml_;
    VtiCoding coding_;
    VtkGrid grid_;
    bool spaced_ = false;
    std::array<std::int64_t, 6> whole_{};
    std::vector<std::array<std::int64_t, 6>> extents_;
    std::vector<VtkArray> arrays_;
};

} // namespace clvr

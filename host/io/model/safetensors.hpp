// The safetensors format: named arrays behind a JSON header.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace clvr {

/// An array as the file holds it: little-endian values, row-major.
struct Tensor {
    std::string type;                ///< "F32", "F64", "I32", "I64", "U8"
    std::vector<std::int64_t> shape; ///< empty: a scalar
    std::vector<unsigned char> bytes;

    std::size_t count() const;
    /// The values as floats. Throws Error{input} when the type is another.
    std::vector<float> floats() const;
    std::vector<double> doubles() const;
    std::vector<std::int64_t> integers() const;
};
Tensor float_tensor(std::vector<std::int64_t> shape, const std::vector<float>& values);
Tensor integer_tensor(std::vector<std::int64_t> shape, const std::vector<std::int64_t>& values);

struct TensorFile {
    std::vector<std::pair<std::string, Tensor>> tensors; ///< in the order of their bytes
    std::map<std::string, std::string> metadata;         ///< `__metadata__`

    const Tensor* find(const std::string& name) const;
    /// Throws Error{input} naming the tensor and what there is.
    const Tensor& at(const std::string& name) const;
};

/// Reads and checks a file: header within the file and at most 16 MiB, known types, offsets that follow one another without gap or overlap
/// and agree with the shapes. Throws Error{input}.
TensorFile read_tensors(const std::string& path);
/// The same of a file's bytes; `where` names them in errors.
TensorFile parse_tensors(const std::string& bytes, const std::string& where);
/// Writes the tensors in the given order, the header padded to 8 bytes with spaces; atomically.
void write_tensors(const TensorFile& file, const std::string& path);

} // namespace clvr

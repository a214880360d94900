// NumPy .npy files, byte by byte.
#pragma once
#include "tests/io/volume_writers.hpp"

namespace clvr::test {

/// The header of a .npy file, padded to 64 bytes as NumPy does.
inline std::string numpy_header(const std::string& descr, const std::string& shape, bool fortran = false, int version = 1) {
    std::string text = fmt::format("{{'descr': {}, 'fortran_order': {}, 'shape': {}, }}", descr, fortran ? "True" : "False", shape);
    const std::size_t before = version == 1 ? 10 : 12;
    text += std::string(63 - (before + text.size()) % 64, ' ') + "\n";
    std::string h = std::string("\x93NUMPY") + static_cast<char>(version) + '\0';
    h += version == 1 ? number(static_cast<std::uint16_t>(text.size())) : number(static_cast<std::uint32_t>(text.size()));
    return h + text;
}
inline std::string numpy_shape(const Int3& dims) { return fmt::format("({}, {}, {})", dims[2], dims[1], dims[0]); }
inline std::string numpy(const Sample& s, int version = 1) {
    return numpy_header("'<i2'", numpy_shape(s.dims), false, version) + bytes_of(s.voxels);
}

} // namespace clvr::test

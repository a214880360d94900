// FreeSurfer's MGH files, byte by byte.
#pragma once
#include "tests/io/volume_writers.hpp"

namespace clvr::test {

/// The header with the geometry of `s`; the file's is RAS, around the index dims / 2.
inline std::string mgh_header(const Sample& s, std::int32_t type = 4, std::int32_t frames = 1, bool good_ras = true) {
    std::string h(284, '\0');
    const auto put = [&](std::size_t at, auto value) {
        const std::string bytes = number(value, true);
        h.replace(at, bytes.size(), bytes);
    };
    put(0, std::int32_t{1});
    for (std::size_t i = 0; i < 3; ++i) put(4 + 4 * i, static_cast<std::int32_t>(s.dims[i]));
    put(16, frames);
    put(20, type);
    put(28, static_cast<std::int16_t>(good_ras));
    const Double3 centre = s.geometry.to_world({s.dims[0] / 2.0, s.dims[1] / 2.0, s.dims[2] / 2.0});
    for (std::size_t i = 0; i < 3; ++i) {
        const double to_ras = i < 2 ? -1 : 1;
        put(30 + 4 * i, static_cast<float>(s.geometry.spacing[i]));
        for (std::size_t j = 0; j < 3; ++j) put(42 + 12 * j + 4 * i, static_cast<float>(to_ras * s.geometry.direction.row[i][j]));
        put(78 + 4 * i, static_cast<float>(to_ras * centre[i]));
    }
    return h;
}
inline std::string mgh(const Sample& s) { return mgh_header(s) + bytes_of(s.voxels, true); }

} // namespace clvr::test

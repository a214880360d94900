// MRC and CCP4 maps, byte by byte.
#pragma once
#include "tests/io/volume_writers.hpp"

namespace clvr::test {

struct MrcFields {
    bool big = false, marked = true;
    std::int32_t mode = 1, group = 1, extended_bytes = 0, mz = 0; ///< mz 0: the sections
    std::array<std::int32_t, 3> map{1, 2, 3}, start{0, 0, 0};
    std::array<float, 3> angles{90, 90, 90};
    bool cell = true, origin = true;
    std::int32_t imod_stamp = 0, imod_flags = 0;
};

/// The header for columns, rows and sections of the given numbers, with the geometry of `s` (its axes x, y, z) in angstroms.
inline std::string mrc_header(const Sample& s, const MrcFields& f, std::array<std::int32_t, 3> stored) {
    std::string h(1024, '\0');
    const auto put = [&](std::size_t word, auto value) {
        const std::string bytes = number(value, f.big);
        h.replace(4 * (word - 1), bytes.size(), bytes);
    };
    for (std::size_t i = 0; i < 3; ++i) {
        const auto axis = static_cast<std::size_t>(f.map[i] ? f.map[i] - 1 : static_cast<std::int32_t>(i));
        const std::int32_t intervals = i == 2 && f.mz ? f.mz : stored[i];
        put(1 + i, stored[i]);
        put(5 + i, f.start[i]);
        put(8 + axis, intervals);
        if (f.cell) put(11 + axis, static_cast<float>(s.geometry.spacing[axis] * intervals * 1e7));
        put(14 + i, f.angles[i]);
        put(17 + i, f.map[i]);
        if (f.origin) put(50 + i, static_cast<float>(s.geometry.origin[i] * 1e7));
    }
    put(4, f.mode);
    put(23, f.group);
    put(24, f.extended_bytes);
    put(39, f.imod_stamp);
    put(40, f.imod_flags);
    if (f.marked) h.replace(208, 4, "MAP ");
    h.replace(212, 4, f.big ? std::string("\x11\x11\0\0", 4) : std::string("\x44\x44\0\0", 4));
    return h;
}
inline std::string mrc(const Sample& s, const MrcFields& f = {}) {
    return mrc_header(s, f, {s.dims[0], s.dims[1], s.dims[2]}) + std::string(static_cast<std::size_t>(f.extended_bytes), 'x') +
           bytes_of(s.voxels, f.big);
}

} // namespace clvr::test

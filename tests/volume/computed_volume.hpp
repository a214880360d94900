// What tests ask of volumes that clvr computes.
#pragma once
#include "host/phantom/phantom.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/system/hashes.hpp"
#include "runtime/trust/trust.hpp"
#include "tests/reference/volume.hpp"

#include <string_view>

namespace clvr::testing {

inline Device open_device() { return open_trusted(select_devices().devices.at(0)); }

inline std::string hash_of(const Voxels& v) {
    return sha256_hex(std::string_view(reinterpret_cast<const char*>(v.bytes.data()), v.bytes.size()));
}

/// Hounsfield units of a voxel.
inline double at(const Voxels& v, int x, int y, int z) { return v.slope * reference::stored_at(v, {x, y, z}) + v.intercept; }

/// Mean Hounsfield units of the voxels around a place [mm], which the noise does not move by more than 10.
inline double hounsfield(const Voxels& v, const Double3& pos_world) {
    const Double3 p = v.geometry.to_index(pos_world);
    double sum = 0;
    for (int k = 0; k < 27; ++k)
        sum +=
            reference::stored_at(v, {static_cast<int>(std::lround(p[0])) + k % 3 - 1, static_cast<int>(std::lround(p[1])) + k / 3 % 3 - 1,
                                     static_cast<int>(std::lround(p[2])) + k / 9 - 1});
    return v.slope * sum / 27 + v.intercept;
}

/// Greatest Hounsfield units along a line.
inline double greatest(const Voxels& v, const Double3& from, const Double3& to) {
    double most = -HUGE_VAL;
    for (int k = 0; k <= 200; ++k)
        most = std::max(most, v.slope * reference::interpolate(v, v.geometry.to_index(from + (to - from) * (k / 200.0))) + v.intercept);
    return most;
}

/// Share of the voxels above some Hounsfield units.
inline double above(const Voxels& v, double hu) {
    std::size_t n = 0;
    with_voxel_type(v.type, [&](auto sample) {
        using T = decltype(sample);
        for (std::size_t i = 0; i < v.count(); ++i) n += v.slope * static_cast<double>(v.data<T>()[i]) + v.intercept > hu;
    });
    return static_cast<double>(n) / static_cast<double>(v.count());
}

} // namespace clvr::testing

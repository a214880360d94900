// How often each stored value of an integer type occurs.
#pragma once
#include "host/volume/voxels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace clvr {

/// Calls f(values, count, border) on runs of voxels along x, in slices z0..z1, that lie wholly inside or wholly outside of the border
/// shell: 1/32 of each axis, at least one voxel.
template <class T, class F>
void for_each_run(const Voxels& v, std::size_t z0, std::size_t z1, F&& f) {
    const std::array<std::size_t, 3> n{std::size_t(v.dims[0]), std::size_t(v.dims[1]), std::size_t(v.dims[2])};
    std::array<std::size_t, 3> shell;
    for (std::size_t axis = 0; axis < 3; ++axis) shell[axis] = std::min(std::max<std::size_t>(n[axis] / 32, 1), (n[axis] + 1) / 2);
    const T* row = v.data<T>() + z0 * n[1] * n[0];
    for (std::size_t z = z0; z < z1; ++z)
        for (std::size_t y = 0; y < n[1]; ++y, row += n[0]) {
            const bool inside = z >= shell[2] && z + shell[2] < n[2] && y >= shell[1] && y + shell[1] < n[1] && 2 * shell[0] < n[0];
            const std::size_t begin = inside ? shell[0] : n[0], end = inside ? n[0] - shell[0] : n[0];
            f(row, begin, true);
            f(row + begin, end - begin, false);
            f(row + end, n[0] - end, true);
        }
}

/// In one pass on all cores. Throws nothing; empty counts for f32.
StoredCounts stored_counts(const Voxels& v);

} // namespace clvr

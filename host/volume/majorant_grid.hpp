// The cells of a volume that bound what a ray can meet, and the range of values in each.
#pragma once
#include "host/volume/voxels.hpp"

#include <cstddef>
#include <vector>

namespace clvr {

/// Interpolation at index position p uses the voxels i and i+1 with i = clamp(floor(p), 0, max(n-2, 0)) on each axis; an axis of one voxel
/// uses it twice. A majorant cell holds the positions whose i >> log2(edge) is the cell; the outermost cells reach out to the border of the
/// volume. So cell c needs the voxels edge*c .. edge*c+edge, and there are (max(n-2,0) >> log2) + 1 cells. The edge is 16 voxels, or a
/// power of two more (majorant_log2_edge). The grid belongs to the scene, as the random numbers depend on it; it does not depend on brick
/// edge, residency or device.
struct MajorantGrid {
    int log2_edge = 4;
    Int3 cells{1, 1, 1};
    /// [2 * cells], least and greatest stored value of every voxel that the cell's trilinear support touches; x fastest, then y, z.
    std::vector<float> range;
    std::size_t count() const { return static_cast<std::size_t>(cells[0]) * cells[1] * cells[2]; }
};

/// log2 of the cell edge for a volume: 4, raised by one while the grid would have more than 2^21 cells.
int majorant_log2_edge(const Int3& dims);
/// Ranges from the voxels (two threads; a pass over the data).
MajorantGrid majorant_grid(const Voxels& v);

} // namespace clvr

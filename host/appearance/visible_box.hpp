// The part of a volume that a transfer function shows.
#pragma once
#include "host/appearance/transfer_function.hpp"
#include "host/volume/majorant_grid.hpp"

namespace clvr {

/// The box of index positions, inside [-0.5, n-0.5], that holds every voxel whose opacity is above `threshold` with its trilinear
/// reach (one voxel more on each side); empty (low > high) when none is. Reads only voxels of cells with majorant > threshold.
struct IndexBox {
    Double3 low{0, 0, 0}, high{-1, -1, -1};
    bool empty() const { return low[0] > high[0]; }
};
IndexBox visible_box(const Voxels& v, const MajorantGrid& grid, const TransferTable& table, double threshold);

} // namespace clvr

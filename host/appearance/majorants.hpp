// The greatest opacity that a transfer function gives each cell of a volume.
#pragma once
#include "host/appearance/transfer_function.hpp"
#include "host/volume/majorant_grid.hpp"

#include <vector>

namespace clvr {

/// The table index of a stored value, with exactly the operations and constants of the kernels. It rises with the value even after
/// rounding, so the index of an interpolated value lies between those of its cell's least and greatest value. The subtraction comes first:
/// a volume's lowest value, where tables often begin, then has exactly the index 0, and air stays empty.
struct TableIndex {
    explicit TableIndex(const TransferTable& table)
        : first(static_cast<float>(table.first)), scale(static_cast<float>(table.index_scale())) {}
    float first, scale; ///< stored value of entry 0; entries per stored unit
    /// (stored - first) * scale, clamped to 0 .. 4095.
    float operator()(float stored) const {
        const float i = (stored - first) * scale, last = transfer_entries - 1;
        return !(i > 0) ? 0 : i > last ? last : i;
    }
};

/// Majorant opacity of each cell, 0..1: the greatest table entry in floor(i(min)) .. ceil(i(max)), i the table index clamped to the table.
/// Milliseconds: reads ranges, not voxels.
std::vector<float> majorants(const MajorantGrid& grid, const TransferTable& table);

} // namespace clvr

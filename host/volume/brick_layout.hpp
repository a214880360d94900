// The device layout of a volume: cropped apron bricks in pools.
#pragma once
#include "host/volume/majorant_grid.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace clvr {

/// Where each brick lies. Brick b of an axis serves the bases (lower voxels of an interpolation) edge*b .. edge*b+edge-1. It holds all that
/// their interpolation and gradient read: the voxels edge*b-1 .. edge*b+edge+1, an apron of one voxel below and two above, cropped to the
/// bases that the volume has. Beyond the border of the volume its border voxels repeat. Rows and slices are packed, x fastest. So the whole
/// 4x4x4 neighbourhood of a position lies in one brick. Edge 32 stores at most (35/32)^3 = 1.31 times the voxels; an axis of n < 16 voxels
/// costs a factor of (n+2)/n instead, so thin volumes take larger bricks (brick_log2_edge).
struct BrickLayout {
    int log2_edge = 4;
    Int3 bricks{1, 1, 1};
    Int3 dims{1, 1, 1};
    int pools = 1;                       ///< 1, 2, 4 or 8 buffers
    std::vector<std::uint32_t> offset;   ///< [bricks] in voxels from the pool's start, `absent` for a brick left out
    std::vector<std::uint32_t> pool;     ///< [bricks]
    std::vector<std::size_t> pool_bytes; ///< [pools]
    static constexpr std::uint32_t absent = 0xffffffffu;
    std::size_t stored_bytes() const;        ///< sum of pool_bytes
    std::size_t present() const;             ///< bricks that are stored
    Int3 brick_low(std::size_t brick) const; ///< its first voxel, -1 at the volume's border
    /// Voxels along each axis: min(edge, max(n-1, 1) - edge*b) + 3.
    Int3 brick_length(std::size_t brick) const;
    std::size_t brick_voxels(std::size_t brick) const;
};

/// The usual edge of bricks: 32, or 256 for volumes of at least 4 Mvoxel with an axis below 16 voxels, so that they, too, store at most
/// 1.35 times their voxels (down to an axis of 7).
int brick_log2_edge(const Int3& dims);

/// Which bricks of a layout are needed when cells with majorant > 0 are visible: those that a sample in such a cell, or a gradient tap one
/// voxel away, can read. One more voxel all around keeps a position safe that rounding puts on the far side of a cell's border.
std::vector<char> needed_bricks(const MajorantGrid& grid, const std::vector<float>& cell_majorants, const BrickLayout& layout);

/// Lays out the needed_bricks. `log2_edge` is 3 to 8. Pools are at most `max_pool_bytes` each. Throws Error{device_memory} when 8 pools do
/// not hold it.
BrickLayout brick_layout(const Voxels& v, const MajorantGrid& grid, const std::vector<float>& cell_majorants, int log2_edge,
                         std::size_t max_pool_bytes);

/// Copies bricks out of the voxels, in pieces of at most `piece_bytes`: calls sink(bytes, size, offset_bytes_in_pool) so that the host
/// never holds a second copy of the volume. `bricks`: of one pool, in ascending order.
using PackSink = std::function<void(const unsigned char* bytes, std::size_t size, std::size_t offset)>;
void pack_bricks(const Voxels& v, const BrickLayout& layout, const std::vector<std::size_t>& bricks, std::size_t piece_bytes,
                 const PackSink& sink);

} // namespace clvr

#include "host/volume/brick_layout.hpp"
#include "runtime/error.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <numeric>
#include <utility>

namespace clvr {
namespace {

/// Puts the stored bricks, in their order, into pools of at most `capacity` voxels; returns how many pools that takes.
std::size_t fill_pools(BrickLayout& layout, std::size_t capacity, std::size_t bytes_per_voxel) {
    layout.pool_bytes.assign(1, 0);
    std::size_t filled = 0;
    for (std::size_t b = 0; b < layout.offset.size(); ++b) {
        if (layout.offset[b] == BrickLayout::absent) continue;
        const std::size_t voxels = layout.brick_voxels(b);
        if (filled + voxels > capacity) {
            layout.pool_bytes.push_back(0);
            filled = 0;
        }
        layout.pool[b] = static_cast<std::uint32_t>(layout.pool_bytes.size() - 1);
        layout.offset[b] = static_cast<std::uint32_t>(filled);
        filled += voxels;
        layout.pool_bytes.back() = filled * bytes_per_voxel;
    }
    return layout.pool_bytes.size();
}

/// One brick, rows and slices packed; the volume's border voxels repeat outside it.
template <class T>
void pack_brick(const Voxels& v, const BrickLayout& layout, std::size_t brick, T* to) {
    const Int3 low = layout.brick_low(brick), length = layout.brick_length(brick);
    const auto inside = [&](int at, int axis) { return std::clamp(at, 0, v.dims[axis] - 1); };
    const int first = inside(low[0], 0), last = inside(low[0] + length[0] - 1, 0);
    for (int z = 0; z < length[2]; ++z)
        for (int y = 0; y < length[1]; ++y) {
            const T* row = v.data<T>() + (static_cast<std::size_t>(inside(low[2] + z, 2)) * v.dims[1] + inside(low[1] + y, 1)) * v.dims[0];
            T* const end = to + length[0];
            for (int x = low[0]; x < first; ++x) *to++ = row[first];
            std::memcpy(to, row + first, (last - first + 1) * sizeof(T));
            to += last - first + 1;
            while (to < end) *to++ = row[last];
        }
}

} // namespace

std::size_t BrickLayout::stored_bytes() const { return std::accumulate(pool_bytes.begin(), pool_bytes.end(), std::size_t{0}); }

std::size_t BrickLayout::present() const { return offset.size() - std::count(offset.begin(), offset.end(), absent); }

Int3 BrickLayout::brick_low(std::size_t brick) const {
    const std::size_t row = brick / bricks[0];
    const Int3 at{static_cast<int>(brick % bricks[0]), static_cast<int>(row % bricks[1]), static_cast<int>(row / bricks[1])};
    return {(at[0] << log2_edge) - 1, (at[1] << log2_edge) - 1, (at[2] << log2_edge) - 1};
}

Int3 BrickLayout::brick_length(std::size_t brick) const {
    const Int3 low = brick_low(brick);
    Int3 length;
    for (int a = 0; a < 3; ++a) length[a] = std::min(1 << log2_edge, std::max(dims[a] - 1, 1) - (low[a] + 1)) + 3;
    return length;
}

std::size_t BrickLayout::brick_voxels(std::size_t brick) const {
    const Int3 length = brick_length(brick);
    return static_cast<std::size_t>(length[0]) * length[1] * length[2];
}

int brick_log2_edge(const Int3& dims) {
    const bool thin = std::min({dims[0], dims[1], dims[2]}) < 16, large = 1.0 * dims[0] * dims[1] * dims[2] >= 4e6;
    return thin && large ? 8 : 5;
}

std::vector<char> needed_bricks(const MajorantGrid& grid, const std::vector<float>& cell_majorants, const BrickLayout& layout) {
    std::vector<char> needed(layout.offset.size());
    const auto bricks_of_cell = [&](int cell, int axis) {
        const int first = cell << grid.log2_edge, last_base = std::max(layout.dims[axis] - 2, 0);
        return std::pair{std::max(first - 1, 0) >> layout.log2_edge,
                         std::min(first + (1 << grid.log2_edge), last_base) >> layout.log2_edge};
    };
    const float* majorant = cell_majorants.data();
    for (int cell_z = 0; cell_z < grid.cells[2]; ++cell_z)
        for (int cell_y = 0; cell_y < grid.cells[1]; ++cell_y)
            for (int cell_x = 0; cell_x < grid.cells[0]; ++cell_x) {
                if (!(*majorant++ > 0)) continue;
                const auto [x0, x1] = bricks_of_cell(cell_x, 0);
                const auto [y0, y1] = bricks_of_cell(cell_y, 1);
                const auto [z0, z1] = bricks_of_cell(cell_z, 2);
                for (int z = z0; z <= z1; ++z)
                    for (int y = y0; y <= y1; ++y) {
                        char* row = needed.data() + (static_cast<std::size_t>(z) * layout.bricks[1] + y) * layout.bricks[0];
                        std::fill(row + x0, row + x1 + 1, char{1});
                    }
            }
    return needed;
}

BrickLayout brick_layout(const Voxels& v, const MajorantGrid& grid, const std::vector<float>& cell_majorants, int log2_edge,
                         std::size_t max_pool_bytes) {
    BrickLayout layout;
    layout.log2_edge = log2_edge;
    layout.dims = v.dims;
    for (int a = 0; a < 3; ++a) layout.bricks[a] = (std::max(v.dims[a] - 2, 0) >> log2_edge) + 1;
    const std::size_t count = static_cast<std::size_t>(layout.bricks[0]) * layout.bricks[1] * layout.bricks[2];
    layout.offset.assign(count, BrickLayout::absent);
    layout.pool.assign(count, 0);

    const std::vector<char> needed = needed_bricks(grid, cell_majorants, layout);
    std::size_t total = 0, largest = 0;
    for (std::size_t b = 0; b < count; ++b)
        if (needed[b]) {
            layout.offset[b] = 0;
            total += layout.brick_voxels(b);
            largest = std::max(largest, layout.brick_voxels(b));
        }

    const std::size_t bytes = voxel_bytes(v.type);
    const std::size_t capacity = std::min(max_pool_bytes / bytes, std::size_t{1} << 31);
    const auto too_big = [&] {
        return Error(
            ErrorKind::device_memory,
            fmt::format("the visible part of the volume takes {:.1f} MiB on the device, more than 8 buffers of at most {:.1f} MiB; try a "
                        "transfer function that shows less, a larger --memory, or another --device",
                        total * bytes / 1048576.0, capacity * bytes / 1048576.0));
    };
    if (largest > capacity) throw too_big();
    const std::size_t used = fill_pools(layout, capacity, bytes);
    if (used > 8) throw too_big();
    while (layout.pools < static_cast<int>(used)) layout.pools *= 2;
    // Once more, evenly: a pool that is closed holds more than total / pools, so no further pool is needed.
    fill_pools(layout, std::min(capacity, total / layout.pools + largest), bytes);
    layout.pool_bytes.resize(layout.pools, 0);
    return layout;
}

void pack_bricks(const Voxels& v, const BrickLayout& layout, const std::vector<std::size_t>& bricks, std::size_t piece_bytes,
                 const PackSink& sink) {
    const std::size_t bytes = voxel_bytes(v.type);
    const auto begin = [&](std::size_t i) { return layout.offset[bricks[i]] * bytes; };
    const auto end = [&](std::size_t i) { return begin(i) + layout.brick_voxels(bricks[i]) * bytes; };
    std::vector<unsigned char> piece;
    for (std::size_t first = 0, last; first < bricks.size(); first = last) { // a run of bricks that follow each other in the pool
        for (last = first + 1; last < bricks.size() && begin(last) == end(last - 1) && end(last) - begin(first) <= piece_bytes;) ++last;
        const std::size_t from = begin(first), size = end(last - 1) - from;
        piece.resize(size);
        for_parts(last - first, [&](std::size_t, std::size_t low, std::size_t high) {
            with_voxel_type(v.type, [&](auto sample) {
                using T = decltype(sample);
                for (std::size_t i = first + low; i < first + high; ++i)
                    pack_brick(v, layout, bricks[i], reinterpret_cast<T*>(piece.data() + begin(i) - from));
            });
        });
        for (std::size_t at = 0; at < size; at += piece_bytes) sink(piece.data() + at, std::min(piece_bytes, size - at), from + at);
    }
}

} // namespace clvr

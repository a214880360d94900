#include "host/appearance/visible_box.hpp"
#include "host/appearance/majorants.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace clvr {
namespace {

/// Whether a voxel's opacity is above the threshold: looked up for the small types, computed for f32.
template <class T>
class Visible {
public:
    Visible(const TransferTable& table, double threshold) : table_(table), index_(table), threshold_(threshold) {
        if constexpr (sizeof(T) < 4)
            for (int s = lowest; s <= std::numeric_limits<T>::max(); ++s) known_.push_back(opacity(static_cast<float>(s)) > threshold);
    }
    bool operator()(T stored) const {
        if constexpr (sizeof(T) < 4)
            return known_[stored - lowest] != 0;
        else
            return opacity(stored) > threshold_;
    }

private:
    static constexpr int lowest = sizeof(T) < 4 ? static_cast<int>(std::numeric_limits<T>::lowest()) : 0;
    float opacity(float stored) const {
        const float i = index_(stored);
        const int e = std::min(static_cast<int>(i), transfer_entries - 2);
        return std::fma(i - static_cast<float>(e), table_.opacity[e + 1] - table_.opacity[e], table_.opacity[e]);
    }
    const TransferTable& table_;
    TableIndex index_;
    double threshold_;
    std::vector<char> known_;
};

struct VoxelBox {
    Int3 low{std::numeric_limits<int>::max(), std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
    Int3 high{-1, -1, -1};
    void add(const Int3& low_voxel, const Int3& high_voxel) {
        for (int a = 0; a < 3; ++a) {
            low[a] = std::min(low[a], low_voxel[a]);
            high[a] = std::max(high[a], high_voxel[a]);
        }
    }
    bool has_row(int y, int z) const { return low[1] <= y && y <= high[1] && low[2] <= z && z <= high[2]; }
};

/// Runs of x that a row can be visible in: the visible cells of its cell row, neighbours joined. Ends exclusive.
using Runs = std::vector<std::pair<int, int>>;

Runs runs_of(const MajorantGrid& grid, const float* cell_row, int nx, double threshold) {
    Runs runs;
    for (int c = 0; c < grid.cells[0]; ++c) {
        if (!(cell_row[c] > threshold)) continue;
        const int first = c << grid.log2_edge, end = c + 1 < grid.cells[0] ? (c + 1) << grid.log2_edge : nx;
        if (!runs.empty() && runs.back().second == first)
            runs.back().second = end;
        else
            runs.emplace_back(first, end);
    }
    return runs;
}

/// Extends the box by one row of voxels. A row that the box already spans is only read outside of the box.
template <class T>
void add_row(const T* row, int y, int z, const Runs& runs, const Visible<T>& visible, VoxelBox& box) {
    const bool spanned = box.has_row(y, z);
    const int left_end = spanned ? box.low[0] : std::numeric_limits<int>::max();
    const int first = [&] {
        for (const auto& run : runs)
            for (int x = run.first; x < std::min(run.second, left_end); ++x)
                if (visible(row[x])) return x;
        return -1;
    }();
    if (first < 0 && !spanned) return;
    const int right_end = std::max(box.high[0], first);
    const int last = [&] {
        for (auto run = runs.rbegin(); run != runs.rend(); ++run)
            for (int x = run->second - 1; x > right_end && x >= run->first; --x)
                if (visible(row[x])) return x;
        return right_end;
    }();
    box.add({first < 0 ? box.low[0] : first, y, z}, {last, y, z});
}

template <class T>
VoxelBox visible_voxels(const Voxels& v, const MajorantGrid& grid, const TransferTable& table, double threshold) {
    const std::vector<float> opacity = majorants(grid, table);
    const Visible<T> visible(table, threshold);
    const auto slices = static_cast<std::size_t>(v.dims[2]);
    std::vector<VoxelBox> boxes(part_count(slices));
    for_parts(slices, [&](std::size_t part, std::size_t z0, std::size_t z1) {
        VoxelBox& box = boxes[part];
        Runs runs;
        for (int z = static_cast<int>(z0); z < static_cast<int>(z1); ++z) {
            const int cell_z = std::min(z >> grid.log2_edge, grid.cells[2] - 1);
            for (int y = 0, runs_y = -1; y < v.dims[1]; ++y) {
                const int cell_y = std::min(y >> grid.log2_edge, grid.cells[1] - 1);
                if (cell_y != runs_y) {
                    runs = runs_of(grid, opacity.data() + (static_cast<std::size_t>(cell_z) * grid.cells[1] + cell_y) * grid.cells[0],
                                   v.dims[0], threshold);
                    runs_y = cell_y;
                }
                if (!runs.empty())
                    add_row(v.data<T>() + (static_cast<std::size_t>(z) * v.dims[1] + y) * v.dims[0], y, z, runs, visible, box);
            }
        }
    });
    VoxelBox all;
    for (const VoxelBox& box : boxes) all.add(box.low, box.high);
    return all;
}

} // namespace

IndexBox visible_box(const Voxels& v, const MajorantGrid& grid, const TransferTable& table, double threshold) {
    const VoxelBox voxels =
        with_voxel_type(v.type, [&](auto sample) { return visible_voxels<decltype(sample)>(v, grid, table, threshold); });
    IndexBox box;
    if (voxels.high[0] < 0) return box;
    for (int a = 0; a < 3; ++a) {
        box.low[a] = std::max(voxels.low[a] - 1.0, -0.5);
        box.high[a] = std::min(voxels.high[a] + 1.0, v.dims[a] - 0.5);
    }
    return box;
}

} // namespace clvr

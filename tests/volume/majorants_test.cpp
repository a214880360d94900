#include "host/appearance/majorants.hpp"
#include "host/appearance/visible_box.hpp"
#include "tests/reference/volume.hpp"
#include "tests/volume/random_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace clvr {
namespace {

using namespace clvr::testing;

std::size_t cell_of(const MajorantGrid& grid, const Int3& base) {
    const auto cell = [&](int a) { return static_cast<std::size_t>(base[a] >> grid.log2_edge); };
    return (cell(2) * grid.cells[1] + cell(1)) * grid.cells[0] + cell(0);
}

/// The interpolated opacity in single precision, as host/README.md, "Transfer function" fixes it.
float opacity_at(const Voxels& v, const TransferTable& table, const std::array<float, 3>& pos) {
    int base[3];
    float t[3];
    for (int a = 0; a < 3; ++a) {
        const float p = std::min(std::max(pos[a], 0.0f), static_cast<float>(v.dims[a] - 1));
        base[a] = std::min(static_cast<int>(p), std::max(v.dims[a] - 2, 0));
        t[a] = p - static_cast<float>(base[a]);
    }
    const auto at = [&](int corner) {
        Int3 voxel;
        for (int a = 0; a < 3; ++a) voxel[a] = std::min(base[a] + (corner >> a & 1), v.dims[a] - 1);
        return static_cast<float>(reference::stored_at(v, voxel));
    };
    const auto lerp = [](float a, float b, float s) { return std::fma(s, b - a, a); };
    const auto along_x = [&](int corner) { return lerp(at(corner), at(corner | 1), t[0]); };
    const float value = lerp(lerp(along_x(0), along_x(2), t[1]), lerp(along_x(4), along_x(6), t[1]), t[2]);
    const float i = TableIndex(table)(value);
    const int e = std::min(static_cast<int>(i), transfer_entries - 2);
    return lerp(table.opacity[e], table.opacity[e + 1], i - static_cast<float>(e));
}

TEST(Majorants, BoundEveryInterpolatedExtinction) {
    Random random(1);
    const Int3 shapes[] = {{1, 1, 1}, {2, 2, 2}, {1, 64, 64}, {17, 18, 33}, {257, 5, 3}, {40, 40, 40}, {3, 1, 50}, {48, 16, 34}};
    int points = 0, tight = 0;
    for (int round = 0; round < 2; ++round)
        for (const VoxelType type : all_types)
            for (const Int3& dims : shapes) {
                // Narrow ranges put many voxels at the very values where the table steps.
                const bool narrow = round == 1 && type != VoxelType::f32;
                const Voxels v = narrow ? random_volume(random, type, dims, 20, 40) : random_volume(random, type, dims);
                const Histogram range = stored_histogram(v);
                const double width = range.high - range.low;
                const TransferTable table =
                    random_table(random, narrow ? 10 : range.low - 0.1 * width, narrow ? 50 : range.high + 0.1 * width + 1e-3);
                const MajorantGrid grid = majorant_grid(v);
                const std::vector<float> bound = majorants(grid, table);
                for (int k = 0; k < 12500; ++k, ++points) {
                    std::array<float, 3> pos;
                    Int3 base;
                    for (int a = 0; a < 3; ++a) {
                        pos[a] = static_cast<float>(-0.5 + uniform(random) * dims[a]);
                        if (k % 8 == 0) pos[a] = std::floor(pos[a]); // voxel centres and cell borders
                        base[a] = std::clamp(static_cast<int>(std::floor(pos[a])), 0, std::max(dims[a] - 2, 0));
                    }
                    const float opacity = opacity_at(v, table, pos), majorant = bound[cell_of(grid, base)];
                    ASSERT_LE(opacity, majorant * (1 + 1e-6))
                        << voxel_type_name(type) << " at " << pos[0] << " " << pos[1] << " " << pos[2];
                    tight += opacity > 0.9f * majorant && majorant > 0;
                }
            }
    EXPECT_GE(points, 1000000);
    EXPECT_GT(tight, 1000); // a bound of 1 everywhere would not do
}

TEST(Majorants, AreTheGreatestEntryOverTheSupportOfTheCell) {
    Random random(2);
    for (const VoxelType type : all_types)
        for (const Int3& dims : {Int3{1, 1, 1}, Int3{17, 18, 33}, Int3{34, 2, 50}}) {
            const Voxels v = random_volume(random, type, dims);
            const TransferTable table = random_table(random, -0.7, 90.5);
            const MajorantGrid grid = majorant_grid(v);
            const std::vector<float> bound = majorants(grid, table);
            ASSERT_EQ(bound.size(), grid.count());
            ASSERT_EQ(grid.log2_edge, 4);
            for (int z = 0; z < grid.cells[2]; ++z)
                for (int y = 0; y < grid.cells[1]; ++y)
                    for (int x = 0; x < grid.cells[0]; ++x) {
                        double low = HUGE_VAL, high = -HUGE_VAL;
                        for (int k = 16 * z; k <= std::min(16 * z + 16, dims[2] - 1); ++k)
                            for (int j = 16 * y; j <= std::min(16 * y + 16, dims[1] - 1); ++j)
                                for (int i = 16 * x; i <= std::min(16 * x + 16, dims[0] - 1); ++i) {
                                    low = std::min(low, reference::stored_at(v, {i, j, k}));
                                    high = std::max(high, reference::stored_at(v, {i, j, k}));
                                }
                        const std::size_t c = cell_of(grid, {16 * x, 16 * y, 16 * z});
                        EXPECT_EQ(grid.range[2 * c], low);
                        EXPECT_EQ(grid.range[2 * c + 1], high);
                        float greatest = 0;
                        const TableIndex index(table);
                        for (int e = static_cast<int>(std::floor(index(static_cast<float>(low))));
                             e <= std::ceil(index(static_cast<float>(high))); ++e)
                            greatest = std::max(greatest, table.opacity[e]);
                        EXPECT_EQ(bound[c], greatest);
                    }
        }
}

TEST(Majorants, CoverTheVolumeByCellsOfSixteen) {
    const auto cells = [](const Int3& dims) {
        Voxels v;
        v.dims = dims;
        v.bytes.resize(v.count());
        return majorant_grid(v).cells;
    };
    EXPECT_EQ(cells({1, 1, 1}), (Int3{1, 1, 1}));
    EXPECT_EQ(cells({2, 16, 17}), (Int3{1, 1, 1}));
    EXPECT_EQ(cells({18, 33, 34}), (Int3{2, 2, 3}));
    EXPECT_EQ(cells({257, 258, 3}), (Int3{16, 17, 1}));
}

TEST(Majorants, CellsGrowOnlyWithTheVolume) {
    EXPECT_EQ(majorant_log2_edge({1, 1, 1}), 4);
    EXPECT_EQ(majorant_log2_edge({2049, 2049, 2049}), 4); // 128 cells an axis
    EXPECT_EQ(majorant_log2_edge({2050, 2049, 2049}), 5);
    EXPECT_EQ(majorant_log2_edge({8193, 8193, 8193}), 6);
}

TEST(Majorants, ClampOutsideTheTable) {
    Voxels v;
    v.type = VoxelType::f32;
    v.dims = {2, 1, 1};
    v.bytes.resize(8);
    const float far[2] = {-3e38f, 3e38f};
    std::memcpy(v.bytes.data(), far, 8);
    TransferTable table;
    table.first = 5;
    table.last = 6;
    table.opacity.assign(transfer_entries, 0);
    EXPECT_EQ(majorants(majorant_grid(v), table), std::vector<float>{0});
    table.opacity[2000] = 0.25f;
    EXPECT_EQ(majorants(majorant_grid(v), table), std::vector<float>{0.25f});
    v.dims = {1, 1, 1}; // only -3e38, below the table: its first entry holds
    table.opacity[0] = 0.125f;
    EXPECT_EQ(majorants(majorant_grid(v), table), std::vector<float>{0.125f});
}

TEST(Majorants, LeaveAirEmptyWhereTheTableBeginsAtItsValue) {
    Voxels v;
    v.type = VoxelType::f32;
    v.dims = {1, 1, 1};
    v.bytes.resize(4);
    Random random(6);
    TransferTable table;
    for (int e = 0; e < transfer_entries; ++e) table.opacity.push_back(static_cast<float>(e));
    for (int k = 0; k < 1000; ++k) {
        const float air = static_cast<float>(-1000 + 2000 * uniform(random));
        std::memcpy(v.bytes.data(), &air, 4);
        table.first = air;
        table.last = air + 1 + 3000 * uniform(random);
        ASSERT_EQ(majorants(majorant_grid(v), table), std::vector<float>{0});
    }
}

TEST(Majorants, FollowANegativeSlope) {
    Random random(3);
    Voxels v = random_volume(random, VoxelType::i16, {20, 20, 20}, -100, 100);
    v.slope = -2;
    v.intercept = 10;
    TransferFunction tf; // visible from physical 150 on, which is stored -70 and below
    tf.points = {{-200, {1, 1, 1}, 0}, {150, {1, 1, 1}, 0}, {210, {1, 1, 1}, 1}};
    const TransferTable table = tabulate(tf, v, -100, 100);
    const MajorantGrid grid = majorant_grid(v);
    const std::vector<float> bound = majorants(grid, table);
    for (std::size_t c = 0; c < grid.count(); ++c) {
        const double physical_high = -2 * grid.range[2 * c] + 10;
        EXPECT_NEAR(bound[c], std::max(0.0, (physical_high - 150) / 60), 2e-3);
    }
}

TEST(VisibleBox, HoldsEveryVisibleVoxelWithItsReach) {
    Random random(4);
    for (const VoxelType type : all_types)
        for (const Int3& dims : {Int3{1, 1, 1}, Int3{40, 33, 20}, Int3{1, 50, 18}, Int3{70, 2, 17}})
            for (int visible = 0; visible < 6; ++visible) {
                Voxels v = random_volume(random, type, dims, 0, 10);
                Int3 low = dims, high{-1, -1, -1};
                for (int k = 0; k < visible; ++k) {
                    Int3 voxel;
                    for (int a = 0; a < 3; ++a) {
                        voxel[a] = below(random, dims[a]);
                        low[a] = std::min(low[a], voxel[a]);
                        high[a] = std::max(high[a], voxel[a]);
                    }
                    with_voxel_type(type, [&](auto sample) {
                        const auto bright = static_cast<decltype(sample)>(100);
                        std::memcpy(v.bytes.data() +
                                        ((static_cast<std::size_t>(voxel[2]) * dims[1] + voxel[1]) * dims[0] + voxel[0]) * sizeof bright,
                                    &bright, sizeof bright);
                    });
                }
                TransferTable table;
                table.first = 0;
                table.last = 120;
                for (int e = 0; e < transfer_entries; ++e) table.opacity.push_back(e < 1000 ? 0.01f : 0.5f);
                const IndexBox box = visible_box(v, majorant_grid(v), table, 0.1);
                ASSERT_EQ(box.empty(), visible == 0);
                if (visible == 0) continue;
                for (int a = 0; a < 3; ++a) {
                    EXPECT_EQ(box.low[a], std::max(low[a] - 1.0, -0.5));
                    EXPECT_EQ(box.high[a], std::min(high[a] + 1.0, dims[a] - 0.5));
                }
            }
}

} // namespace
} // namespace clvr

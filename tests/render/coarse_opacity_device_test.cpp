// The coarse grid of opacity: means and emptiness against the voxels, distances against a search, marches against the full lattice.
#include "tests/render/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace clvr::testing {
namespace {

/// A grid with distances in place of each 0, by the kernel.
std::vector<float> with_distances(const std::vector<float>& grid, const shared::int4& cells, int width) {
    Device& device = shared_device();
    Buffer from = device.upload(grid, "grid"), to = device.buffer(from.bytes(), "grid");
    Kernel kernel = device.kernel("volume/distances", {{"CLVR_WIDTH", std::to_string(width)}});
    const float farthest = static_cast<float>(std::max({cells.x, cells.y, cells.z}) + 1);
    for (cl_int axis = 0; axis < 3; ++axis) {
        device.launch(
            kernel,
            {static_cast<std::size_t>((cells.x + width - 1) / width), static_cast<std::size_t>(cells.y), static_cast<std::size_t>(cells.z)},
            {1}, {}, from, cells, axis, farthest, to);
        std::swap(from, to);
    }
    return device.download<float>(from, grid.size());
}

TEST(Distances, AreThoseOfASearch) {
    std::mt19937 random(3);
    for (const shared::int4& cells :
         {shared::int4{7, 5, 6, 2}, shared::int4{1, 9, 2, 2}, shared::int4{4, 1, 1, 3}, shared::int4{70, 3, 2, 2}}) {
        for (const int filled : {0, 1, 3, 40}) {
            const int count = cells.x * cells.y * cells.z;
            std::vector<float> grid(count, 0.0f);
            for (int k = 0; k < filled; ++k) grid[random() % count] = 0.25f;
            const std::vector<float> found = with_distances(grid, cells, 1);
            for (const int width : {4, 8, 16}) ASSERT_EQ(found, with_distances(grid, cells, width)) << width;
            for (int c = 0; c < count; ++c) {
                const auto place = [&](int n) { return Int3{n % cells.x, n / cells.x % cells.y, n / cells.x / cells.y}; };
                int least = std::max({cells.x, cells.y, cells.z}) + 1;
                for (int other = 0; other < count; ++other) {
                    if (!(grid[other] > 0)) continue;
                    int apart = 0;
                    for (int a = 0; a < 3; ++a) apart = std::max(apart, std::abs(place(c)[a] - place(other)[a]));
                    least = std::min(least, apart);
                }
                ASSERT_EQ(found[c], grid[c] > 0 ? grid[c] : -static_cast<float>(least)) << c;
            }
        }
    }
}

/// Spots in anisotropic dims that no cell edge divides.
Voxels spots(const Int3& dims) {
    return volume_of<std::uint8_t>(
        dims, [](int x, int y, int z) { return (x / 5 + y / 7 + z / 6) % 4 == 0 ? 40 + (x * 31 + y * 17 + z * 11) % 200 : 20; });
}

TEST(CoarseOpacity, IsTheMeanOfEachCellAndEmptyWhereNothingInItIsVisible) {
    for (const Int3& dims : {Int3{37, 22, 30}, Int3{9, 1, 40}, Int3{150, 141, 138}}) { // cells of 2 and, in the last, of 4 voxels
        Scene scene = plain_scene(8, 1);
        scene.transfer->points = {{0, {1, 1, 1}, 0}, {60, {1, 1, 1}, 0}, {255, {1, 1, 1}, 1}};
        scene.camera.target = Double3{0, 0, 0}, scene.camera.eye = Double3{0, -50, 0};
        const Stage stage(spots(dims), scene);
        Device& device = shared_device();
        const DeviceVolume uploaded = stage.upload(device);
        const shared::int4 cells =
            volume_params(scene, stage.volume.voxels, stage.volume.grid, stage.classified.table, device_layout(device, stage.classified))
                .coarse;
        const int edge = 1 << cells.w;
        const auto grid = device.download<float>(uploaded.coarse_opacity(), static_cast<std::size_t>(cells.x) * cells.y * cells.z);
        const auto opacity = [&](int x, int y, int z) {
            const Voxels& v = stage.volume.voxels;
            const double value =
                v.bytes[(static_cast<std::size_t>(std::min(z, dims[2] - 1)) * dims[1] + std::min(y, dims[1] - 1)) * dims[0] +
                        std::min(x, dims[0] - 1)];
            return std::max(0.0, (value - 60) / 195);
        };
        int empty = 0;
        std::size_t at = 0;
        for (int z = 0; z < cells.z; ++z)
            for (int y = 0; y < cells.y; ++y)
                for (int x = 0; x < cells.x; ++x, ++at) {
                    double sum = 0, greatest = 0;
                    int count = 0;
                    const auto end = [&](int cell, int axis) { return std::min(edge * (cell + 1), std::max(dims[axis], 2) - 1); };
                    for (int k = edge * z; k <= end(z, 2); ++k)
                        for (int j = edge * y; j <= end(y, 1); ++j)
                            for (int i = edge * x; i <= end(x, 0); ++i) {
                                greatest = std::max(greatest, opacity(i, j, k));
                                if (i < end(x, 0) && j < end(y, 1) && k < end(z, 2)) sum += opacity(i, j, k), ++count;
                            }
                    if (greatest > 0) {
                        ASSERT_GT(grid[at], 0);
                        ASSERT_NEAR(grid[at], sum / count, 1e-4);
                    } else {
                        ASSERT_LE(grid[at], 1e-20) << x << ' ' << y << ' ' << z; // where rounding leaves a doubt, almost nothing
                        empty += grid[at] <= -1;
                    }
                }
        EXPECT_GT(empty, 0);
        EXPECT_LT(empty, static_cast<int>(at));
    }
}

} // namespace
} // namespace clvr::testing

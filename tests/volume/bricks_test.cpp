#include "host/volume/brick_layout.hpp"
#include "runtime/error.hpp"
#include "tests/reference/volume.hpp"
#include "tests/volume/random_volume.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace clvr {
namespace {

using namespace clvr::testing;

constexpr std::size_t no_limit = std::size_t{1} << 40;

std::vector<std::size_t> bricks_of(const BrickLayout& layout, int pool) {
    std::vector<std::size_t> bricks;
    for (std::size_t b = 0; b < layout.offset.size(); ++b)
        if (layout.offset[b] != BrickLayout::absent && layout.pool[b] == static_cast<std::uint32_t>(pool)) bricks.push_back(b);
    return bricks;
}

std::vector<std::vector<unsigned char>> packed(const Voxels& v, const BrickLayout& layout, std::size_t piece_bytes) {
    std::vector<std::vector<unsigned char>> pools;
    for (int p = 0; p < layout.pools; ++p) {
        std::vector<unsigned char> bytes;
        pack_bricks(v, layout, bricks_of(layout, p), piece_bytes, [&](const unsigned char* from, std::size_t size, std::size_t offset) {
            EXPECT_LE(size, piece_bytes);
            EXPECT_EQ(offset, bytes.size());
            bytes.insert(bytes.end(), from, from + size);
        });
        EXPECT_EQ(bytes.size(), layout.pool_bytes[p]);
        pools.push_back(bytes);
    }
    return pools;
}

/// Every voxel of every stored brick is where the kernels look for it: offset + (z * length_y + y) * length_x + x.
void expect_round_trip(const Voxels& v, const BrickLayout& layout, std::size_t piece_bytes) {
    const auto pools = packed(v, layout, piece_bytes);
    const int edge = 1 << layout.log2_edge;
    std::size_t brick = 0, voxels = 0;
    for (int bz = 0; bz < layout.bricks[2]; ++bz)
        for (int by = 0; by < layout.bricks[1]; ++by)
            for (int bx = 0; bx < layout.bricks[0]; ++bx, ++brick) {
                if (layout.offset[brick] == BrickLayout::absent) continue;
                const Int3 low{bx * edge - 1, by * edge - 1, bz * edge - 1};
                Int3 length;
                for (int a = 0; a < 3; ++a) length[a] = std::min(edge, std::max(v.dims[a] - 1, 1) - (low[a] + 1)) + 3;
                const auto& pool = pools.at(layout.pool[brick]);
                voxels += static_cast<std::size_t>(length[0]) * length[1] * length[2];
                for (int z = 0; z < length[2]; ++z)
                    for (int y = 0; y < length[1]; ++y)
                        for (int x = 0; x < length[0]; ++x) {
                            const std::size_t at = layout.offset[brick] + (static_cast<std::size_t>(z) * length[1] + y) * length[0] + x;
                            const Int3 voxel{std::clamp(low[0] + x, 0, v.dims[0] - 1), std::clamp(low[1] + y, 0, v.dims[1] - 1),
                                             std::clamp(low[2] + z, 0, v.dims[2] - 1)};
                            const double stored = with_voxel_type(v.type, [&](auto sample) {
                                std::memcpy(&sample, pool.data() + at * sizeof sample, sizeof sample);
                                return static_cast<double>(sample);
                            });
                            ASSERT_EQ(stored, reference::stored_at(v, voxel)) << "brick " << brick << " at " << x << " " << y << " " << z;
                        }
            }
    EXPECT_EQ(voxels * voxel_bytes(v.type), layout.stored_bytes());
}

TEST(Bricks, RoundTripVoxelByVoxel) {
    Random random(1);
    for (const VoxelType type : all_types)
        for (const Int3& dims : {Int3{1, 1, 1}, Int3{2, 2, 2}, Int3{1, 40, 40}, Int3{17, 18, 33}, Int3{65, 9, 2}, Int3{5, 1, 66}}) {
            const Voxels v = random_volume(random, type, dims);
            const MajorantGrid grid = majorant_grid(v);
            for (const int log2_edge : {3, 4, 5, 6, 8}) {
                const BrickLayout layout = brick_layout(v, grid, std::vector<float>(grid.count(), 1), log2_edge, no_limit);
                EXPECT_EQ(layout.present(), layout.offset.size());
                EXPECT_EQ(layout.pools, 1);
                for (const std::size_t piece : {std::size_t{100}, std::size_t{6000}, no_limit}) expect_round_trip(v, layout, piece);
            }
        }
}

TEST(Bricks, AreStoredExactlyWhereASampleOrGradientTapCanReach) {
    Random random(2);
    for (const Int3& dims : {Int3{1, 1, 1}, Int3{70, 50, 40}, Int3{18, 35, 1}, Int3{33, 34, 49}})
        for (const int log2_edge : {3, 4, 5, 6, 8})
            for (const double share : {0.0, 0.02, 0.3, 1.0}) {
                const Voxels v = random_volume(random, VoxelType::u8, dims);
                const MajorantGrid grid = majorant_grid(v);
                std::vector<float> majorant(grid.count());
                for (auto& m : majorant) m = uniform(random) < share ? 0.5f : 0;
                const BrickLayout layout = brick_layout(v, grid, majorant, log2_edge, no_limit);
                std::set<std::size_t> reached;
                Int3 base;
                const auto touch = [&](const Int3& tap) {
                    Int3 b;
                    for (int a = 0; a < 3; ++a) b[a] = std::clamp(tap[a], 0, std::max(dims[a] - 2, 0)) >> log2_edge;
                    reached.insert((static_cast<std::size_t>(b[2]) * layout.bricks[1] + b[1]) * layout.bricks[0] + b[0]);
                };
                for (base[2] = 0; base[2] <= std::max(dims[2] - 2, 0); ++base[2])
                    for (base[1] = 0; base[1] <= std::max(dims[1] - 2, 0); ++base[1])
                        for (base[0] = 0; base[0] <= std::max(dims[0] - 2, 0); ++base[0]) {
                            if (!(majorant[((base[2] >> 4) * grid.cells[1] + (base[1] >> 4)) * grid.cells[0] + (base[0] >> 4)] > 0))
                                continue;
                            for (int tap = 0; tap < 27; ++tap)
                                touch({base[0] + tap % 3 - 1, base[1] + tap / 3 % 3 - 1, base[2] + tap / 9 - 1});
                        }
                for (std::size_t b = 0; b < layout.offset.size(); ++b)
                    ASSERT_EQ(layout.offset[b] != BrickLayout::absent, reached.count(b) == 1)
                        << "brick " << b << " of edge 2^" << log2_edge;
                expect_round_trip(v, layout, 5000);
            }
}

TEST(Bricks, SplitIntoPoolsThatFit) {
    Random random(3);
    const Voxels v = random_volume(random, VoxelType::i16, {100, 90, 80});
    const MajorantGrid grid = majorant_grid(v);
    const std::vector<float> visible(grid.count(), 1);
    const std::size_t total = brick_layout(v, grid, visible, 4, no_limit).stored_bytes(), brick_bytes = 2 * 19 * 19 * 19;
    for (const auto& [limit, pools] : {std::pair{total, 1},
                                       {total - 2, 2},
                                       {total / 2 + brick_bytes, 2},
                                       {total / 3 + brick_bytes, 4},
                                       {total / 5 + brick_bytes, 8},
                                       {total / 8 + brick_bytes, 8}}) {
        const BrickLayout layout = brick_layout(v, grid, visible, 4, limit);
        EXPECT_EQ(layout.pools, pools);
        ASSERT_EQ(layout.pool_bytes.size(), static_cast<std::size_t>(pools));
        for (const std::size_t bytes : layout.pool_bytes) {
            EXPECT_LE(bytes, limit);
            EXPECT_GT(bytes, 0u);
        }
        EXPECT_EQ(layout.stored_bytes(), total);
        expect_round_trip(v, layout, 1 << 16);
    }
}

TEST(Bricks, ThatDoNotFitAreAMemoryError) {
    Random random(4);
    const Voxels v = random_volume(random, VoxelType::f32, {40, 40, 40});
    const MajorantGrid grid = majorant_grid(v);
    for (const std::size_t limit : {std::size_t{0}, std::size_t{1000}, v.bytes.size() / 9}) try {
            brick_layout(v, grid, std::vector<float>(grid.count(), 1), 4, limit);
            ADD_FAILURE() << "no error at " << limit;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::device_memory);
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
        }
}

TEST(Bricks, OfAnInvisibleVolumeTakeNothing) {
    Random random(5);
    const Voxels v = random_volume(random, VoxelType::u8, {40, 40, 40});
    const MajorantGrid grid = majorant_grid(v);
    const BrickLayout layout = brick_layout(v, grid, std::vector<float>(grid.count(), 0), 4, 1000);
    EXPECT_EQ(layout.present(), 0u);
    EXPECT_EQ(layout.pools, 1);
    EXPECT_EQ(layout.pool_bytes, std::vector<std::size_t>{0});
    pack_bricks(v, layout, bricks_of(layout, 0), 100,
                [](const unsigned char*, std::size_t, std::size_t) { ADD_FAILURE() << "nothing to pack"; });
}

TEST(Bricks, OfMoreThan2To31And2To33VoxelsLieWhereTheyShould) {
    for (const Int3& dims :
         {Int3{2048, 1024, 1025}, Int3{46341, 46342, 1}, Int3{2048, 2048, 2049}, Int3{131072, 65537, 1}, Int3{3, 5, 600000000}})
        for (const VoxelType type : {VoxelType::u8, VoxelType::f32}) {
            SCOPED_TRACE(testing::PrintToString(dims));
            Voxels v; // without its bytes: a layout asks for the size alone
            v.type = type;
            v.dims = dims;
            ASSERT_GT(v.count(), std::size_t{1} << 31);
            MajorantGrid grid;
            grid.log2_edge = majorant_log2_edge(dims);
            for (int a = 0; a < 3; ++a) grid.cells[a] = (std::max(dims[a] - 2, 0) >> grid.log2_edge) + 1;
            ASSERT_LE(grid.count(), std::size_t{1} << 21);
            const int log2_edge = brick_log2_edge(dims);
            const BrickLayout layout = brick_layout(v, grid, std::vector<float>(grid.count(), 1), log2_edge, no_limit);
            std::uint64_t stored = 1; // voxels of all bricks: the lengths along each axis, multiplied
            for (int a = 0; a < 3; ++a) {
                const std::int64_t bases = std::max(dims[a] - 1, 1), bricks = ((bases - 1) >> log2_edge) + 1;
                EXPECT_EQ(layout.bricks[a], bricks);
                stored *= static_cast<std::uint64_t>(bases + 3 * bricks);
            }
            EXPECT_EQ(layout.present(), layout.offset.size());
            EXPECT_EQ(layout.stored_bytes(), stored * voxel_bytes(type));
            std::vector<std::uint64_t> filled(layout.pool_bytes.size());
            for (std::size_t b = 0; b < layout.offset.size(); ++b) {
                ASSERT_EQ(layout.offset[b], filled[layout.pool[b]]) << b;
                filled[layout.pool[b]] += layout.brick_voxels(b);
            }
            for (std::size_t k = 0; k < filled.size(); ++k) {
                EXPECT_EQ(layout.pool_bytes[k], filled[k] * voxel_bytes(type));
                EXPECT_LE(filled[k], std::uint64_t{1} << 31);
            }
            const std::size_t last = layout.offset.size() - 1;
            for (int a = 0; a < 3; ++a) // the last brick ends one voxel beyond the volume
                EXPECT_EQ(layout.brick_low(last)[a] + layout.brick_length(last)[a], std::max(dims[a], 2) + 1);
            EXPECT_EQ(v.geometry.to_world({dims[0] - 0.5, dims[1] - 0.5, dims[2] - 0.5})[2], dims[2] - 0.5);
        }
}

TEST(Bricks, TakeAtMostAThirdMoreThanTheVoxels) {
    for (const Int3& dims : {Int3{256, 256, 256}, Int3{162, 162, 162}, Int3{512, 512, 20}, Int3{2048, 2048, 16}, Int3{1024, 19, 257},
                             Int3{1024, 15, 300}, Int3{10, 1000, 401}, Int3{1024, 1024, 7}}) {
        Voxels v;
        v.dims = dims;
        v.bytes.resize(v.count());
        ASSERT_GE(v.count(), 4000000u);
        const MajorantGrid grid = majorant_grid(v);
        const BrickLayout layout = brick_layout(v, grid, std::vector<float>(grid.count(), 1), brick_log2_edge(dims), no_limit);
        EXPECT_LE(static_cast<double>(layout.stored_bytes()), 1.35 * static_cast<double>(v.count()));
    }
}

} // namespace
} // namespace clvr

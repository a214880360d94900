// The automatic transfer function: background vanishes, structure shows, whatever the values mean.
#include "host/appearance/transfer_function.hpp"
#include "host/volume/value_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

namespace clvr {
namespace {

constexpr int edge = 48;

/// A volume whose voxel values are f(distance from the centre in 0..1 at the faces, noise in -1..1).
template <class T>
Voxels ball(VoxelType type, const std::function<double(double, double)>& f, int n = edge) {
    Voxels v;
    v.type = type;
    v.dims = {n, n, n};
    v.bytes.resize(v.count() * sizeof(T));
    std::uint32_t state = 1;
    std::size_t i = 0;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x, ++i) {
                state = state * 1664525u + 1013904223u;
                const Double3 p{2 * (x + 0.5) / n - 1, 2 * (y + 0.5) / n - 1, 2 * (z + 0.5) / n - 1};
                const T value = static_cast<T>(f(norm(p), (state >> 8) / 8388608.0 - 1));
                std::memcpy(v.bytes.data() + i * sizeof(T), &value, sizeof(T));
            }
    return v;
}

double soft(double edge0, double edge1, double r) { return std::min(std::max((edge1 - r) / (edge1 - edge0), 0.0), 1.0); }

struct Classified {
    Voxels voxels;
    TransferFunction tf;
    TransferTable table;
    explicit Classified(Voxels v) : voxels(std::move(v)) {
        const Histogram h = stored_histogram(voxels);
        tf = automatic_transfer_function(voxels, h);
        table = tabulate(tf, voxels, h.low, h.high);
    }
    double opacity(double stored) const {
        const double index = std::min(std::max((stored - table.first) * table.index_scale(), 0.0), transfer_entries - 1.0);
        return table.opacity[static_cast<std::size_t>(index + 0.5)];
    }
};

TEST(AutomaticTransferTest, NoiseVanishesAndTheObjectIsSolid) {
    // Air 10 +- 8, an object of 150 +- 10 with a soft surface, as an MR or industrial CT has them.
    const Classified c(ball<std::uint8_t>(VoxelType::u8, [](double r, double noise) {
        const double inside = soft(0.55, 0.65, r);
        return 10 + 8 * noise + inside * (140 + 2 * noise);
    }));
    for (int air = 0; air <= 18; ++air) EXPECT_EQ(c.opacity(air), 0) << air;
    EXPECT_GT(c.opacity(150), 0.5);
    EXPECT_GT(c.table.visible_width, 50);
}

TEST(AutomaticTransferTest, ATableAtTheBorderIsBackground) {
    // A slab of 40 along the lower face, as a scanner's table: nearer to the border than to the object.
    Voxels v = ball<std::uint8_t>(VoxelType::u8, [](double r, double noise) { return soft(0.5, 0.6, r) * (130 + 10 * noise); });
    for (int z = 0; z < 3; ++z)
        for (int i = 0; i < edge * edge; ++i)
            v.bytes[static_cast<std::size_t>(z * edge * edge + i)] = static_cast<unsigned char>(38 + i % 5);
    const Classified c(v);
    EXPECT_EQ(c.opacity(42), 0);
    EXPECT_GT(c.opacity(130), 0.3);
}

TEST(AutomaticTransferTest, WhatWrapsDenseStructureIsClear) {
    const auto layered = [](double core) {
        return [core](double r, double noise) { return 80 * soft(0.78, 0.84, r) + 2 * noise + (r < core ? 100 : 0) + 3; };
    };
    const Classified wrapped(ball<std::uint8_t>(VoxelType::u8, layered(0.4)));
    EXPECT_GT(wrapped.opacity(80), 0);
    EXPECT_LT(wrapped.opacity(80), 0.06) << "flesh lets the core be seen";
    EXPECT_GT(wrapped.opacity(180), 0.5);
    const Classified bare(ball<std::uint8_t>(VoxelType::u8, layered(0.82)));
    EXPECT_GT(bare.opacity(180), 0.5);
}

TEST(AutomaticTransferTest, AFieldIsHazeAroundACore) {
    const Classified c(ball<float>(VoxelType::f32, [](double r, double) { return 1e-3 * std::exp(-8 * r * r); }));
    EXPECT_LT(c.opacity(1e-4), 0.1);
    EXPECT_GT(c.opacity(1e-3), 0.4);
}

TEST(AutomaticTransferTest, ASignedFieldShowsBothSides) {
    const Classified c(ball<float>(VoxelType::f32, [](double r, double noise) {
        return (r < 0.3 ? 5 * (0.3 - r) : r < 0.6 ? -5 * (0.3 - std::fabs(r - 0.45) * 2) * (r > 0.3) : 0) + 1e-3 * noise;
    }));
    EXPECT_EQ(c.opacity(0), 0);
    EXPECT_GT(c.opacity(1.2), 0.2);
    EXPECT_GT(c.opacity(-1.2), 0.2);
}

TEST(AutomaticTransferTest, DarkStructureOnBrightGroundShows) {
    const Classified c(ball<std::uint8_t>(VoxelType::u8, [](double r, double noise) { return 230 + 5 * noise - 180 * soft(0.5, 0.6, r); }));
    EXPECT_EQ(c.opacity(230), 0);
    EXPECT_GT(c.opacity(50), 0.3);
}

TEST(AutomaticTransferTest, OutliersDoNotHideTheStructure) {
    Voxels v = ball<float>(VoxelType::f32, [](double r, double noise) { return soft(0.5, 0.6, r) + 0.01 * noise; });
    const float outliers[2] = {1e30f, -1e25f};
    std::memcpy(v.bytes.data() + 4 * 1000, outliers, sizeof outliers);
    const Classified c(v);
    EXPECT_EQ(c.opacity(0.01), 0);
    EXPECT_GT(c.opacity(1), 0.3);
}

Voxels head(double slope, double intercept, double noise_scale = 20) {
    Voxels v = ball<std::int16_t>(VoxelType::i16, [=](double r, double noise) {
        const double hu = (r < 0.75 ? 40 : r < 0.8 ? -100 : -1000) + (r > 0.55 && r < 0.62 ? 900 : 0) + noise_scale * noise;
        return std::lround((hu - intercept) / slope);
    });
    v.slope = slope;
    v.intercept = intercept;
    return v;
}

TEST(AutomaticTransferTest, HounsfieldUnitsAreKnownByTheirValues) {
    for (auto [slope, intercept] : {std::pair{1.0, 0.0}, {1.0, -1024.0}, {2.0, -1000.0}, {-1.0, 500.0}}) {
        const Classified c(head(slope, intercept));
        const auto at = [&, s = slope, i = intercept](double hu) { return c.opacity((hu - i) / s); };
        EXPECT_EQ(at(-1000), 0);
        EXPECT_EQ(at(-700), 0);
        EXPECT_GT(at(40), 0);
        EXPECT_LT(at(40), 0.1);
        EXPECT_GT(at(900), 0.8);
        for (std::size_t k = 1; k < c.tf.points.size(); ++k) EXPECT_LE(c.tf.points[k - 1].value, c.tf.points[k].value);
    }
    Voxels mr = head(1, 0);
    mr.modality = "MR";
    EXPECT_NE(to_json(automatic_transfer_function(mr, stored_histogram(mr))), to_json(Classified(head(1, 0)).tf))
        << "the file says that it is not CT";
}

TEST(AutomaticTransferTest, ANegativeSlopeMirrorsIt) {
    Voxels v = ball<std::uint8_t>(VoxelType::u8, [](double r, double noise) { return 10 + 5 * noise + 120 * soft(0.5, 0.6, r); });
    v.slope = -2;
    v.intercept = 7;
    const Classified c(v);
    EXPECT_EQ(c.opacity(12), 0);
    EXPECT_GT(c.opacity(130), 0.3);
    for (std::size_t k = 1; k < c.tf.points.size(); ++k) EXPECT_LE(c.tf.points[k - 1].value, c.tf.points[k].value);
}

TEST(AutomaticTransferTest, EveryVolumeHasOne) {
    std::vector<Voxels> volumes;
    const auto add = [&](VoxelType type, Int3 dims, const std::function<double(std::size_t)>& f) {
        Voxels v;
        v.type = type;
        v.dims = dims;
        v.bytes.resize(v.count() * voxel_bytes(type));
        with_voxel_type(type, [&](auto t) {
            for (std::size_t i = 0; i < v.count(); ++i) {
                t = static_cast<decltype(t)>(f(i));
                std::memcpy(v.bytes.data() + i * sizeof t, &t, sizeof t);
            }
        });
        volumes.push_back(v);
    };
    const float most = std::numeric_limits<float>::max();
    for (VoxelType type : {VoxelType::u8, VoxelType::i8, VoxelType::u16, VoxelType::i16, VoxelType::f32}) {
        add(type, {1, 1, 1}, [](std::size_t) { return 7; });
        add(type, {1, 9, 9}, [](std::size_t i) { return i % 3; });
        add(type, {8, 8, 8}, [](std::size_t) { return 0; });
        add(type, {8, 8, 8}, [](std::size_t i) { return i == 100 ? 1 : 0; });
        add(type, {8, 8, 8}, [](std::size_t i) { return i == 0 ? 0 : 1; });
        add(type, {16, 16, 1}, [](std::size_t i) { return i % 100; });
        add(type, {6, 6, 6}, [](std::size_t i) { return (i * 7919) % 127; });
    }
    add(VoxelType::u16, {16, 16, 16}, [](std::size_t i) { return i % 2 ? 65535 : 0; });
    add(VoxelType::f32, {8, 8, 8}, [&](std::size_t i) { return i % 2 ? most : -most; });
    add(VoxelType::f32, {8, 8, 8}, [](std::size_t i) { return i % 2 ? 1e-42 : 0; });
    add(VoxelType::f32, {8, 8, 8}, [](std::size_t i) { return 1 + 1e-7 * static_cast<double>(i); });
    for (std::size_t i = 0; i < volumes.size(); ++i) {
        SCOPED_TRACE(i);
        Classified c(volumes[i]);
        validate(c.tf, "auto");
        EXPECT_EQ(c.tf.name, "auto");
        EXPECT_LT(c.table.first, c.table.last);
        for (float o : c.table.opacity) ASSERT_TRUE(o >= 0 && o <= 1);
        EXPECT_GT(c.table.visible_width, 0) << "something can be seen";
    }
}

TEST(ValueCountsTest, TheBorderIsAShellOfA32ndPart) {
    Voxels v;
    v.type = VoxelType::u8;
    v.dims = {64, 5, 3};
    v.bytes.assign(v.count(), 1);
    for (int z = 1; z < 2; ++z)
        for (int y = 1; y < 4; ++y)
            for (int x = 2; x < 62; ++x) v.bytes[static_cast<std::size_t>((z * 5 + y) * 64 + x)] = 3;
    const ValueCounts counts = value_counts(v, stored_histogram(v));
    EXPECT_EQ(counts.all, (std::vector<std::uint64_t>{780, 0, 180}));
    EXPECT_EQ(counts.border, (std::vector<std::uint64_t>{780, 0, 0}));
    EXPECT_EQ(counts.value(2), 3);
}

} // namespace
} // namespace clvr

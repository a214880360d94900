// Sobol's points: against a plain implementation, their stratification, their independence, and what they do to a picture's noise.
#include "kernels/shared/render_params.h"
#include "tests/reference/random.hpp"
#include "tests/render/kernel_under_test.hpp"
#include "tests/render/scenes.hpp"
#include "tests/render/statistics.hpp"

#include <fmt/format.h>

#include <random>
#include <set>

namespace clvr::testing {
namespace {

struct Point {
    float x, y;
};
struct Place {
    std::uint32_t pixel, sample, purpose, unused = 0;
};

struct Sobol : ::testing::Test {
    Device& device = shared_device();
    std::array<std::uint32_t, 2> key{0x12345678u, 0x9abcdef0u};

    std::vector<Point> points(const std::vector<Place>& places) {
        Kernel kernel = test_kernel(device, "sobol_values", {{"CLVR_WIDTH", "1"}});
        shared::RenderParams render{};
        render.key0 = key[0], render.key1 = key[1];
        const Buffer params = device.upload(std::vector{render}, "render"), in = device.upload(places, "places");
        const Buffer out = device.buffer(8 * places.size(), "points");
        const auto count = static_cast<std::uint32_t>(places.size());
        device.launch(kernel, {count}, {64}, {}, params, in, out, count);
        return device.download<Point>(out, places.size());
    }
    std::vector<Point> set(std::uint32_t pixel, std::uint32_t purpose, std::uint32_t first, std::uint32_t count) {
        std::vector<Place> places;
        for (std::uint32_t s = 0; s < count; ++s) places.push_back({pixel, first + s, purpose});
        return points(places);
    }
};

TEST_F(Sobol, IsThePlainImplementation) {
    std::mt19937 random(3);
    std::vector<Place> places(1 << 14);
    for (Place& p : places)
        p = {static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random() >> random() % 32),
             static_cast<std::uint32_t>(random())};
    const auto found = points(places);
    for (std::size_t i = 0; i < places.size(); ++i) {
        const auto truth = reference::sobol(places[i].pixel, places[i].sample, places[i].purpose, key);
        ASSERT_EQ(found[i].x, static_cast<float>(truth[0] >> 9) * 0x1p-23f);
        ASSERT_EQ(found[i].y, static_cast<float>(truth[1] >> 9) * 0x1p-23f);
    }
}

TEST_F(Sobol, EverySplitOfTheSquareHoldsOnePointABox) {
    for (const auto& [pixel, purpose, block] : {std::array{0u, 0u, 0u}, std::array{77u, 4u, 3u}, std::array{123456u, ~0u, 1000u}})
        for (unsigned log2 = 1; log2 <= 10; ++log2) {
            const auto p = set(pixel, purpose, block << log2, 1u << log2);
            for (unsigned along_x = 0; along_x <= log2; ++along_x) {
                std::set<std::pair<int, int>> boxes;
                for (const auto& q : p)
                    boxes.emplace(std::ldexp(q.x, static_cast<int>(along_x)), std::ldexp(q.y, static_cast<int>(log2 - along_x)));
                EXPECT_EQ(boxes.size(), p.size()) << p.size() << " points, " << (1u << along_x) << " columns";
            }
        }
}

/// Of many pixels the same sample, one coordinate against another: evenly over the square.
TEST_F(Sobol, PointsOfDifferentSetsKnowNothingOfEachOther) {
    constexpr std::uint32_t n = 1 << 18;
    constexpr int bins = 16;
    const auto of = [&](std::uint32_t sample, std::uint32_t purpose, std::uint32_t first) {
        std::vector<Place> places;
        for (std::uint32_t i = 0; i < n; ++i) places.push_back({first + i, sample, purpose});
        return points(places);
    };
    const auto a = of(0, 5, 0), other_purpose = of(0, 6, 0), neighbour = of(0, 5, 1), later = of(1, 7, 0);
    key[0] ^= 1;
    const auto other_frame = of(0, 5, 0);
    const auto even = [](const char* what, const std::vector<Point>& p, float Point::*x, const std::vector<Point>& q, float Point::*y) {
        std::vector<double> counts(bins * bins, 0);
        for (std::uint32_t i = 0; i < n; ++i) ++counts[static_cast<int>(p[i].*x * bins) * bins + static_cast<int>(q[i].*y * bins)];
        expect_counts(counts, std::vector<double>(bins * bins, n / double{bins * bins}), what);
    };
    even("one point's coordinates", a, &Point::x, a, &Point::y);
    even("another purpose", a, &Point::x, other_purpose, &Point::x);
    even("another purpose, across", a, &Point::y, other_purpose, &Point::x);
    even("another sample and purpose", a, &Point::x, later, &Point::y);
    even("the next pixel", a, &Point::x, neighbour, &Point::x);
    even("another frame", a, &Point::x, other_frame, &Point::x);
}

TEST_F(Sobol, WhatADecisionLeavesIsUniformAgain) {
    Kernel kernel = test_kernel(device, "rescaled_values", {{"CLVR_WIDTH", "1"}});
    const std::vector<shared::float4> in{{0.25f, 0.25f, 0.75f, 0},
                                         {0.5f, 0.25f, 0.75f, 0},
                                         {0x1.fffffcp-1f, 0.25f, 1, 0},
                                         {0, 0, 1e-7f, 0},
                                         {std::nextafter(1e-7f, 0.0f), 0, 1e-7f, 0},
                                         {0x1.fffffcp-1f, 0x1.fffffap-1f, 1, 0}};
    const Buffer input = device.upload(in, "in"), out = device.buffer(4 * in.size(), "left");
    device.launch(kernel, {in.size()}, {1}, {}, input, out, static_cast<std::uint32_t>(in.size()));
    const auto left = device.download<float>(out, in.size());
    EXPECT_EQ(left[0], 0);
    EXPECT_EQ(left[1], 0.5f);
    for (float u : left) EXPECT_TRUE(u >= 0 && u < 1) << u;
    EXPECT_GT(left[2], 0.999999f);
}

/// At 16 samples the pixels' means must vary by clearly less than those of independent samples, whose variance the frame holds (measured:
/// 0.4 to 0.6).
TEST_F(Sobol, PicturesHaveLessNoiseThanIndependentSamples) {
    for (const Shading shading : {Shading::phase, Shading::gradient}) {
        Scene scene = furnace_scene(shading, 0, 16);
        scene.background = {};
        scene.light.key = 1;
        const Voxels volume = blob(16);
        constexpr int frames = 8;
        std::vector<double> sum, squares;
        double independent = 0;
        for (int k = 0; k < frames; ++k) {
            scene.seed = static_cast<std::uint64_t>(k);
            const Frame f = render(volume, scene);
            const auto& g = f.at("G");
            sum.resize(g.size()), squares.resize(g.size());
            for (std::size_t i = 0; i < g.size(); ++i) sum[i] += g[i], squares[i] += double{g[i]} * g[i];
            independent += mean_of(f.at("variance.G")) / frames;
        }
        double found = 0;
        for (std::size_t i = 0; i < sum.size(); ++i)
            found += (squares[i] - sum[i] * sum[i] / frames) / (frames - 1) / static_cast<double>(sum.size());
        EXPECT_LT(found, 0.75 * independent) << "shading " << static_cast<int>(shading);
        EXPECT_GT(found, 0.1 * independent) << "samples must not be one and the same";
        RecordProperty(fmt::format("ratio_{}", static_cast<int>(shading)), fmt::format("{}", found / independent));
    }
}

} // namespace
} // namespace clvr::testing

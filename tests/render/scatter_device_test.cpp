// Phase function and surface lobe: values against the formulas in double, samples against their densities, energy.
#include "host/render/surface_lobe.hpp"
#include "kernels/shared/types.h"
#include "tests/reference/scatter.hpp"
#include "tests/render/kernel_under_test.hpp"
#include "tests/render/scenes.hpp"
#include "tests/render/statistics.hpp"

#include <algorithm>

namespace clvr::testing {
namespace {

using shared::float4;
enum ScatterFunction { phase_sample, phase_value, surface_sample, surface_value };

float4 packed(const Double3& v) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0}; }
Double3 unpacked(const float4& v) { return {v.x, v.y, v.z}; }

struct Frame3 {
    Double3 a, b, c;
    explicit Frame3(const Double3& axis) : c(axis) {
        a = unit(cross(std::abs(c[2]) < 0.9 ? Double3{0, 0, 1} : Double3{1, 0, 0}, c));
        b = cross(c, a);
    }
    Double3 direction(double cosine, double azimuth) const {
        const double s = std::sqrt(std::max(0.0, 1 - cosine * cosine));
        return a * (s * std::cos(azimuth)) + b * (s * std::sin(azimuth)) + c * cosine;
    }
    /// Turns, 0..1.
    double azimuth(const Double3& d) const {
        const double t = std::atan2(inner(d, b), inner(d, a)) / (2 * pi);
        return t < 0 ? t + 1 : t;
    }
};

struct Scatter : ::testing::Test {
    Device device = shared_device();
    Kernel kernel = test_kernel(device, "scatter_values", {{"CLVR_WIDTH", "1"}});
    Buffer lobe = device.upload(surface_lobe_table(), "lobe");
    float g = 0;
    Double3 normal{0, 0, 1}, out{0, 0, 1}, albedo{1, 1, 1};

    std::vector<float4> run(ScatterFunction function, const std::vector<float4>& in) {
        const Buffer input = device.upload(in, "in"), result = device.buffer(16 * in.size(), "result");
        const auto count = static_cast<std::uint32_t>(in.size());
        device.launch(kernel, {count}, {64}, {}, lobe, g, packed(normal), packed(out), packed(albedo), input, result, count,
                      static_cast<int>(function));
        return device.download<float4>(result, in.size());
    }
    std::vector<float4> samples(ScatterFunction function, std::size_t count) {
        std::mt19937 random(11);
        std::vector<float4> in(count);
        for (auto& u : in) u = {uniform_float(random), uniform_float(random), uniform_float(random), 0};
        return run(function, in);
    }
    /// Values at the midpoints of `polar` cosines in low..1 by `around` azimuths about `axis`.
    std::vector<float4> grid(ScatterFunction function, const Double3& axis, double low, int polar, int around) {
        const Frame3 frame(axis);
        std::vector<float4> in;
        for (int i = 0; i < polar; ++i)
            for (int j = 0; j < around; ++j)
                in.push_back(packed(frame.direction(low + (1 - low) * (i + 0.5) / polar, 2 * pi * (j + 0.5) / around)));
        return run(function, in);
    }
};

struct Phase : Scatter, ::testing::WithParamInterface<double> {
    /// Relative error of the density for a cosine that is off by a few 1e-7, as that of rounded directions is.
    static double rounding(double g) { return 1e-6 + 1e-6 * std::abs(g) / std::pow(1 - std::abs(g), 2); }
};

TEST_P(Phase, DensityIsHenyeyGreensteins) {
    g = static_cast<float>(GetParam());
    out = unit({0.3, -0.5, 0.7});
    constexpr int polar = 256, around = 4;
    const auto found = grid(phase_value, out, -1, polar, around);
    for (int i = 0; i < polar; ++i)
        for (int j = 0; j < around; ++j) {
            const double cosine = -1 + 2 * (i + 0.5) / polar, truth = reference::phase_density(g, cosine);
            EXPECT_NEAR(found[i * around + j].w, truth, rounding(g) * truth) << "cosine " << cosine;
        }
}

TEST_P(Phase, SamplesHaveTheDensity) {
    g = static_cast<float>(GetParam());
    for (const Double3& way : {Double3{0, 0, 1}, Double3{0, 0, -1}, unit({0.3, -0.5, 0.7})}) {
        out = way;
        constexpr std::size_t count = 1 << 18;
        constexpr int bins = 64, turns = 16;
        const Frame3 frame(way);
        std::vector<double> cosines, polar(bins, 0), around(turns, 0), expected(bins);
        for (const float4& s : samples(phase_sample, count)) {
            const Double3 d = unpacked(s);
            ASSERT_NEAR(norm(d), 1, 1e-6);
            const double cosine = std::clamp(inner(d, way), -1.0, 1.0);
            cosines.push_back(cosine);
            ++polar[std::min(bins - 1, static_cast<int>((cosine + 1) / 2 * bins))];
            ++around[std::min(turns - 1, static_cast<int>(frame.azimuth(d) * turns))];
            EXPECT_NEAR(s.w, reference::phase_density(g, cosine), rounding(g) * s.w);
        }
        const Estimate mean = estimate(cosines);
        EXPECT_NEAR(mean.mean, g, 4 * mean.sigma) << "mean cosine";
        for (int k = 0; k < bins; ++k)
            expected[k] = count * (reference::phase_distribution(g, -1 + 2.0 * (k + 1) / bins) -
                                   reference::phase_distribution(g, -1 + 2.0 * k / bins));
        expect_counts(polar, expected, "cosine");
        expect_counts(around, std::vector<double>(turns, count / double{turns}), "azimuth");
    }
}

INSTANTIATE_TEST_SUITE_P(G, Phase, ::testing::Values(0.0, 0.002, 0.3, 0.85, 0.97, -0.6));

struct Surface : Scatter, ::testing::WithParamInterface<double> {
    void SetUp() override {
        normal = unit({0.36, -0.48, 0.8});
        out = Frame3(normal).direction(GetParam(), 0.7);
    }
};

TEST_P(Surface, GlossyPartIsGgx) {
    albedo = {0, 0, 0};
    constexpr int polar = 64, around = 64;
    const auto found = grid(surface_value, normal, -1, polar, around);
    const Frame3 frame(normal);
    for (int i = 0; i < polar; ++i)
        for (int j = 0; j < around; ++j) {
            const double truth =
                reference::glossy_value(normal, out, frame.direction(-1 + 2 * (i + 0.5) / polar, 2 * pi * (j + 0.5) / around));
            EXPECT_NEAR(found[i * around + j].x, truth, 2e-5 * truth);
        }
}

TEST_P(Surface, ReflectsBothWaysAlike) {
    albedo = {0.8, 0.5, 0.1};
    const Double3 first = out, second = Frame3(normal).direction(0.37, 2.9);
    const float4 there = run(surface_value, {packed(second)})[0];
    out = second;
    const float4 back = run(surface_value, {packed(first)})[0];
    const double a = inner(normal, second), b = inner(normal, first);
    EXPECT_NEAR(there.x / a, back.x / b, 1e-5 * there.x / a);
    EXPECT_NEAR(there.y / a, back.y / b, 1e-5 * there.y / a);
    EXPECT_NEAR(there.z / a, back.z / b, 1e-5 * there.z / a);
    normal = normal * -1.0; // turned to the side of out
    EXPECT_NEAR(run(surface_value, {packed(first)})[0].x, back.x, 1e-6 * back.x);
}

TEST_P(Surface, WhiteReflectsAll) {
    constexpr int polar = 512, around = 512;
    double sum = 0;
    for (const float4& v : grid(surface_value, normal, 0, polar, around)) sum += v.x;
    EXPECT_NEAR(sum * 2 * pi / (polar * around), 1, 3e-4); // the table's error
}

TEST_P(Surface, SamplesHaveTheDensity) {
    albedo = {0.7, 0.6, 0.5};
    constexpr std::size_t count = 1 << 18;
    constexpr int bins = 16, fine = 32;
    const Frame3 frame(normal);
    std::vector<double> counts(bins * bins + 1, 0), expected(bins * bins + 1, 0);
    for (const float4& s : samples(surface_sample, count)) {
        const Double3 d = unpacked(s);
        ASSERT_NEAR(norm(d), 1, 1e-5);
        const double cosine = inner(normal, d);
        const int p = static_cast<int>(cosine * bins), a = static_cast<int>(frame.azimuth(d) * bins);
        ++counts[cosine <= 0 ? bins * bins : std::min(p, bins - 1) * bins + std::min(a, bins - 1)];
    }
    const auto density = grid(surface_value, normal, 0, bins * fine, bins * fine);
    double above = 0;
    for (int i = 0; i < bins * fine; ++i)
        for (int j = 0; j < bins * fine; ++j) {
            const double share = density[i * bins * fine + j].w * 2 * pi / (bins * fine * bins * fine);
            expected[i / fine * bins + j / fine] += share * count;
            above += share;
        }
    expected[bins * bins] = count * (1 - above); // reflections that fall below the surface
    EXPECT_LE(above, 1 + 1e-5);
    expect_counts(counts, expected, "directions");
}

/// What the tracer does with them: the mean of value over density is what the surface reflects.
TEST_P(Surface, SampledWeightsMakeTheAlbedo) {
    albedo = {1, 1, 1};
    const auto sampled = samples(surface_sample, 1 << 18);
    const auto values = run(surface_value, sampled);
    std::vector<double> weights;
    for (std::size_t i = 0; i < sampled.size(); ++i) weights.push_back(values[i].w > 0 ? values[i].x / values[i].w : 0);
    const Estimate e = estimate(weights);
    EXPECT_NEAR(e.mean, 1, 4 * e.sigma + 3e-4);
    EXPECT_LE(*std::max_element(weights.begin(), weights.end()), 3) << "weights are bounded";
}

INSTANTIATE_TEST_SUITE_P(Cosine, Surface, ::testing::Values(1.0, 0.9, 0.5, 0.2, 0.05));

} // namespace
} // namespace clvr::testing

// The device table of a transfer function.
#include "host/appearance/transfer_function.hpp"
#include "runtime/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace clvr {
namespace {

TransferFunction::Point point(double value, double opacity, double grey = 0.5) { return {value, {grey, grey, grey}, opacity}; }

Voxels scaled(double slope, double intercept) {
    Voxels v;
    v.slope = slope;
    v.intercept = intercept;
    return v;
}

TransferTable table(const std::vector<TransferFunction::Point>& points, const Voxels& v = scaled(1, 0), double low = 0, double high = 255,
                    bool normalized = false) {
    TransferFunction tf;
    tf.points = points;
    tf.normalized = normalized;
    return tabulate(tf, v, low, high);
}

/// Opacity at a stored value as the kernels find it: index clamped to the table, interpolated.
double opacity_at(const TransferTable& t, double stored) {
    const double index = std::min(std::max((stored - t.first) * t.index_scale(), 0.0), transfer_entries - 1.0);
    const int i = std::min(static_cast<int>(index), transfer_entries - 2);
    return t.opacity[i] + (index - i) * (t.opacity[i + 1] - t.opacity[i]);
}

TEST(TransferTableTest, ARampIsARamp) {
    const TransferTable t = table({point(100, 0, 0), point(200, 1, 1)});
    EXPECT_EQ(t.first, 100);
    EXPECT_EQ(t.last, 200);
    ASSERT_EQ(t.opacity.size(), 4096u);
    ASSERT_EQ(t.color.size(), 4 * 4096u);
    for (int e = 0; e < transfer_entries; ++e) {
        EXPECT_EQ(t.opacity[e], static_cast<float>(e / 4095.0)) << e;
        EXPECT_EQ(t.color[4 * e + 2], static_cast<float>(e / 4095.0)) << e;
        EXPECT_EQ(t.color[4 * e + 3], 0.0f);
    }
    EXPECT_EQ(opacity_at(t, 0), 0);
    EXPECT_EQ(opacity_at(t, 255), 1) << "held outside";
    EXPECT_NEAR(t.visible_width, 100, 0.1);
}

TEST(TransferTableTest, AStepIsARampOfOneEntry) {
    const TransferTable t = table({point(0, 0), point(100, 0), point(100, 0.8), point(200, 0.8)});
    int between = 0;
    for (int e = 1; e < transfer_entries; ++e) {
        EXPECT_TRUE(t.opacity[e] == 0.0f || t.opacity[e] == 0.8f) << e;
        between += t.opacity[e] != t.opacity[e - 1];
    }
    EXPECT_EQ(between, 1);
    const double entry = 200.0 / 4095;
    EXPECT_EQ(opacity_at(t, 100 - entry), 0);
    EXPECT_EQ(opacity_at(t, 100 + entry), 0.8f);
}

TEST(TransferTableTest, StepsAtTheEndsLieInside) {
    const TransferTable t = table({point(50, 0), point(50, 1), point(60, 1), point(60, 0)});
    EXPECT_EQ(opacity_at(t, 49), 0);
    EXPECT_EQ(opacity_at(t, 55), 1);
    EXPECT_EQ(opacity_at(t, 61), 0);
}

TEST(TransferTableTest, SlopeAndInterceptAreFoldedIn) {
    const TransferTable t = table({point(-1000, 0), point(1000, 1)}, scaled(2, -1024), 0, 2000);
    EXPECT_EQ(t.first, 12);
    EXPECT_EQ(t.last, 1012);
    EXPECT_NEAR(opacity_at(t, 512), 0.5, 1e-6);
}

TEST(TransferTableTest, ANegativeSlopeReverses) {
    const TransferTable t = table({point(-50, 0.1), point(50, 0.9)}, scaled(-1, 100), 0, 255);
    EXPECT_EQ(t.first, 50);
    EXPECT_EQ(t.last, 150);
    EXPECT_NEAR(opacity_at(t, 50), 0.9, 1e-6);
    EXPECT_NEAR(opacity_at(t, 150), 0.1, 1e-6);
    // 0..1 is the physical range: 0 is the greatest stored value.
    const TransferTable n = table({point(0, 0), point(1, 1)}, scaled(-1, 100), 10, 20, true);
    EXPECT_EQ(n.first, 10);
    EXPECT_EQ(n.last, 20);
    EXPECT_EQ(opacity_at(n, 10), 1);
    EXPECT_EQ(opacity_at(n, 20), 0);
}

TEST(TransferTableTest, NormalizedSpansTheRange) {
    const TransferTable t = table({point(0.25, 0), point(0.75, 1)}, scaled(3, 7), -100, 300, true);
    EXPECT_EQ(t.first, 0);
    EXPECT_EQ(t.last, 200);
}

TEST(TransferTableTest, OnePointIsAConstant) {
    for (double value : {0.0, 300.0, -1e-12, 1e12, 1e-40, 5e-324, -3e38}) {
        const TransferTable t = table({point(value, 0.5, 0.25)});
        EXPECT_LT(t.first, t.last);
        EXPECT_TRUE(std::isfinite(static_cast<float>(t.index_scale())));
        for (float o : t.opacity) ASSERT_EQ(o, 0.5f);
        for (int e = 0; e < transfer_entries; ++e) ASSERT_EQ(t.color[4 * e], 0.25f);
        EXPECT_GE(t.visible_width, 255);
    }
}

TEST(TransferTableTest, TwoPointsAtOneValueAreAStepThere) {
    const TransferTable t = table({point(100, 0), point(100, 1)});
    EXPECT_EQ(opacity_at(t, 99.9), 0);
    EXPECT_EQ(opacity_at(t, 100.1), 1);
    EXPECT_GT(t.visible_width, 0);
}

TEST(TransferTableTest, AConstantVolumeHasATable) {
    const TransferTable t = table({point(0, 0.5), point(1, 0.5)}, scaled(1, 0), 7, 7, true);
    EXPECT_LT(t.first, t.last);
    EXPECT_EQ(opacity_at(t, 7), 0.5);
    EXPECT_GT(t.visible_width, 0);
}

TEST(TransferTableTest, NothingVisibleHasNoWidth) {
    EXPECT_EQ(table({point(0, 0), point(255, 0)}).visible_width, 0);
    EXPECT_EQ(table({point(300, 0), point(400, 1), point(500, 0)}).visible_width, 0) << "outside of the range";
    EXPECT_GT(table({point(300, 0.5), point(400, 1), point(500, 0)}).visible_width, 0) << "held down to the range";
    EXPECT_GT(table({point(-300, 0), point(-200, 1)}).visible_width, 0) << "held up to the range";
    EXPECT_NEAR(table({point(0, 0), point(100, 0), point(120, 1), point(140, 0), point(255, 0)}).visible_width, 40, 0.2);
}

TEST(TransferTableTest, WhatIsNotANumberIsRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    EXPECT_THROW(table({}), Error);
    EXPECT_THROW(table({point(nan, 1)}), Error);
    EXPECT_THROW(table({point(inf, 1)}), Error);
    EXPECT_THROW(table({point(0, nan)}), Error);
    EXPECT_THROW(table({point(0, -0.1)}), Error);
    EXPECT_THROW(table({point(0, 1, 1.1)}), Error);
    EXPECT_THROW(table({point(2, 1), point(1, 1)}), Error);
    EXPECT_THROW(table({point(0, 1)}, scaled(0, 0)), Error);
    EXPECT_THROW(table({point(0, 1)}, scaled(nan, 0)), Error);
    EXPECT_THROW(table({point(1e300, 1)}, scaled(1e-300, 0)), Error);
    EXPECT_THROW(table({point(0, 0), point(1e39, 1)}), Error) << "beyond the floats of the device";
    EXPECT_THROW(table({point(-1e308, 0), point(1e308, 1)}), Error);
}

} // namespace
} // namespace clvr

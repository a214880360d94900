#include "host/frame/metrics.hpp"
#include "runtime/error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace clvr {
namespace {

Frame flat(int width, int height, float value) {
    Frame f;
    f.width = width, f.height = height;
    for (const char* c : {"R", "G", "B"}) f.channel(c).assign(f.pixels(), value);
    return f;
}

TEST(Metrics, OfEqualPictures) {
    Frame f = flat(20, 15, 0.3f);
    f.channel("G")[7] = 2;
    const Metrics m = compare_frames(f, f);
    EXPECT_EQ(m.psnr, std::numeric_limits<double>::infinity());
    EXPECT_DOUBLE_EQ(m.ssim, 1);
    EXPECT_EQ(m.rmse, 0);
    EXPECT_EQ(m.smape, 0);
    EXPECT_EQ(m.relmse, 0);
}

TEST(Metrics, OfBlackAndWhite) {
    const Metrics m = compare_frames(flat(12, 12, 0), flat(12, 12, 1));
    EXPECT_NEAR(m.psnr, 0, 1e-9);
    EXPECT_NEAR(m.ssim, 1e-4 / 1.0001, 1e-12); // the means' term alone: variances are 0
    EXPECT_NEAR(m.rmse, 1, 1e-9);
    EXPECT_NEAR(m.smape, 1 / 1.01, 1e-12);
    EXPECT_NEAR(m.relmse, 1 / 1.01, 1e-12);
}

TEST(Metrics, OfASinglePixel) {
    Frame a = flat(16, 16, 0.5f), b = a;
    b.channel("R")[8 * 16 + 8] = 1;
    const double d = 1 - std::pow(0.5, 1 / 2.2);
    EXPECT_NEAR(psnr(a, b), -10 * std::log10(d * d / (3 * 256)), 1e-9);
    EXPECT_NEAR(compare_frames(a, b).rmse, std::sqrt(0.25 / 768), 1e-12);
}

TEST(Metrics, ClipForDisplayAlone) {
    EXPECT_EQ(psnr(flat(11, 11, 1), flat(11, 11, 7)), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(compare_frames(flat(11, 11, -1), flat(11, 11, 0)).rmse, 1, 1e-9);
}

TEST(Metrics, OpaqueWindowsAreThoseOfTheReference) {
    Frame a = flat(40, 11, 0.5f), b = a;
    for (int y = 0; y < 11; ++y)
        for (int x = 0; x < 11; ++x) b.channel("G")[y * 40 + x] = (x + y) % 2 ? 0.9f : 0.1f;
    b.channel("A").assign(b.pixels(), 0.0f);
    for (int y = 0; y < 11; ++y) b.channel("A")[y * 40 + 30] = 1;
    const Metrics m = compare_frames(a, b);
    EXPECT_LT(m.ssim, 0.99);
    EXPECT_DOUBLE_EQ(m.ssim_opaque, 1);
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
    EXPECT_THROW(psnr(flat(4, 4, 0), flat(4, 5, 0)), Error);
    EXPECT_THROW(compare_frames(flat(10, 20, 0), flat(10, 20, 0)), Error);
    Frame f = flat(12, 12, 0);
    f.channels.erase("B");
    EXPECT_THROW(psnr(f, flat(12, 12, 0)), Error);
    f = flat(12, 12, 0);
    f.channel("R")[3] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(psnr(f, flat(12, 12, 0)), Error);
}

} // namespace
} // namespace clvr

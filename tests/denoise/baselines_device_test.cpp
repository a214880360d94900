// The classical denoisers against their papers' formulas in double precision.
#include "host/denoise/baselines.hpp"
#include "runtime/error.hpp"
#include "tests/denoise/batches.hpp"
#include "tests/denoise/frames.hpp"
#include "tests/reference/filters.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace clvr::testing {
namespace {

constexpr const char* colours[] = {"R", "G", "B"};

Frame with_variance(Frame f) {
    for (const char* c : {"variance.R", "variance.G", "variance.B"}) {
        std::vector<float>& v = f.channel(c);
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = 0.02f + 0.1f * static_cast<float>(i % 7) * f.at("opacity.A")[i];
    }
    return f;
}

double albedo(const Frame& f, const char* colour, std::size_t i) { return std::max(f.at(std::string("albedo.") + colour)[i], 1.0f / 32); }

reference::FilterImage image_of(const Frame& f) {
    reference::FilterImage image{f.width, f.height, std::vector<reference::FilterPixel>(f.pixels())};
    constexpr double shares[] = {0.2126, 0.7152, 0.0722};
    for (std::size_t i = 0; i < f.pixels(); ++i) {
        reference::FilterPixel& p = image.pixels[i];
        p.opacity = f.at("opacity.A")[i];
        for (int c = 0; c < 3; ++c) {
            const double divisor = albedo(f, colours[c], i) * std::max(p.opacity, 1.0 / 256);
            p.colour[c] = f.at(colours[c])[i] / divisor;
            if (f.has("variance.R")) p.variance += std::pow(shares[c] / divisor, 2) * f.at(std::string("variance.") + colours[c])[i];
            p.features[c] = f.at(std::string("albedo.") + colours[c])[i];
        }
        for (int k = 0; k < 3; ++k) p.features[3 + k] = f.at(std::string("normal.") + "XYZ"[k])[i];
        p.features[6] = 8 * f.at("depth.Z")[i];
    }
    return image;
}

void expect_result(const Frame& got, const reference::FilterImage& expected, const Frame& f) {
    for (int c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < f.pixels(); ++i) {
            const double v = expected.pixels[i].colour[c] * albedo(f, colours[c], i) * f.at("opacity.A")[i];
            ASSERT_NEAR(got.at(colours[c])[i], v, 2e-5 * (1 + v)) << colours[c] << i;
        }
}

TEST(Baselines, CrossBilateralIsItsFormula) {
    for (const auto& [width, height] : {std::pair(37, 21), {1, 1}, {3, 50}}) {
        Frame f = noisy_frame(width, height);
        f.channel("opacity.A")[f.pixels() / 2] = 0.3f;
        expect_result(denoise(test_device(), f, CrossBilateral{2.5, 0.4}), reference::cross_bilateral(image_of(f), 2.5, 0.4, 5), f);
    }
}

TEST(Baselines, WaveletIsItsFormula) {
    const Frame f = noisy_frame(45, 70);
    expect_result(denoise(test_device(), f, Wavelet{3, 0.5}), reference::wavelet(image_of(f), 3, 0.5, 5, true), f);
    const Frame v = with_variance(f);
    expect_result(denoise(test_device(), v, Wavelet{1, 0.3}), reference::wavelet(image_of(v), 1, 0.3, 5, false), v);
}

TEST(Baselines, GiveTheSameBitsAtEveryWidth) {
    const Frame f = noisy_frame(75, 33);
    std::vector<std::string> hashes;
    for (const int width : {1, 4, 8, 16}) {
        Device device = test_device();
        device.set_tunable("conv_width", width);
        hashes.push_back(pixel_hash(denoise(device, f, CrossBilateral{})) + pixel_hash(denoise(device, f, Wavelet{})));
    }
    for (const auto& hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(Baselines, KeepBackgroundAndAConstant) {
    Frame f = noisy_frame(40, 40);
    for (const char* c : colours) {
        for (std::size_t i = 0; i < f.pixels(); ++i) f.channel(c)[i] = 0.6f * f.at("opacity.A")[i] * f.at("albedo.R")[i];
        f.channel(std::string("background.") + c).assign(f.pixels(), 0.25f);
        for (std::size_t i = 0; i < f.pixels(); ++i) f.channel(c)[i] += (1 - f.at("A")[i]) * 0.25f;
    }
    for (const Frame& done : {denoise(test_device(), f, CrossBilateral{}), denoise(test_device(), f, Wavelet{})})
        for (std::size_t i = 0; i < f.pixels(); ++i) ASSERT_NEAR(done.at("G")[i], f.at("G")[i], 1e-6) << i;
}

TEST(Baselines, RepairAndRefuse) {
    Frame f = noisy_frame(20, 20);
    f.channel("R")[200] = std::numeric_limits<float>::quiet_NaN();
    f.channel("depth.Z")[210] = std::numeric_limits<float>::infinity();
    for (const Frame& done : {denoise(test_device(), f, CrossBilateral{}), denoise(test_device(), f, Wavelet{})})
        for (const char* c : colours)
            for (const float v : done.at(c)) ASSERT_TRUE(std::isfinite(v));
    EXPECT_THROW(denoise(test_device(), f, CrossBilateral{0, 1}), Error);
    EXPECT_THROW(denoise(test_device(), f, CrossBilateral{1, -1}), Error);
    EXPECT_THROW(denoise(test_device(), f, Wavelet{std::nan(""), 1}), Error);
    f.channels.erase("G");
    EXPECT_THROW(denoise(test_device(), f, Wavelet{}), Error);
}

} // namespace
} // namespace clvr::testing

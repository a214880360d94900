#include "host/frame/error_pictures.hpp"
#include "host/frame/flip.hpp"
#include "tests/reference/flip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace clvr {
namespace {

using Image = std::vector<std::array<double, 3>>;

Frame frame_of(const Image& image, int width) {
    Frame f;
    f.width = width, f.height = static_cast<int>(image.size()) / width;
    for (const auto& [name, c] : {std::pair("R", 0), {"G", 1}, {"B", 2}}) {
        std::vector<float>& plane = f.channel(name);
        for (std::size_t i = 0; i < image.size(); ++i) plane[i] = static_cast<float>(image[i][static_cast<std::size_t>(c)]);
    }
    return f;
}

Image flat(double value, int pixels) { return Image(static_cast<std::size_t>(pixels), {value, value, value}); }

Image noise(int pixels) {
    Image image;
    std::uint32_t k = 7;
    const auto next = [&] {
        k = k * 1664525u + 1013904223u;
        return static_cast<float>(k >> 8) / (1 << 24);
    };
    for (int i = 0; i < pixels; ++i) image.push_back({next(), next(), next()});
    return image;
}

void expect_the_papers_formula(const Image& a, const Image& b, int width) {
    const std::vector<double> map = flip_map(frame_of(a, width), frame_of(b, width));
    const std::vector<double> expected = reference::flip(a, b, width, static_cast<int>(a.size()) / width);
    for (std::size_t i = 0; i < map.size(); ++i) ASSERT_NEAR(map[i], expected[i], 1e-4) << i;
}

TEST(Flip, OfIdenticalPicturesIs0) {
    const Frame f = frame_of(noise(12 * 9), 12);
    for (const double v : flip_map(f, f)) EXPECT_EQ(v, 0);
}

TEST(Flip, OfBlackAndWhite) {
    // L* differs by 100; the greatest HyAB distance is between the Hunt-adjusted green (87.74, -75.61, 72.98) and blue (32.30, 25.58,
    // -34.84).
    const double greatest = std::pow(87.735 - 32.302 + std::hypot(75.612 + 25.582, 72.978 + 34.842), 0.7);
    const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - 0.4 * greatest) / (0.6 * greatest);
    for (const double v : flip_map(frame_of(flat(0, 64), 8), frame_of(flat(1, 64), 8))) EXPECT_NEAR(v, expected, 1e-5);
}

TEST(Flip, OfASinglePixel) {
    Image one = flat(0, 41 * 41);
    one[20 * 41 + 20] = {1, 1, 1};
    const std::vector<double> map = flip_map(frame_of(one, 41), frame_of(flat(0, 41 * 41), 41));
    EXPECT_EQ(std::max_element(map.begin(), map.end()) - map.begin(), 20 * 41 + 20);
    EXPECT_GT(map[20 * 41 + 20], 0.1);
    EXPECT_LT(map[0], 1e-3); // beyond the reach of every filter
    EXPECT_NEAR(map[20 * 41 + 17], map[17 * 41 + 20], 1e-12);
    expect_the_papers_formula(one, flat(0, 41 * 41), 41);
    EXPECT_GT(flip_map(frame_of({{1, 1, 1}}, 1), frame_of({{0, 0, 0}}, 1))[0], 0.95);
}

TEST(Flip, IsThePapersFormula) { expect_the_papers_formula(noise(25 * 14), flat(0.2, 25 * 14), 25); }

TEST(ErrorPictures, ShowWhereTheDifferenceIs) {
    Image a = flat(0.2, 30 * 30), b = a;
    a[15 * 30 + 15] = {1, 0.2, 0.2};
    const Frame flip = flip_picture(frame_of(a, 30), frame_of(b, 30)), difference = difference_picture(frame_of(a, 30), frame_of(b, 30));
    EXPECT_GT(flip.at("R")[15 * 30 + 15], flip.at("R")[0]);
    EXPECT_EQ(flip.at("R")[0], 0);
    EXPECT_NEAR(difference.at("R")[15 * 30 + 15], std::pow(1 - std::pow(0.2, 1 / 2.2), 2.2), 1e-6);
    EXPECT_EQ(difference.at("G")[15 * 30 + 15], 0);
}

} // namespace
} // namespace clvr

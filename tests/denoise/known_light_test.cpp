// The light that is known without noise: shares found again, bad pixels, plans that read it.
#include "host/denoise/channels.hpp"
#include "runtime/error.hpp"
#include "tests/denoise/frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace clvr::testing {
namespace {

using ::testing::HasSubstr;

/// Radiance that is made of the frame's direct light by these shares, plus noise of mean 0.
Frame made_of(double key, double sky, double ambient, double noise) {
    Frame f = noisy_frame(64, 48);
    std::uint32_t k = 5;
    for (std::size_t i = 0; i < f.pixels(); ++i)
        for (const char* c : {"R", "G", "B"}) {
            k = k * 1664525u + 1013904223u;
            const std::string colour = c;
            const double direct = key * f.at("light.key." + colour)[i] + sky * f.at("light.sky." + colour)[i];
            f.channel(colour)[i] = static_cast<float>(
                direct + f.at("opacity.A")[i] * (ambient * f.at("albedo." + colour)[i] + noise * ((k >> 8) * 0x1p-23 - 1)));
        }
    return f;
}

TEST(KnownLight, IsReadByModelsThatSaySo) {
    Model m = default_settings();
    EXPECT_EQ(reads_light(m), m.control_variate);
    m.control_variate = false;
    m.channels = {"R", "G", "B", "albedo.R", "opacity.A"};
    EXPECT_FALSE(reads_light(m));
    m.channels.push_back("light.sky.G");
    EXPECT_TRUE(reads_light(m));
    m.channels.back() = "known.R";
    EXPECT_TRUE(reads_light(m));
    m.channels.pop_back();
    m.control_variate = true;
    EXPECT_TRUE(reads_light(m));
}

TEST(KnownLight, FindsTheSharesThatAFrameIsMadeOf) {
    const Frame f = made_of(1.4, 0.8, 0.05, 0.05);
    const KnownLight known(f);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(known.shares(c).key, 1.4, 0.1);
        EXPECT_NEAR(known.shares(c).sky, 0.8, 0.1);
        EXPECT_NEAR(known.shares(c).ambient, 0.05, 0.03);
    }
    const std::size_t lit = 24 * 64 + 40;
    ASSERT_EQ(f.at("opacity.A")[lit], 1);
    const KnownLight::Shares& s = known.shares(1);
    EXPECT_FLOAT_EQ(known(1, lit), static_cast<float>(s.key * f.at("light.key.G")[lit] + s.sky * f.at("light.sky.G")[lit] +
                                                      s.ambient * f.at("albedo.G")[lit]));
    EXPECT_EQ(known(1, 0), 0); // nothing is there
}

/// The left half lit by other shares than the right one: cells far from the border find their own, one share for all lies between.
TEST(KnownLight, SharesVaryOverCells) {
    Frame f = noisy_frame(256, 128);
    std::uint32_t k = 9;
    for (std::size_t i = 0; i < f.pixels(); ++i) {
        f.channel("opacity.A")[i] = 1;
        for (const std::string c : {"R", "G", "B"}) {
            k = k * 1664525u + 1013904223u;
            f.channel("albedo." + c)[i] = 0.5f;
            float &key = f.channel("light.key." + c)[i], &sky = f.channel("light.sky." + c)[i];
            key = 0.2f + 0.1f * static_cast<float>((k >> 9) % 7), sky = 0.3f + 0.1f * static_cast<float>((k >> 13) % 5);
            f.channel(c)[i] = (i % 256 < 128 ? 1.5f : 0.9f) * key + sky + 0.02f * static_cast<float>((k >> 17) % 11 - 5.0);
        }
    }
    const KnownLight one(f), many(f, 32);
    EXPECT_EQ(one.shares_at(1, 5).key, one.shares(1).key);
    EXPECT_NEAR(many.shares(1).key, one.shares(1).key, 1e-10); // another order of sums
    EXPECT_GT(one.shares(1).key, 1.0);
    EXPECT_LT(one.shares(1).key, 1.4);
    const std::size_t row = 64 * 256;
    EXPECT_NEAR(many.shares_at(1, row + 20).key, 1.5, 0.1);
    EXPECT_NEAR(many.shares_at(1, row + 230).key, 0.9, 0.1);
    EXPECT_NEAR(many.shares_at(1, row + 128).key, 1.2, 0.2);
    for (std::size_t x = 100; x < 160; ++x) EXPECT_LE(many.shares_at(1, row + x).key, many.shares_at(1, row + x - 1).key + 1e-12) << x;
    // A picture that is no multiple of the cell, smaller than one.
    const Frame small = noisy_frame(21, 13);
    const KnownLight of_small(small, 32);
    for (std::size_t i = 0; i < small.pixels(); ++i) ASSERT_TRUE(std::isfinite(of_small(2, i)));
}

TEST(KnownLight, OfNothingTakesTheLightAsItIs) {
    Frame f = noisy_frame(20, 20);
    for (float& v : f.channel("opacity.A")) v = 0;
    EXPECT_NEAR(KnownLight(f).shares(0).key, 1, 1e-9);
    EXPECT_NEAR(KnownLight(f).shares(2).sky, 1, 1e-9);
    EXPECT_NEAR(KnownLight(f).shares(2).ambient, 0, 1e-9);
}

TEST(KnownLight, IsFiniteWhateverTheFrameHolds) {
    Frame f = made_of(1, 1, 0, 0.2);
    const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1e30f, 3e38f};
    const char* const names[] = {"R", "light.key.R", "light.sky.R", "albedo.R", "opacity.A"};
    for (std::size_t n = 0; n < 5; ++n)
        for (std::size_t k = 0; k < 4; ++k) f.channel(names[n])[24 * 64 + 20 + 4 * n + k] = bad[k];
    for (int cell : {0, 8, 32}) {
        const KnownLight known(f, cell);
        for (const double share : {known.shares(0).key, known.shares(0).sky, known.shares(0).ambient}) EXPECT_TRUE(std::isfinite(share));
        for (std::size_t i = 0; i < f.pixels(); ++i) ASSERT_TRUE(std::isfinite(known(0, i))) << i;
    }
}

TEST(AddKnownLight, LeavesTheWeightsOfTheOtherChannels) {
    Model m = default_settings();
    m.hidden = 3, m.kernel = 3;
    initialise(m, 9);
    const Model before = m;
    add_known_light(m);
    EXPECT_NO_THROW(validate(m));
    ASSERT_EQ(m.channels.size(), before.channels.size() + 3);
    EXPECT_EQ(m.channels.back(), "known.B");
    const std::size_t old_row = before.channels.size() * 9, row = m.channels.size() * 9;
    for (std::size_t h = 0; h < 3; ++h)
        for (std::size_t k = 0; k < row; ++k)
            ASSERT_EQ(m.conv1_weight[h * row + k], k < old_row ? before.conv1_weight[h * old_row + k] : 0);
    const Model once = m;
    add_known_light(m);
    EXPECT_EQ(m.flat(), once.flat());
}

TEST(ChannelPlan, NamesTheChannelsThatKnownLightLacks) {
    Model m = default_settings();
    m.control_variate = true;
    Frame f = noisy_frame(16, 16);
    for (const char* name : {"depth.deviation", "depth.half"}) f.channel(name);
    f.attributes["clvr.spp"] = "1";
    const ChannelPlan plan(m, false);
    EXPECT_NO_THROW(plan.check(f));
    f.channels.erase("light.sky.G");
    try {
        plan.check(f);
        FAIL();
    } catch (const Error& e) {
        EXPECT_THAT(e.what(), HasSubstr("lacks channel light.sky.G"));
    }
    EXPECT_FALSE(ChannelPlan(default_settings(), false).known_light(f).has_value());
}

} // namespace
} // namespace clvr::testing

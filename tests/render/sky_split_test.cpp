// An environment split into suns and few directions: nothing is lost, suns are where they were, a soft one stays in the sky.
#include "host/render/direct_light.hpp"
#include "host/render/params.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace clvr {
namespace {

constexpr int width = 128, height = 64;

struct Image {
    std::vector<float> rgb = std::vector<float>(3 * width * height, 0.5f);
    void spot(int column, int row, int radius, float value) {
        for (int y = row - radius; y <= row + radius; ++y)
            for (int x = column - radius; x <= column + radius; ++x)
                for (int c = 0; c < 3; ++c) rgb[3 * (static_cast<std::size_t>(y) * width + x) + c] = c == 2 ? value / 2 : value;
    }
    EnvironmentTables tables() const { return environment_tables(width, height, rgb, 1); }
};

shared::RenderParams params_of(double rotation = 0) {
    shared::RenderParams p{};
    p.environment_width = width, p.environment_height = height;
    p.sky = {1, 0, static_cast<float>(std::cos(rotation)), static_cast<float>(std::sin(rotation))};
    return p;
}

double power(const std::vector<shared::float4>& radiance) {
    double sum = 0;
    for (const auto& l : radiance) sum += l.x;
    return sum;
}

TEST(SplitSky, DirectionsAreUnitAndEven) {
    shared::RenderParams p{};
    p.sky = {0.6f, 0.3f, 1, 0};
    const SkySplit s = split_sky(p, {});
    ASSERT_EQ(s.directions.size(), static_cast<std::size_t>(CLVR_SKY_DIRECTIONS));
    EXPECT_TRUE(s.suns.empty());
    double x = 0, z = 0, zz = 0;
    for (const auto& d : s.directions) {
        EXPECT_NEAR(d.x * d.x + d.y * d.y + d.z * d.z, 1, 1e-6);
        x += d.x, z += d.z, zz += d.z * d.z;
    }
    EXPECT_NEAR(x / CLVR_SKY_DIRECTIONS, 0, 0.01);
    EXPECT_NEAR(z / CLVR_SKY_DIRECTIONS, 0, 1e-6);
    EXPECT_NEAR(zz / CLVR_SKY_DIRECTIONS, 1.0 / 3, 1e-3);
    EXPECT_NEAR(power(s.radiance), 0.6 * 4 * pi, 1e-4);
}

TEST(SplitSky, TakesTheSunOutAndLosesNothing) {
    Image image;
    image.spot(100, 20, 0, 20000);
    for (const double turn : {0.0, 0.7}) {
        const EnvironmentTables tables = image.tables();
        const SkySplit s = split_sky(params_of(turn), tables);
        ASSERT_EQ(s.suns.size(), 1u);
        const double solid_angle = 2 * pi / width * (tables.row_cos[20] - tables.row_cos[21]);
        EXPECT_NEAR(s.suns[0].irradiance.x, 20000 * solid_angle, 20);
        EXPECT_NEAR(s.suns[0].irradiance.z, 10000 * solid_angle, 10);
        // Column 100 of 128: from +y towards +x by 100.5/128 - 1/2 turns, then the rotation.
        const double azimuth = 2 * pi * (100.5 / width - 0.5), polar = pi * 20.5 / height;
        const double sx = std::sin(polar) * std::sin(azimuth), sy = std::sin(polar) * std::cos(azimuth);
        const double x = std::cos(turn) * sx - std::sin(turn) * sy, y = std::cos(turn) * sy + std::sin(turn) * sx;
        EXPECT_NEAR(s.suns[0].direction.x, x, 1e-3);
        EXPECT_NEAR(s.suns[0].direction.y, y, 1e-3);
        EXPECT_NEAR(s.suns[0].direction.z, std::cos(polar), 1e-3);
        double all = 0;
        for (std::size_t t = 0; t < tables.texel.size(); ++t) {
            const std::size_t row = t / width;
            all += tables.texel[t].x * 2 * pi / width * (static_cast<double>(tables.row_cos[row]) - tables.row_cos[row + 1]);
        }
        EXPECT_NEAR(power(s.radiance) + s.suns[0].irradiance.x, all, 1e-3 * all);
    }
}

TEST(SplitSky, LeavesWideAndFaintLightsInTheSky) {
    Image wide;
    wide.spot(64, 30, 12, 8); // 16 times as bright as the rest
    EXPECT_TRUE(split_sky(params_of(), wide.tables()).suns.empty());
    Image faint;
    faint.spot(64, 30, 0, 30); // bright, but little power
    EXPECT_TRUE(split_sky(params_of(), faint.tables()).suns.empty());
    Image many;
    for (int k = 0; k < 6; ++k) many.spot(10 + 20 * k, 20 + 3 * k, 0, 30000);
    EXPECT_EQ(split_sky(params_of(), many.tables()).suns.size(), 4u);
}

TEST(KeyLights, AreThoseWithPower) {
    Voxels v;
    v.dims = {8, 8, 8};
    v.bytes.assign(512, 1);
    Scene s;
    s.camera.eye = Double3{0, -30, 0}, s.camera.target = Double3{0, 0, 0};
    const auto keys_of = [&] {
        const shared::RenderParams p = render_params(s, v, resolve_view(s, {{0, 0, 0}}, false), {});
        return key_lights(p, split_sky(p, {}));
    };
    ASSERT_EQ(keys_of().size(), 1u);
    const double disc = std::sin(std::acos(1 - (1 - std::cos(5 * pi / 180)) / 2));
    EXPECT_NEAR(keys_of()[0].direction.w, disc, 1e-6);
    const float soft = keys_of()[0].irradiance.x;
    s.light.key_angle = 0;
    EXPECT_EQ(keys_of()[0].direction.w, 0);
    EXPECT_NEAR(keys_of()[0].irradiance.x / soft, 1, 0.01);
    s.light.headlight = 0.5;
    ASSERT_EQ(keys_of().size(), 2u);
    EXPECT_FLOAT_EQ(keys_of()[1].irradiance.y, 0.5f);
    EXPECT_NEAR(keys_of()[1].direction.y, -1, 1e-6); // from the camera
    s.light.headlight = 0, s.light.key = 0;
    EXPECT_TRUE(keys_of().empty());
}

} // namespace
} // namespace clvr

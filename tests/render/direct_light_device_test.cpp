// Direct light of the features: closed forms in media and on surfaces, shadows, the split of an environment, against the path tracer's
// single scattering.
#include "tests/render/closed_forms.hpp"
#include "tests/render/marched.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace clvr::testing {
namespace {

/// Mean of a channel (0 R, 1 G, 2 B) of the key's or the sky's light over the picture.
struct FeatureLight {
    double key, sky;
};

FeatureLight mean_light(const Voxels& v, const Scene& scene, int channel = 0) {
    const Stage stage(v, scene);
    const Marched m = march(shared_device(), stage);
    const auto mean = [&](int plane) {
        const auto first = m.planes.begin() + static_cast<std::ptrdiff_t>(plane) * m.numbers;
        return std::accumulate(first, first + m.numbers, 0.0) / m.numbers;
    };
    return {mean(10 + channel), mean(13 + channel)};
}

/// The box of closed_forms.hpp under a key light alone, or a constant sky of radiance 1 alone.
double box_key(double optical_depth, double g, double expected_error) {
    BoxScene box(optical_depth, g, 1);
    box.scene.light.level = 0;
    box.scene.light.key = 1;
    box.scene.light.key_angle = 0;
    const Stage stage(box.volume, box.scene);
    const auto& key = stage.render.key;
    const double expected = box.expected({box.scattered({key.x, key.y, key.z}, stage.render.key_radiance.x)});
    const FeatureLight found = mean_light(box.volume, box.scene);
    EXPECT_NEAR(found.key / expected, 1, expected_error) << optical_depth << ' ' << g;
    return found.sky;
}

TEST(DirectLight, OfAKeyInAMediumIsItsSingleScattering) {
    for (const double depth : {0.05, 0.5, 2.0})
        for (const double g : {0.0, 0.6}) EXPECT_NEAR(box_key(depth, g, 0.06), 0, 1e-12);
}

TEST(DirectLight, OfTheSkyInAMediumIsItsSingleScattering) {
    for (const double depth : {0.05, 0.5, 2.0})
        for (const double g : {0.0, 0.5})
            for (const auto environment : {clvr::Light::Environment::constant, clvr::Light::Environment::sky}) {
                BoxScene box(depth, g, 1);
                box.scene.light.environment = environment;
                const shared::float4 sky = Stage(box.volume, box.scene).render.sky;
                const double expected = box.expected(box.scattered_everywhere([&](const Double3& d) { return sky.x + sky.y * d[2]; }));
                EXPECT_NEAR(mean_light(box.volume, box.scene).sky / expected, 1, 0.15) << depth << ' ' << g;
            }
}

/// A scene of a small volume with surfaces: white, opaque from a value of 100 on.
Scene surface_scene(Shading shading, const Double3& from, const Double3& target, int spp) {
    Scene s = plain_scene(40, spp);
    s.shading = shading;
    s.bounces = 1;
    s.extinction = 6;
    s.features = true;
    s.transfer->points = {{0, {0.8, 0.8, 0.8}, 0}, {70, {0.8, 0.8, 0.8}, 0}, {130, {0.8, 0.8, 0.8}, 1}, {255, {0.8, 0.8, 0.8}, 1}};
    s.camera.target = target;
    s.camera.eye = target + from;
    s.camera.fov = 28;
    return s;
}

double ball(double x, double y, double z, const Double3& centre, double radius) {
    return 100 - 60 * (norm(Double3{x, y, z} - centre) - radius);
}

/// Root mean square of what the features' light and the traced single scattering differ by, over the root mean square of the latter; the
/// traced picture's own noise is taken off.
double relative_error(const Voxels& v, const Scene& scene) {
    const Frame f = render(v, scene);
    double error = 0, size = 0;
    for (std::size_t i = 0; i < f.pixels(); ++i) {
        const double traced = f.at("G")[i], light = f.at("light.key.G")[i] + f.at("light.sky.G")[i];
        error += (light - traced) * (light - traced) - f.at("variance.G")[i], size += traced * traced;
    }
    return std::sqrt(std::max(error, 0.0) / size);
}

TEST(DirectLight, OfABallIsItsSingleScatteringInEveryShading) {
    const Voxels v = volume_of<std::uint8_t>({40, 40, 40}, [](int x, int y, int z) {
        return std::clamp(ball(x, y, z, {19.5, 19.5, 19.5}, 12), 0.0, 255.0);
    });
    struct {
        Shading shading;
        double key, sky; // greatest errors
    } const cases[] = {{Shading::phase, 0.12, 0.15}, {Shading::gradient, 0.1, 0.1}, {Shading::automatic, 0.1, 0.1}};
    for (const auto& c : cases) {
        Scene scene = surface_scene(c.shading, {25, -80, 30}, {19.5, 19.5, 19.5}, 96);
        scene.light.level = 1;
        EXPECT_LT(relative_error(v, scene), c.sky) << "sky, shading " << static_cast<int>(c.shading);
        scene.light.level = 0, scene.light.key = 1;
        EXPECT_LT(relative_error(v, scene), c.key) << "key, shading " << static_cast<int>(c.shading);
    }
}

TEST(DirectLight, OfAKeyIsShadowedByABall) {
    // A floor, and a ball above it; the key shines straight down.
    const Voxels v = volume_of<std::uint8_t>({48, 48, 40}, [](int x, int y, int z) {
        return std::clamp(std::max(100 - 60.0 * (z - 6), ball(x, y, z, {23.5, 23.5, 26}, 8)), 0.0, 255.0);
    });
    Scene scene = surface_scene(Shading::gradient, {0, -90, 60}, {23.5, 23.5, 8}, 1);
    scene.light.level = 0, scene.light.key = 1, scene.light.key_elevation = 90, scene.light.key_angle = 0;
    const Frame f = render(v, scene);
    const auto& key = f.at("light.key.G");
    const auto floor_at = [&](double x, double y) { // the pixel that looks at a point of the floor
        const View view = resolve_view(scene, {}, false);
        const Double3 d = unit(Double3{x, y, 6} - view.eye);
        const double depth = inner(d, view.forward), right = inner(d, view.right) / inner(view.right, view.right) / depth,
                     up = inner(d, view.up) / inner(view.up, view.up) / depth;
        return static_cast<std::size_t>((1 - up) / 2 * 40) * 40 + static_cast<std::size_t>((1 + right) / 2 * 40);
    };
    EXPECT_LT(key[floor_at(23.5, 19)], 0.02);
    EXPECT_GT(key[floor_at(6, 15)], 0.25);
    EXPECT_GT(key[floor_at(41, 15)], 0.25);
}

TEST(DirectLight, OfTheSkyIsUniformWhereNothingHides) {
    // The furnace: thin fog under radiance 1 scatters its albedo times its opacity.
    const Voxels v = volume_of<std::uint8_t>({40, 40, 40}, [](int x, int y, int z) {
        return std::clamp(ball(x, y, z, {19.5, 19.5, 19.5}, 14), 0.0, 255.0);
    });
    Scene scene = surface_scene(Shading::phase, {25, -80, 30}, {19.5, 19.5, 19.5}, 1);
    scene.extinction = 0.002;
    const Frame f = render(v, scene);
    int seen = 0;
    for (std::size_t i = 0; i < f.pixels(); ++i) {
        if (f.at("opacity.A")[i] < 0.01) continue;
        ++seen;
        ASSERT_NEAR(f.at("light.sky.R")[i] / (0.8 * f.at("opacity.A")[i]), 1, 0.04) << i;
    }
    EXPECT_GT(seen, 300);
}

TEST(DirectLight, OfTheSkyOverAPlaneIsTheLayersIntegral) {
    // A thick floor seen from straight above (slope 1) under radiance 1: albedo of the matte lobe, and the glossy one, times 2 I_2 = 0.386.
    const Voxels v = volume_of<std::uint8_t>({64, 64, 24}, [](int, int, int z) { return std::clamp(100 - 60.0 * (z - 8), 0.0, 255.0); });
    Scene scene = surface_scene(Shading::gradient, {0, -1e-3, 90}, {31.5, 31.5, 8}, 128);
    scene.camera.fov = 12;
    const Frame f = render(v, scene);
    const double found = mean_of(f.at("light.sky.G")), traced = mean_of(f.at("G"));
    EXPECT_NEAR(found, 0.386 * (0.8 + 0.04 * 0.2), 0.02);
    EXPECT_NEAR(found / traced, 1, 0.06);
}

TEST(DirectLight, DependsOnNeitherPacketsNorGroups) {
    const Voxels v = volume_of<std::uint8_t>({30, 26, 28}, [](int x, int y, int z) {
        return std::clamp(std::max(ball(x, y, z, {14, 12, 13}, 7), 40.0 * std::sin(0.9 * x) * std::cos(0.7 * y + z)), 0.0, 255.0);
    });
    Scene scene = surface_scene(Shading::automatic, {20, -60, 30}, {14, 12, 13}, 1);
    scene.light.environment = clvr::Light::Environment::sky;
    scene.light.key = 1, scene.light.headlight = 0.3;
    const Stage stage(v, scene);
    const std::vector<float> planes = march(shared_device(), stage).planes;
    for (const std::map<std::string, int>& tunables : {std::map<std::string, int>{{"packet", 1}, {"packet_group", 32}},
                                                       {{"packet", 4}},
                                                       {{"packet", 8}, {"packet_group", 2}},
                                                       {{"march_pixels", 100}}}) {
        Device device = open_device();
        for (const auto& [name, value] : tunables) device.set_tunable(name, value);
        EXPECT_EQ(march(device, stage).planes, planes) << tunables.begin()->first << ' ' << tunables.begin()->second;
    }
}

} // namespace
} // namespace clvr::testing

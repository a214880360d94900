// Direct light of the features: closed forms in media and on surfaces, shadows, the split of an environment, against the path tracer's
// single scattering.
#include "tests/render/closed_forms.hpp"
#include "tests/render/marched.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace clvr::testing {
namespace {

constexpr double pi = 3.14159265358979323846;

/// Mean of a channel (0 R, 1 G, 2 B) of the key's or the sky's light over the picture.
struct Light {
    double key, sky;
};

Light mean_light(const Voxels& v, const Scene& scene, int channel = 0) {
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
    const Light found = mean_light(box.volume, box.scene);
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

} // namespace
} // namespace clvr::testing

// Scenes whose radiance or transmittance is known: those that take a second or two.
#include "tests/render/closed_forms.hpp"

namespace clvr::testing {
namespace {

struct Slab : ::testing::TestWithParam<double> {};

/// Path tracer, features and dvr agree with Beer's law.
TEST_P(Slab, TransmitsByBeersLaw) {
    const double tau = GetParam(), alpha = 1 - std::exp(-tau);
    const Voxels v = constant_volume({24, 8, 24});
    Scene s = plain_scene(32, 256);
    s.transfer = uniform_transfer({0.75, 0.5, 0.25}, 0.5);
    s.extinction = 2 * tau / 8;
    s.bounces = 1;
    s.features = true;
    look_along_y(s, {11.5, 3.5, 11.5}, 12);
    const Frame path = render(v, s);
    const double sigma = std::sqrt(alpha * (1 - alpha) / (static_cast<double>(path.pixels()) * s.spp));
    EXPECT_LE(sigma, 0.003 * std::max(alpha, 0.3));
    EXPECT_NEAR(mean_of(path.at("A")), alpha, 4 * sigma);
    for (float a : path.at("opacity.A")) ASSERT_NEAR(a, alpha, 2e-6);
    s.mode = Mode::dvr;
    const Frame dvr = render(v, s);
    for (float a : dvr.at("A")) ASSERT_NEAR(a, alpha, 2e-6);
    for (float r : dvr.at("R")) ASSERT_NEAR(r, 0.75 * alpha, 2e-6);
    for (float b : dvr.at("B")) ASSERT_NEAR(b, 0.25 * alpha, 2e-6);
}
INSTANTIATE_TEST_SUITE_P(Depth, Slab, ::testing::Values(0.5, 2.0, 6.0));

/// Opacity that grows linearly along the view: midpoints of the lattice integrate it exactly.
TEST(Absorption, OfARampIsItsIntegral) {
    const Voxels v = volume_of<std::uint8_t>({16, 64, 16}, [](int, int y, int) { return 4 * y; });
    Scene s = plain_scene(16, 256);
    s.transfer->points[0].opacity = 0;
    s.extinction = 0.08;
    s.bounces = 1;
    look_along_y(s, {7.5, 31.5, 7.5}, 8);
    const double tau = s.extinction * 4 / 255 * (63 * 63 / 2.0 + 0.5 * 63), alpha = 1 - std::exp(-tau);
    const Frame path = render(v, s);
    EXPECT_NEAR(mean_of(path.at("A")), alpha, 4 * std::sqrt(alpha * (1 - alpha) / (static_cast<double>(path.pixels()) * s.spp)));
    s.mode = Mode::dvr;
    const Frame dvr = render(v, s);
    for (float a : dvr.at("A")) ASSERT_NEAR(a, alpha, 5e-6);
}

/// host/README.md, "Shading": p = 1 - exp(-4 s), s = |gradient| x smallest spacing / width of the visible interval. The dvr mode dims what
/// faces away by it.
TEST(SurfaceChance, FollowsTheGradient) {
    Voxels v = volume_of<std::uint8_t>({40, 40, 40}, [](int, int, int z) { return 6 * z; });
    v.geometry.spacing = {1.5, 1.5, 0.75};
    Scene s = plain_scene(8, 1);
    s.mode = Mode::dvr;
    s.transfer->points = {{80, {1, 1, 1}, 0}, {80, {1, 1, 1}, 1}, {160, {1, 1, 1}, 1}, {160, {1, 1, 1}, 0}};
    s.camera.orthographic = true;
    s.camera.target = Double3{29, 29, 15};
    const double tilt = 0.5; // the cosine between the way to the eye and the gradient
    s.camera.eye = *s.camera.target + Double3{0, -std::sqrt(1 - tilt * tilt), tilt} * 60.0;
    s.camera.height = 4;
    const double steepness = 6 / 0.75 * 0.75 / 80, p = 1 - std::exp(-4 * steepness);
    for (const auto& [shading, chance] : {std::pair(Shading::automatic, p), {Shading::gradient, 1.0}, {Shading::phase, 0.0}}) {
        s.shading = shading;
        const Frame f = render(v, s);
        for (std::size_t i = 0; i < f.pixels(); ++i) {
            ASSERT_GT(f.at("A")[i], 0.99);
            ASSERT_NEAR(f.at("R")[i] / f.at("A")[i], 1 - 0.8 * chance * (1 - tilt), 1e-4);
        }
    }
}

TEST(Furnace, IsOneForEveryShading) {
    for (Shading shading : {Shading::phase, Shading::gradient, Shading::automatic})
        expect_furnace(blob(24), furnace_scene(shading, 0.4, 64));
}

TEST(SingleScattering, OfADirectionalKeyIsItsIntegral) {
    BoxScene box(2, 0.5, 512);
    box.scene.light.level = 0;
    box.scene.light.key = 1.5;
    box.scene.light.key_angle = 0;
    box.scene.light.key_azimuth = -70; // from behind the left shoulder
    box.scene.light.key_elevation = 35;
    const double azimuth = -70 * pi / 180, elevation = 35 * pi / 180;
    const Stage stage(box.volume, box.scene);
    box.expect({box.scattered({std::cos(elevation) * std::sin(azimuth), -std::cos(elevation) * std::cos(azimuth), std::sin(elevation)},
                              stage.render.key_radiance.x)});
}

TEST(SingleScattering, OfTheHeadlightIsItsIntegral) {
    BoxScene box(1, -0.3, 512, unit({1, -2, 0.5}));
    box.scene.light.level = 0;
    box.scene.light.headlight = 2;
    box.expect({box.scattered(unit({1, -2, 0.5}), 2)});
}

TEST(SingleScattering, OfAConstantEnvironmentIsItsIntegral) {
    BoxScene box(2, 0.3, 256);
    box.scene.light.level = 3;
    box.expect(box.scattered_everywhere([](const Double3&) { return 3.0; }));
}

} // namespace
} // namespace clvr::testing

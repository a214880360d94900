// The noise-free features: against a march in double, their constants, the lattice under skipping, the step.
#include "tests/render/marched.hpp"

#include <algorithm>

namespace clvr::testing {
namespace {

/// A hollow blob in anisotropic oblique voxels, nothing at the volume's border.
Voxels shell() {
    Voxels v = volume_of<std::uint8_t>({36, 40, 34}, [](int x, int y, int z) {
        const double dx = x - 17.2, dy = y - 19.6, dz = z - 16.1, r = std::sqrt(dx * dx + 0.8 * dy * dy + 1.2 * dz * dz);
        return std::max(0.0, 215 - 15 * r + 16 * std::sin(0.9 * x + 0.2 * z) * std::cos(0.7 * y)) * (r < 15 ? 1 : 0);
    });
    v.geometry.origin = {12, -30, 7};
    v.geometry.spacing = {0.7, 1.1, 1.4};
    v.geometry.direction.row = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    return v;
}

Scene shell_scene(const Voxels& v) {
    Scene s = plain_scene(32, 1);
    s.transfer->points = {{0, {0.1, 0.2, 0.9}, 0},      {36, {0.1, 0.2, 0.9}, 0},  {80, {0.9, 0.5, 0.2}, 0.3},
                          {120, {0.4, 0.8, 0.3}, 0.05}, {185, {0.9, 0.9, 0.8}, 1}, {255, {1, 1, 1}, 1}};
    s.extinction = 0.8;
    const Double3 centre = v.geometry.to_world({17, 19, 16});
    s.camera.target = centre;
    s.camera.eye = centre + Double3{40, -70, 25};
    s.camera.fov = 28;
    return s;
}

struct MarchedScene {
    const char* name;
    void (*change)(Scene& s, const Voxels& v);
};

struct Features : ::testing::TestWithParam<MarchedScene> {};

TEST_P(Features, AgreeWithTheReference) {
    const Voxels v = shell();
    Scene scene = shell_scene(v);
    GetParam().change(scene, v);
    const Stage stage(v, scene);
    Device device = shared_device();
    const Marched found = march(device, stage);
    const reference::MarchScene truth = reference_scene(stage);
    //                         albedo            normal            depth opacity deviation half depth
    const double tolerance[10] = {3e-6, 3e-6, 3e-6, 4e-5, 4e-5, 4e-5, 2e-6, 3e-6, 1e-4, 2e-6};
    int seen = 0;
    for (std::uint32_t n = 0; n < found.numbers; ++n) {
        const auto [x, y] = position(n, scene.width);
        const reference::Features f = reference::march_features(truth, x, y);
        const double values[10] = {f.albedo[0], f.albedo[1], f.albedo[2], f.normal[0], f.normal[1],
                                   f.normal[2], f.depth,     f.opacity,   f.deviation, f.half_depth};
        for (int p = 0; p < 10; ++p) ASSERT_NEAR(found.at(p, n), values[p], tolerance[p]) << "plane " << p << " at " << x << ", " << y;
        const Double3 normal{found.at(3, n), found.at(4, n), found.at(5, n)};
        ASSERT_LE(norm(normal), 1 + 1e-6);
        // Every summed normal faces its ray; the pixel's mean ray is within the view's angle of them.
        ASSERT_LE(inner(normal, truth.view.forward), std::sin(scene.camera.fov / 2 * 3.15 / 180));
        seen += f.opacity >= 1.0 / 256;
    }
    EXPECT_GT(seen, static_cast<int>(found.numbers / 5));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Features,
                         ::testing::Values(MarchedScene{"perspective", [](Scene&, const Voxels&) {}},
                                           MarchedScene{"clipped",
                                                        [](Scene& s, const Voxels& v) {
                                                            const Double3 n{0.5, -1, 0.3};
                                                            s.clip_plane = ClipPlane{n, inner(n, v.geometry.to_world({17.3, 18.1, 16.2}))};
                                                            s.clip_box = {0.2, 0, 0, 1, 1, 0.8};
                                                        }},
                                           MarchedScene{"orthographic",
                                                        [](Scene& s, const Voxels&) {
                                                            s.camera.orthographic = true;
                                                            s.camera.height = 42;
                                                        }},
                                           MarchedScene{"inside",
                                                        [](Scene& s, const Voxels& v) {
                                                            s.camera.eye = v.geometry.to_world({16, 20, 17});
                                                            s.camera.fov = 90;
                                                        }}),
                         [](const auto& tested) { return tested.param.name; });

TEST(FeatureConstants, HoldWhereNothingIsSeen) {
    const Voxels v = shell();
    const Stage stage(v, shell_scene(v));
    Device device = shared_device();
    const Marched m = march(device, stage);
    const float constants[10] = {1, 1, 1, 0, 0, 0, 1, 0, 0, 1};
    int hidden = 0;
    for (std::uint32_t n = 0; n < m.numbers; ++n) {
        const bool seen = m.at(7, n) >= 0.00390625f;
        for (int p = 0; p < 10; ++p)
            if (p != 7 && !seen) {
                EXPECT_EQ(m.at(p, n), constants[p]) << "plane " << p;
            }
        hidden += !seen;
    }
    EXPECT_GT(hidden, 50);
}

/// Cells without extinction are skipped in steps of the lattice: forced to be walked, they give the same bits.
TEST(Skipping, NeverMovesTheLattice) {
    const Voxels v = volume_of<std::uint8_t>({80, 80, 80}, [](int x, int y, int z) {
        return (x / 12 + y / 9 + z / 14) % 4 == 0 && (x - 40) * (x - 40) + (y - 40) * (y - 40) + (z - 40) * (z - 40) < 1400
                   ? 60 + (x * y + z) % 190
                   : 0;
    });
    Scene s = plain_scene(48, 1);
    s.transfer->points = {{0, {1, 0.5, 0.2}, 0}, {50, {1, 0.5, 0.2}, 0}, {255, {0.3, 0.6, 1}, 0.5}};
    s.extinction = 0.5;
    s.camera.target = Double3{40, 40, 40};
    s.camera.eye = Double3{-90, -130, 75};
    s.camera.fov = 32;
    Device device = shared_device();
    Stage stage(v, s);
    const auto empty = std::count(stage.classified.majorants.begin(), stage.classified.majorants.end(), 0.0f);
    ASSERT_GT(empty, 20);
    for (March kind : {March::features, March::dvr, March::mip}) {
        const std::vector<float> majorants = stage.classified.majorants;
        const Marched skipping = march(device, stage, kind);
        for (float& m : stage.classified.majorants) m = std::max(m, 0.5f);
        const Marched walking = march(device, stage, kind);
        stage.classified.majorants = majorants;
        EXPECT_EQ(std::memcmp(skipping.planes.data(), walking.planes.data(), 4 * skipping.planes.size()), 0) << static_cast<int>(kind);
        EXPECT_GT(*std::max_element(skipping.planes.begin(), skipping.planes.end()), 0.3f);
    }
}

TEST(Ramp, OfColoursIsARampInThePicture) {
    const Voxels v = volume_of<std::uint8_t>({70, 12, 70}, [](int x, int, int) { return 3 * x; });
    Scene s = plain_scene(60, 1);
    s.transfer = TransferFunction{false, {{0, {0, 0, 1}, 1}, {255, {1, 0, 0}, 1}}, "ramp"};
    s.extinction = 1;
    look_along_y(s, {34.5, 5.5, 34.5}, 60);
    for (int log2_edge : {3, 4, 5}) {
        Device device = open_device();
        device.set_tunable("brick_log2", log2_edge);
        const Stage stage(v, s);
        const Marched m = march(device, stage);
        for (std::uint32_t n = 0; n < m.numbers; ++n) {
            const double expected = 3 * (34.5 + position(n, 60)[0] + 0.5 - 30) / 255; // looking along +y, x grows to the right
            ASSERT_NEAR(m.at(0, n), expected, 1e-6) << "brick edge 2^" << log2_edge;
            ASSERT_NEAR(m.at(2, n), 1 - expected, 1e-6);
        }
    }
}

/// How much a smaller step would still change, for steep transfer functions at the optical depth per voxel of a 256^3 volume.
TEST(Step, HalvedChangesTheOpacityLittle) {
    const Voxels v = volume_of<std::uint8_t>({128, 128, 128}, [](int x, int y, int z) {
        const double r = std::sqrt((x - 64.0) * (x - 64) + (y - 64.0) * (y - 64) + (z - 64.0) * (z - 64));
        const double waves = std::sin(0.31 * x + 0.11 * z) * std::cos(0.23 * y) + std::sin(0.27 * z + 0.1 * y);
        return std::clamp(110 + 45 * waves - 1.5 * std::max(0.0, r - 40), 0.0, 255.0);
    });
    const std::array<double, 3> white{1, 1, 1};
    const std::vector<TransferFunction::Point> edge{{0, white, 0}, {120, white, 0}, {123, white, 1}, {255, white, 1}},
        thin_shell{{0, white, 0}, {110, white, 0}, {120, white, 0.3}, {130, white, 0}, {255, white, 0}},
        dense_shell{{0, white, 0}, {100, white, 0}, {120, white, 1}, {140, white, 0}, {255, white, 0}};
    Device device = shared_device();
    for (const auto& points : {edge, thin_shell, dense_shell}) {
        Scene s = plain_scene(160, 1);
        s.transfer->points = points;
        s.extinction = 512 / (256 * std::sqrt(3.0));
        s.camera.target = Double3{64, 64, 64};
        s.camera.eye = Double3{164, -136, 94};
        Stage stage(v, s);
        const StepError error = step_error(device, stage, stage.render.step);
        EXPECT_LT(error.mean, 1e-3);
        EXPECT_LT(error.percentile, 1e-2);
        EXPECT_GT(error.mean, 1e-6);
    }
}

} // namespace
} // namespace clvr::testing

// Scenes that between them use every part of the renderer, and the hashes of their pictures.
#pragma once
#include "tests/render/scenes.hpp"

#include <map>

namespace clvr::testing {

/// pixel_hash of each golden scene, the same on every conforming device. A change means that pictures change: made on purpose only,
/// together with DESIGN.md or a default. To make them anew: run `test_render_device --gtest_filter='Golden.*'` and copy what it prints.
inline const std::map<std::string, std::string> golden_hashes{
    {"automatic", "1b6fe8327194affacfc7ad8f24bd9c827568424669319adbab1e6bc46399ae94"},
    {"dvr", "730d603450250592a3f7daa30de636b007d3528b75bfd6bc12bc9d7994a90db5"},
    {"gradient", "a0f807e28d0b4f21e1134d3e289bfaec4d6d41fa4fdf382cf8067b65bfb8bdad"},
    {"mip", "d03b29a4c5588dc93a447e74d6b786996c6c0f0a67676b7d1c56293c7a6c1e61"},
    {"phase", "f91c27fa627945a7fa2b32b5fe4a50e2ce13e53fb2b855d0b5b967422bd8d17d"},
};

/// A solid ball with a rippled shell, 4 Mvoxel, made of whole numbers: the same voxels everywhere. Oblique, with three spacings.
inline const PreparedVolume& golden_volume() {
    static const PreparedVolume prepared([] {
        const Int3 dims{150, 160, 170};
        Voxels v = volume_of<std::uint8_t>(dims, [&](int x, int y, int z) {
            const int dx = 2 * x - 149, dy = 2 * y - 150, dz = 2 * z - 172, d2 = dx * dx + dy * dy + dz * dz;
            const int ball = std::max(0, 230 - d2 / 160), ripple = (x / 5 + y / 7 + z / 3) % 5 * 4;
            return std::min(255, ball > 40 && ball < 90 ? ball + ripple : ball);
        });
        v.slope = 2;
        v.intercept = -100;
        v.geometry.origin = {-40, 25, 10};
        v.geometry.spacing = {0.5, 0.75, 0.625};
        v.geometry.direction.row = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
        return v;
    }());
    return prepared;
}

inline TransferFunction golden_transfer() {
    TransferFunction tf;
    tf.points = {{-100, {0.2, 0.3, 0.9}, 0},    {-60, {0.2, 0.3, 0.9}, 0},   {-20, {0.9, 0.5, 0.3}, 0.05}, {60, {0.9, 0.7, 0.5}, 0.02},
                 {100, {0.95, 0.9, 0.85}, 0.4}, {100, {0.8, 0.1, 0.1}, 0.7}, {360, {1, 1, 1}, 1}};
    tf.name = "golden";
    return tf;
}

/// 16 x 8 texels over two decades, one of them bright.
inline EnvironmentTables golden_environment() {
    std::vector<float> rgb(3 * 16 * 8);
    for (int i = 0; i < 3 * 16 * 8; ++i) rgb[i] = static_cast<float>(1 + i * 37 % 101) / 64;
    for (int k = 0; k < 3; ++k) rgb[3 * (2 * 16 + 5) + k] = 40;
    return environment_tables(16, 8, rgb, 1);
}

inline Scene golden_scene(const std::string& name) {
    Scene s;
    s.volume = "golden";
    s.transfer = golden_transfer();
    s.width = 44;
    s.height = 36;
    s.spp = 6;
    s.seed = 20261122;
    if (name == "automatic") {
        s.phase_g = 0.3;
        s.light.headlight = 0.4;
        s.clip_plane = ClipPlane{{0.4, -1, 0.6}, 24};
    } else if (name == "gradient") {
        s.shading = Shading::gradient;
        s.bounces = 0;
        s.camera.orthographic = true;
        s.camera.elevation = 35;
        s.light.environment = Light::Environment::image;
        s.light.image = "golden";
        s.light.image_rotation = 30;
        s.background.kind = Background::Kind::environment;
        s.clip_box = {0.1, 0, 0.2, 0.7, 1, 1};
    } else if (name == "phase") {
        s.shading = Shading::phase;
        s.phase_g = -0.4;
        s.bounces = 3;
        s.width = 33; // no multiple of the 4x4 blocks
        s.height = 41;
        s.view = 3;
        s.light.environment = Light::Environment::constant;
        s.light.level = 0.5;
        s.light.key_angle = 0;
        s.background.kind = Background::Kind::color;
        s.background.color = {0.25, 0.5, 0.75};
    } else {
        s.mode = name == "dvr" ? Mode::dvr : Mode::mip;
        s.features = name == "dvr";
        if (name == "dvr") s.background.kind = Background::Kind::environment;
    }
    return s;
}

inline Frame render_golden(const std::string& name, std::vector<Device> devices, const RenderControl& control = {}) {
    const Scene scene = golden_scene(name);
    const bool image = scene.light.environment == Light::Environment::image;
    return Renderer(std::move(devices), golden_volume(), scene, image ? golden_environment() : EnvironmentTables{}).render(control);
}

/// The picture of a golden scene on a device with some tunables set has the golden hash.
inline void expect_golden(const std::string& name, const std::map<std::string, int>& tunables = {}) {
    Device device = open_device();
    std::string what = name;
    for (const auto& [tunable, value] : tunables) {
        device.set_tunable(tunable, value);
        what += " " + tunable + "=" + std::to_string(value);
    }
    EXPECT_EQ(pixel_hash(render_golden(name, {device})), golden_hashes.at(name)) << what;
}

/// The same in `pools` buffers, forced by the greatest allocation.
inline void expect_golden_in_pools(const std::string& name, int pools, const std::string& max_alloc) {
    const ScopedVariable limit("CLVR_MAX_ALLOC", max_alloc);
    Device device = open_device();
    device.set_tunable("wave_paths", 1 << 15); // whose state fits, too
    const Stage stage(golden_volume().voxels, golden_scene(name));
    ASSERT_EQ(device_layout(device, stage.classified).pools, pools);
    EXPECT_EQ(pixel_hash(render_golden(name, {device})), golden_hashes.at(name)) << pools << " pools";
}

} // namespace clvr::testing

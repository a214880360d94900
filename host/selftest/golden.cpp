#include "host/selftest/golden.hpp"

#include "host/denoise/denoiser.hpp"
#include "host/selftest/scenes.hpp"

namespace clvr::selftest {
namespace {
TransferFunction golden_transfer() {
    TransferFunction tf;
    tf.points = {{-100, {0.2, 0.3, 0.9}, 0},    {-60, {0.2, 0.3, 0.9}, 0},   {-20, {0.9, 0.5, 0.3}, 0.05}, {60, {0.9, 0.7, 0.5}, 0.02},
                 {100, {0.95, 0.9, 0.85}, 0.4}, {100, {0.8, 0.1, 0.1}, 0.7}, {360, {1, 1, 1}, 1}};
    tf.name = "golden";
    return tf;
}

/// 16 x 8 texels over two decades, one of them bright.
EnvironmentTables golden_environment() {
    std::vector<float> rgb(3 * 16 * 8);
    for (int i = 0; i < 3 * 16 * 8; ++i) rgb[i] = static_cast<float>(1 + i * 37 % 101) / 64;
    for (int k = 0; k < 3; ++k) rgb[3 * (2 * 16 + 5) + k] = 40;
    return environment_tables(16, 8, rgb, 1);
}

/// A ball in a corner of a cell, made of whole numbers; 2 mm slices.
const PreparedVolume& small_volume() {
    static const PreparedVolume prepared([] {
        Voxels v = volume_of<std::int16_t>({20, 19, 18}, [](int x, int y, int z) {
            const int dx = 2 * x - 21, dy = 2 * y - 17, dz = 2 * z - 15;
            return std::max(-1000, 1200 - 6 * (dx * dx + dy * dy + dz * dz) + (x * 5 + y * 3 + z * 7) % 11 * 20);
        });
        v.geometry.spacing = {1, 1, 2};
        return v;
    }());
    return prepared;
}

} // namespace

const PreparedVolume& golden_volume() {
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

Scene golden_scene(const std::string& name) {
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

Frame render_golden(const std::string& name, const std::vector<Device>& devices, const RenderControl& control) {
    const Scene scene = golden_scene(name);
    const bool image = scene.light.environment == Light::Environment::image;
    return clvr::render(devices, golden_volume(), scene, image ? golden_environment() : EnvironmentTables{}, control);
}

Frame golden_noisy_frame() {
    Frame f;
    f.width = 70, f.height = 45;
    std::uint32_t k = 17;
    const auto noise = [&] {
        k = k * 1664525u + 1013904223u;
        return static_cast<float>(k >> 8) * 0x1p-24f;
    };
    for (const auto& name : reference_channels()) f.channel(name);
    for (const char* name : {channel::alpha, channel::opacity}) f.channel(name);
    for (const char* name : channel::variance) f.channel(name);
    for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * f.width + x;
            const int dx = 2 * x - f.width, dy = 2 * y - f.height;
            const bool disc = dx * dx + dy * dy < 1300;
            f.channel(channel::alpha)[i] = f.channel(channel::opacity)[i] = disc ? 1.0f : (x + y) % 3 == 0 ? 0.25f : 0.0f;
            for (const char* c : channel::colour) f.channel(c)[i] = f.at(channel::alpha)[i] * 2 * noise() * noise();
            for (const char* c : channel::variance) f.channel(c)[i] = f.at(channel::alpha)[i] * noise() * 0.125f;
            for (const char* c : channel::albedo) f.channel(c)[i] = disc ? 0.25f + 0.5f * static_cast<float>(x / 7 % 2) : 1;
            for (const char* c : channel::normal) f.channel(c)[i] = disc ? static_cast<float>((x + y) % 17 - 8) / 16 : 0;
            f.channel(channel::depth)[i] = disc ? static_cast<float>(y) / 64 : 1;
        }
    return f;
}

Model golden_network() {
    Model m;
    m.channels = reference_channels();
    m.exposure = m.opacity_weight = true;
    m.albedo_floor = 0x1p-5f;
    initialise(m, 5);
    return m;
}

Frame golden_denoised(const Device& device) { return Denoiser(device, golden_network()).denoise(golden_noisy_frame()); }

Model tiny_network() {
    Model m;
    m.channels = {channel::colour.begin(), channel::colour.end()};
    m.channels.insert(m.channels.end(), {channel::albedo[1], channel::normal[2], channel::depth});
    m.hidden = 4;
    m.kernel = 3;
    m.levels = {{4, 32}, {8, 64}};
    m.exposure = m.opacity_weight = true;
    initialise(m, 3);
    return m;
}

Frame golden_picture(Device device) {
    Scene s;
    s.volume = "golden";
    s.transfer = golden_transfer();
    s.transfer->points.front().value = -1000;
    s.width = s.height = 12;
    s.spp = 1;
    s.seed = 7;
    s.bounces = 2;
    s.phase_g = 0.25;
    return Denoiser(device, tiny_network()).denoise(clvr::render({device}, small_volume(), s));
}

} // namespace clvr::selftest

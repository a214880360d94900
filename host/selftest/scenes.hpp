// Small volumes and scenes of which it is known what they should give: shared by the self-test and the tests of the renderer.
#pragma once
#include "host/render/device_volume.hpp"
#include "host/render/params.hpp"
#include "host/render/session.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace clvr::selftest {

/// Voxels of stored type T with the value f(x, y, z) at each index position; spacing 1 mm, origin 0.
template <class T, class F>
Voxels volume_of(const Int3& dims, F&& f) {
    Voxels v;
    v.type = std::is_same_v<T, std::uint8_t>    ? VoxelType::u8
             : std::is_same_v<T, std::int8_t>   ? VoxelType::i8
             : std::is_same_v<T, std::uint16_t> ? VoxelType::u16
             : std::is_same_v<T, std::int16_t>  ? VoxelType::i16
                                                : VoxelType::f32;
    v.dims = dims;
    v.bytes.resize(v.count() * sizeof(T));
    std::size_t i = 0;
    for (int z = 0; z < dims[2]; ++z)
        for (int y = 0; y < dims[1]; ++y)
            for (int x = 0; x < dims[0]; ++x, ++i) {
                const T stored = static_cast<T>(f(x, y, z));
                std::memcpy(v.bytes.data() + i * sizeof(T), &stored, sizeof(T));
            }
    return v;
}

inline Voxels constant_volume(const Int3& dims, std::uint8_t value = 128) {
    return volume_of<std::uint8_t>(dims, [&](int, int, int) { return value; });
}

/// Every value has this colour and opacity.
inline TransferFunction uniform_transfer(const std::array<double, 3>& color, double opacity = 1) {
    TransferFunction tf;
    tf.points = {{0, color, opacity}, {255, color, opacity}};
    tf.name = "uniform";
    return tf;
}

/// A scene without features, key light and background under a constant environment.
inline Scene plain_scene(int side, int spp) {
    Scene s;
    s.volume = "test";
    s.width = s.height = side;
    s.spp = spp;
    s.features = false;
    s.shading = Shading::phase;
    s.transfer = uniform_transfer({1, 1, 1});
    s.light.environment = Light::Environment::constant;
    s.light.key = 0;
    return s;
}

/// Looks along +y at the point `target` with an orthographic view of `height` mm.
inline void look_along_y(Scene& s, const Double3& target, double height, double distance = 100) {
    s.camera.orthographic = true;
    s.camera.target = target;
    s.camera.eye = Double3{target[0], target[1] - distance, target[2]};
    s.camera.height = height;
}

/// A smooth blob of white matter; 1/mm where it is densest.
inline Scene furnace_scene(Shading shading, double g, int spp) {
    Scene s = plain_scene(24, spp);
    s.shading = shading;
    s.phase_g = g;
    s.bounces = 0;
    s.extinction = 1;
    s.transfer->points[0].opacity = 0;
    s.background.kind = Background::Kind::environment;
    return s;
}

inline Voxels blob(int side) {
    return volume_of<std::uint8_t>({side, side, side}, [&](int x, int y, int z) {
        const double dx = x - 0.5 * side, dy = y - 0.4 * side, dz = z - 0.45 * side;
        return 255 * std::exp(-12 * (dx * dx + dy * dy + dz * dz) / (side * side));
    });
}

/// The pieces that a RenderSession puts together, within reach of a test. The scene names eye, target and transfer function.
struct Stage {
    PreparedVolume volume;
    Scene scene;
    EnvironmentTables environment;
    Classified classified;
    shared::RenderParams render;

    Stage(Voxels v, Scene s, EnvironmentTables e = {}) : volume(std::move(v)), scene(std::move(s)), environment(std::move(e)) {
        classified = classify(volume, scene.transfer);
        render = render_params(scene, volume.voxels, resolve_view(scene, {{0, 0, 0}}, false), environment);
    }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    DeviceVolume upload(Device& device, const BrickLayout& layout) const {
        return {device, classified, layout, volume_params(scene, volume.voxels, volume.grid, classified.table, layout)};
    }
    DeviceVolume upload(Device& device) const { return upload(device, device_layout(device, classified)); }
};

struct Mean {
    double value = 0, sigma = 0; ///< of the channel over the picture, and its standard error
};

inline double mean_of(const std::vector<float>& channel) {
    double sum = 0;
    for (float x : channel) sum += x;
    return sum / static_cast<double>(channel.size());
}

/// Mean of R, G or B and its standard error by the variance channels.
inline Mean image_mean(const Frame& frame, const std::string& name) {
    const double pixels = static_cast<double>(frame.pixels());
    return {mean_of(frame.at(name)), std::sqrt(mean_of(frame.at("variance." + name)) / pixels)};
}

} // namespace clvr::selftest

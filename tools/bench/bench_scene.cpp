#include "tools/bench/bench_scene.hpp"

#include "host/render/params.hpp"
#include "host/render/pixel_numbers.hpp"
#include "host/render/view.hpp"

#include <map>

namespace clvr::bench {

Voxels benchmark_volume(int edge) {
    Voxels v;
    v.dims = {edge, edge, edge};
    v.bytes.resize(v.count());
    const auto lattice = [](int x, int y, int z) {
        std::uint32_t h =
            static_cast<std::uint32_t>(x * 73856093) ^ static_cast<std::uint32_t>(y * 19349663) ^ static_cast<std::uint32_t>(z * 83492791);
        h = (h ^ (h >> 13)) * 0x5bd1e995u;
        return static_cast<double>((h ^ (h >> 15)) & 0xffff) / 65535;
    };
    const double cell = edge / 8.0, middle = (edge - 1) / 2.0, radius = edge * 120 / 256.0;
    std::size_t i = 0;
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x, ++i) {
                const double dx = x - middle, dy = y - middle, dz = z - middle;
                if (dx * dx + dy * dy + dz * dz >= radius * radius) continue;
                const double p[3] = {x / cell, y / cell, z / cell};
                double t[3], sum = 0;
                int c[3];
                for (int a = 0; a < 3; ++a) c[a] = static_cast<int>(p[a]), t[a] = p[a] - c[a], t[a] = t[a] * t[a] * (3 - 2 * t[a]);
                for (int k = 0; k < 8; ++k)
                    sum += lattice(c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)) * (k & 1 ? t[0] : 1 - t[0]) *
                           (k & 2 ? t[1] : 1 - t[1]) * (k & 4 ? t[2] : 1 - t[2]);
                v.bytes[i] = static_cast<unsigned char>(sum * 255);
            }
    return v;
}

const PreparedVolume& prepared_volume(int edge) {
    static std::map<int, std::unique_ptr<PreparedVolume>> known;
    auto& volume = known[edge];
    if (!volume) volume = std::make_unique<PreparedVolume>(benchmark_volume(edge));
    return *volume;
}

Scene benchmark_scene(int width, int height, int spp) {
    Scene scene;
    scene.volume = "benchmark";
    scene.width = width, scene.height = height, scene.spp = spp;
    scene.features = false;
    scene.seed = 20261126;
    scene.camera.azimuth = 25, scene.camera.elevation = 15;
    scene.transfer =
        TransferFunction{false, {{0, {0.1, 0.1, 0.1}, 0}, {140, {0.9, 0.6, 0.4}, 0}, {170, {0.9, 0.9, 0.9}, 0.6}, {255, {1, 1, 1}, 1}}, ""};
    return scene;
}

SceneOnDevice::SceneOnDevice(Device& device, const PreparedVolume& prepared, const Scene& scene)
    : pixels(pixel_numbers(scene.width, scene.height)) {
    const Voxels& voxels = prepared.voxels;
    classified = classify(prepared, scene.transfer);
    const BrickLayout layout = device_layout(device, classified);
    volume_params = clvr::volume_params(scene, voxels, prepared.grid, classified.table, layout);
    const auto outline = visible_outline(voxels.geometry, prepared.grid, classified.majorants, {}, clip_box_index(scene, voxels));
    render_params = clvr::render_params(scene, voxels, resolve_view(scene, outline, false), {});
    volume = std::make_unique<DeviceVolume>(device, classified, layout, volume_params);
    light = std::make_unique<DeviceLights>(device, render_params, EnvironmentTables{});
    const SkySplit split = split_sky(render_params, EnvironmentTables{});
    keys = std::make_unique<KeyLights>(device, key_lights(render_params, split));
    sky = std::make_unique<SkyLight>(device, *volume, split);
}

} // namespace clvr::bench

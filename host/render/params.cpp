#include "host/render/params.hpp"
#include "host/appearance/majorants.hpp"
#include "host/volume/vec.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace clvr {

namespace {

shared::float4 rounded(const Double3& v, double w = 0) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), static_cast<float>(w)};
}

Double3 diagonal(const Voxels& v) {
    Double3 d;
    for (int a = 0; a < 3; ++a) d[a] = v.dims[a] * v.geometry.spacing[a];
    return d;
}

/// SplitMix64 (Steele, Lea, Flood 2014): mixes seed, view and purpose into the key of the random numbers.
std::uint64_t mixed(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15u;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
    return x ^ (x >> 31);
}

/// The default light brings a white Lambert surface that faces the key to radiance 1: this share of it from the sky, the rest from the key.
constexpr double sky_share = 0.42;

/// The key light: direction, disc, radiance. `other_power` is the irradiance from elsewhere: light samples are shared out by irradiance.
void set_key_light(shared::RenderParams& p, const Light& light, double camera_azimuth, double other_power) {
    const double azimuth = (camera_azimuth + light.key_azimuth) * radian, elevation = light.key_elevation * radian;
    const Double3 key{std::cos(elevation) * std::sin(azimuth), -std::cos(elevation) * std::cos(azimuth), std::sin(elevation)};
    const Double3 side = unit(std::abs(key[2]) < 0.9 ? cross({0, 0, 1}, key) : cross({1, 0, 0}, key)), above = cross(key, side);
    const bool directional = light.key_angle <= 0;
    const double cosine = directional ? 1 : std::cos(light.key_angle / 2 * radian);
    const double irradiance = light.key * (1 - sky_share) * pi, solid_angle = 2 * pi * (1 - cosine);
    const double facing = pi * (1 - cosine * cosine); // integral of the cosine over the disc
    const double radiance = directional ? irradiance : irradiance / facing;
    const double head = light.headlight, all = irradiance + head + other_power;
    p.key = rounded(key, cosine);
    p.key_right = rounded(side, directional ? 1 : solid_angle);
    p.key_up = rounded(above, all > 0 ? irradiance / all : 0);
    p.key_radiance = rounded({radiance, radiance, radiance}, all > 0 ? head / all : 0);
    p.head_irradiance = rounded({head, head, head});
}

/// Cells of mean opacity: of 2 voxels' edge up to 2^18 of them, of 4 up to 2^22, else of more; a brick holds whole ones.
shared::int4 coarse_cells(const Int3& dims, int brick_log2_edge) {
    for (int log2_edge = 1;; ++log2_edge) {
        const std::int64_t most_cells = log2_edge == 1 ? 1 << 18 : 1 << 22;
        const auto cells = [&](int a) { return (std::max(dims[a] - 2, 0) >> log2_edge) + 1; };
        if (log2_edge >= brick_log2_edge || std::int64_t{cells(0)} * cells(1) * cells(2) <= most_cells)
            return {cells(0), cells(1), cells(2), log2_edge};
    }
}

} // namespace

double resolved_extinction(const Scene& scene, const Voxels& v) {
    return scene.extinction > 0 ? scene.extinction : 512 / norm(diagonal(v));
}

IndexBox clip_box_index(const Scene& scene, const Voxels& v) {
    IndexBox box;
    for (int a = 0; a < 3; ++a) {
        const double low = scene.clip_box ? (*scene.clip_box)[a] : 0, high = scene.clip_box ? (*scene.clip_box)[a + 3] : 1;
        box.low[a] = low * v.dims[a] - 0.5, box.high[a] = high * v.dims[a] - 0.5;
    }
    return box;
}

shared::VolumeParams volume_params(const Scene& scene, const Voxels& v, const MajorantGrid& grid, const TransferTable& table,
                                   const BrickLayout& layout) {
    shared::VolumeParams p{};
    const auto last = [&](int a) { return std::max(v.dims[a], 2) - 1; };
    p.last = {last(0), last(1), last(2), 0};
    p.cells = {grid.cells[0], grid.cells[1], grid.cells[2], grid.log2_edge};
    p.bricks = {layout.bricks[0], layout.bricks[1], layout.bricks[2], layout.log2_edge};
    p.coarse = coarse_cells(v.dims, layout.log2_edge);
    const IndexBox box = clip_box_index(scene, v);
    const TableIndex index(table);
    p.box_low = rounded(box.low, index.first);
    p.box_high = rounded(box.high, index.scale);

    const Matrix3 to_world = v.geometry.index_to_world(), to_index = to_world.inverse(), to_normal = to_index.transposed();
    for (int r = 0; r < 3; ++r) p.to_index[r] = rounded(to_index.row[r]), p.to_normal[r] = rounded(to_normal.row[r]);
    if (scene.clip_plane) {
        const Double3 n = unit(scene.clip_plane->normal), in_index = to_world.transposed() * n;
        const double offset = scene.clip_plane->offset / norm(scene.clip_plane->normal) - inner(n, v.geometry.origin);
        p.plane = rounded(in_index, offset);
    }
    p.extinction = static_cast<float>(resolved_extinction(scene, v));
    const double least_spacing = *std::min_element(v.geometry.spacing.begin(), v.geometry.spacing.end());
    p.surface_scale = table.visible_width > 0 ? static_cast<float>(4 * least_spacing / table.visible_width) : 0.0f;
    p.shading = static_cast<int>(scene.shading);
    return p;
}

shared::RenderParams render_params(const Scene& scene, const Voxels& v, const View& view, const EnvironmentTables& environment) {
    shared::RenderParams p{};
    const Matrix3 to_index = v.geometry.index_to_world().inverse();
    p.eye = rounded(v.geometry.to_index(view.eye), view.orthographic ? 1 : 0);
    p.right = rounded(view.orthographic ? to_index * view.right : view.right);
    p.up = rounded(view.orthographic ? to_index * view.up : view.up);
    p.forward = rounded(view.forward);
    p.width = scene.width, p.height = scene.height;
    p.bounces = scene.bounces;
    p.phase_g = static_cast<float>(scene.phase_g);

    // The sky's radiance is proportional to 0.6 + 0.3 z: 0.3 below, 0.9 above. A black environment keeps a density to divide by.
    const Light& light = scene.light;
    const double level = std::max(light.level, 1e-20);
    double power = pi * level;
    if (light.environment == Light::Environment::sky) {
        const double facing = 0.6 + 0.2 * std::sin(light.key_elevation * radian); // radiance of a white Lambert surface that faces the key
        const double scale = level * sky_share / facing;
        p.sky = {static_cast<float>(0.6 * scale), static_cast<float>(0.3 * scale), 1, 0};
        power = pi * level * sky_share;
    } else {
        const double turn = light.image_rotation * radian;
        p.sky = {static_cast<float>(level), 0, static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn))};
    }
    if (light.environment == Light::Environment::image) {
        p.environment_width = environment.width, p.environment_height = environment.height;
        power = pi * environment.mean_luminance;
    }
    set_key_light(p, light, view_azimuth(view, scene.camera.azimuth), power);

    const std::uint64_t key = mixed(mixed(scene.seed) ^ mixed(static_cast<std::uint64_t>(scene.view) + 0x5EED));
    p.key0 = static_cast<std::uint32_t>(key), p.key1 = static_cast<std::uint32_t>(key >> 32);

    p.step = static_cast<float>(0.5 * *std::min_element(v.geometry.spacing.begin(), v.geometry.spacing.end()));
    const IndexBox box = clip_box_index(scene, v);
    const Double3 low = v.geometry.to_world(box.low), high = v.geometry.to_world(box.high), centre = (low + high) * 0.5;
    double radius = 0;
    for (int k = 0; k < 8; ++k)
        radius = std::max(radius, norm(v.geometry.to_world({k & 1 ? box.high[0] : box.low[0], k & 2 ? box.high[1] : box.low[1],
                                                            k & 4 ? box.high[2] : box.low[2]}) -
                                       centre));
    const double distance = view.orthographic ? inner(centre - view.eye, view.forward) : norm(centre - view.eye);
    const double nearest = std::max(0.0, distance - radius);
    p.depth_near = static_cast<float>(nearest);
    p.depth_scale = static_cast<float>(1 / std::max(distance + radius - nearest, 1e-30));
    return p;
}

} // namespace clvr

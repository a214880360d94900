#include "host/render/direct_light.hpp"
#include "host/render/surface_lobe.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace clvr {

std::vector<shared::KeyLight> key_lights(const shared::RenderParams& p, const SkySplit& sky) {
    std::vector<shared::KeyLight> keys;
    const auto has_power = [](const shared::float4& v) { return v.x > 0 || v.y > 0 || v.z > 0; };
    if (has_power(p.key_radiance)) {
        const bool directional = p.key.w >= 1;
        const float solid_angle = directional ? 1 : p.key_right.w; // a directional light's "radiance" is its irradiance
        const double half_cosine = 1 - (1 - static_cast<double>(p.key.w)) / 2;
        shared::KeyLight key{p.key, p.key_right, p.key_up, {}};
        key.direction.w = directional ? 0 : static_cast<float>(std::sqrt(1 - half_cosine * half_cosine));
        key.irradiance = {p.key_radiance.x * solid_angle, p.key_radiance.y * solid_angle, p.key_radiance.z * solid_angle, 0};
        keys.push_back(key);
    }
    if (has_power(p.head_irradiance)) {
        shared::KeyLight head{};
        head.direction = {-p.forward.x, -p.forward.y, -p.forward.z, 0};
        head.irradiance = p.head_irradiance;
        keys.push_back(head);
    }
    std::copy(sky.suns.begin(), sky.suns.end(), std::back_inserter(keys)); // g++ 14 warns of a range insert after push_back
    return keys;
}

SkyLight::SkyLight(Device& device, const DeviceVolume& volume, const SkySplit& sky, bool draft) : draft_(draft) {
    const std::int64_t most_corners = draft ? 1 << 12 : 1 << 16;
    const shared::VolumeParams& v = volume.params();
    // Rows of to_index are the axes' directions over their spacings.
    const auto spacing = [](const shared::float4& row) { return 1 / std::sqrt(row.x * row.x + row.y * row.y + row.z * row.z); };
    const std::array<float, 3> spacings{spacing(v.to_index[0]), spacing(v.to_index[1]), spacing(v.to_index[2])};
    const float least = *std::min_element(spacings.begin(), spacings.end());
    grid_.voxel = {*std::max_element(spacings.begin(), spacings.end()), 0, 0, 0};
    for (int longest = 1;; ++longest) { // cells nearly as long as wide: on axes of wide spacing of fewer voxels
        const auto log2_edge = [&](int a) {
            int e = longest;
            while (e > 1 && spacings[a] * static_cast<float>(1 << e) > 1.5f * least * static_cast<float>(1 << longest)) --e;
            return e;
        };
        const auto corners = [](int last, int e) { return ((last + (1 << e) - 1) >> e) + 1; };
        grid_.log2_edge = {log2_edge(0), log2_edge(1), log2_edge(2), 0};
        grid_.corners = {corners(v.last.x, grid_.log2_edge.x), corners(v.last.y, grid_.log2_edge.y), corners(v.last.z, grid_.log2_edge.z),
                         0};
        if (std::int64_t{grid_.corners.x} * grid_.corners.y * grid_.corners.z <= most_corners) break;
    }
    const Range items{static_cast<std::size_t>(grid_.corners.x), static_cast<std::size_t>(grid_.corners.y),
                      static_cast<std::size_t>(grid_.corners.z)};
    light_ = device.buffer(items.x * items.y * items.z * CLVR_SKY_TERMS * sizeof(shared::float4), "sky light");
    const Buffer directions = device.upload(sky.directions, "sky directions"), radiance = device.upload(sky.radiance, "sky radiance");
    const int width = packet_width(device);
    Defines defines = volume.defines();
    defines["CLVR_WIDTH"] = std::to_string(width);
    Kernel kernel = device.kernel("volume/sky_light", defines);
    device.launch(kernel, items, kernel.group(packet_group(device)), {}, volume.arguments(), volume.coarse_opacity(), grid_, directions,
                  radiance, light_);
    device.finish(); // the directions go
}

KeyLights::KeyLights(Device& device, const std::vector<shared::KeyLight>& keys)
    : count_(static_cast<int>(keys.size())), lobe_(device.upload(surface_lobe_table(), "surface lobe")),
      keys_(device.upload(keys.empty() ? std::vector<shared::KeyLight>(1) : keys, "key lights")) {}

void KeyLights::set(Device& device, const std::vector<shared::KeyLight>& keys) {
    if (static_cast<int>(keys.size()) != count_) throw Error(ErrorKind::internal, "the number of key lights has changed", "KeyLights");
    device.write(keys_, keys.data(), keys.size() * sizeof(shared::KeyLight));
}

} // namespace clvr

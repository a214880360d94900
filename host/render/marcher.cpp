#include "host/render/marcher.hpp"

#include <algorithm>
#include <string>

namespace clvr {

std::uint32_t Marcher::pixels_per_launch(const Device& device) {
    const bool cpu = device.facts().type == DeviceType::cpu;
    return static_cast<std::uint32_t>(std::max(16, device.tunable("march_pixels", cpu ? 1 << 14 : 1 << 16)));
}

Marcher::Marcher(Device& device, const DeviceVolume& volume, const LightTables& light, const KeyLights& keys, const SkyLight& sky, int rays)
    : Marcher(device, volume, light, &keys, &sky, March::features, rays) {}

Marcher::Marcher(Device& device, const DeviceVolume& volume, const LightTables& light, March march, int rays)
    : Marcher(device, volume, light, nullptr, nullptr, march, rays) {}

Marcher::Marcher(Device& device, const DeviceVolume& volume, const LightTables& light, const KeyLights* keys, const SkyLight* sky,
                 March march, int rays)
    : device_(device), volume_(volume), light_(light), keys_(keys), sky_(sky), march_(march), width_(packet_width(device)),
      at_once_(pixels_per_launch(device)) {
    Defines defines = volume.defines();
    defines["CLVR_WIDTH"] = std::to_string(width_);
    defines["CLVR_RAYS"] = std::to_string(rays);
    defines["CLVR_MARCH"] = std::to_string(static_cast<int>(march));
    if (keys) defines["CLVR_KEYS"] = std::to_string(keys->count());
    kernel_ = device_.kernel("render/march", defines);
    planes_ = device_.buffer(std::size_t{4} * march_planes(march) * at_once_, "feature planes");
}

void Marcher::run(std::uint32_t first_pixel, std::uint32_t pixels, std::vector<float>& planes, std::size_t stride, std::size_t offset) {
    const Range group = kernel_.group(packet_group(device_, width_));
    for (std::uint32_t done = 0; done < pixels; done += at_once_) {
        const std::uint32_t n = std::min(at_once_, pixels - done);
        const Range packets{(n + width_ - 1) / width_};
        const std::uint32_t first = first_pixel + done;
        if (keys_)
            device_.launch(kernel_, packets, group, {}, volume_.arguments(), volume_.coarse_opacity(), light_.render(), keys_->lobe(),
                           keys_->keys(), sky_->grid(), sky_->light(), first, n, at_once_, planes_);
        else
            device_.launch(kernel_, packets, group, {}, volume_.arguments(), volume_.coarse_opacity(), light_.render(), first, n, at_once_,
                           planes_);
        for (int p = 0; p < march_planes(march_); ++p)
            device_.read(planes_, &planes[p * stride + offset + done], n * 4, std::size_t{4} * p * at_once_);
    }
}

} // namespace clvr

#include "host/render/marcher.hpp"
#include "host/render/tunables.hpp"

#include <algorithm>
#include <string>

namespace clvr {

std::uint32_t Marcher::pixels_per_launch(const Device& device) {
    return static_cast<std::uint32_t>(device.tunable(tunables::march_pixels));
}

Marcher::Marcher(Device& device, const DeviceVolume& volume, const DeviceLights& light, const KeyLights& keys, const SkyLight& sky,
                 int rays)
    : Marcher(device, volume, light, &keys, &sky, March::features, rays) {}

Marcher::Marcher(Device& device, const DeviceVolume& volume, const DeviceLights& light, March march, int rays)
    : Marcher(device, volume, light, nullptr, nullptr, march, rays) {}

Marcher::Marcher(Device& device, const DeviceVolume& volume, const DeviceLights& light, const KeyLights* keys, const SkyLight* sky,
                 March march, int rays)
    : device_(device), volume_(volume), light_(light), keys_(keys), sky_(sky), count_(march_planes(march, keys != nullptr)),
      width_(packet_width(device)), at_once_(pixels_per_launch(device)) {
    Defines defines = volume.defines();
    defines["CLVR_WIDTH"] = std::to_string(width_);
    defines["CLVR_RAYS"] = std::to_string(rays);
    if (keys) defines["CLVR_KEYS"] = std::to_string(keys->count());
    if (keys) direct_light_ = device_.kernel("render/direct_light", defines);
    defines["CLVR_MARCH"] = std::to_string(static_cast<int>(march));
    defines["CLVR_LIT"] = keys ? "1" : "0";
    march_ = device_.kernel("render/march", defines);
    place_ = device_.kernel("render/place");

    // Bytes a pixel.
    const std::size_t sums = keys ? sizeof(float) * rays * CLVR_LIGHT_SUMS(keys->count()) : 0, planes = sizeof(float) * count_;
    constexpr std::uint32_t least = 1024;
    while (at_once_ > least && at_once_ * std::max(sums, planes) > std::min(device.free_bytes() / 2, device.max_alloc_bytes()))
        at_once_ /= 2;
    stride_ = (at_once_ + 15) / 16 * 16; // whole packets
    planes_ = device_.buffer(sizeof(float) * count_ * stride_, "feature planes");
    if (keys) sums_ = device_.buffer(sums * stride_, "light sums");
}

void Marcher::run(std::uint32_t first_pixel, std::uint32_t pixels, std::vector<float>& planes, std::size_t stride, std::size_t offset) {
    for (std::uint32_t done = 0; done < pixels; done += at_once_) {
        const std::uint32_t n = std::min(at_once_, pixels - done);
        launch(first_pixel + done, n);
        for (int p = 0; p < count_; ++p) device_.read(planes_, &planes[p * stride + offset + done], n * 4, std::size_t{4} * p * stride_);
    }
}

void Marcher::run(std::uint32_t first_pixel, std::uint32_t pixels, Film& film, int first_plane) {
    for (std::uint32_t done = 0; done < pixels; done += at_once_) {
        const std::uint32_t n = std::min(at_once_, pixels - done), first = first_pixel + done;
        launch(first, n);
        device_.launch(place_, {n}, place_.group(64), {8.0 * n * count_, 0}, planes_, stride_, static_cast<cl_uint>(count_), first, n,
                       film.width(), film.height(), film.planes(), static_cast<cl_uint>(first_plane));
    }
}

/// Into planes_.
void Marcher::launch(std::uint32_t first, std::uint32_t pixels) {
    const std::size_t group = packet_group(device_);
    const Range packets{(pixels + width_ - 1) / width_};
    if (!keys_) {
        device_.launch(march_, packets, march_.group(group), {}, volume_.arguments(), volume_.coarse_opacity(), light_.render(), first,
                       pixels, stride_, planes_);
        return;
    }
    device_.launch(march_, packets, march_.group(group), {}, volume_.arguments(), volume_.coarse_opacity(), light_.render(), keys_->lobe(),
                   keys_->keys(), sums_, first, pixels, stride_, planes_);
    device_.launch(direct_light_, packets, direct_light_.group(group), {}, volume_.arguments(), volume_.coarse_opacity(), light_.render(),
                   keys_->keys(), sky_->grid(), sky_->light(), sums_, first, pixels, stride_, planes_);
}

} // namespace clvr

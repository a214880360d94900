// The feature, dvr and mip marcher on one device.
#pragma once
#include "host/frame/film.hpp"
#include "host/render/device_lights.hpp"
#include "host/render/device_volume.hpp"
#include "host/render/direct_light.hpp"

#include <vector>

namespace clvr {

/// What a march writes: kernels/render/march.cl.
enum class March { features, dvr, mip };
/// Planes of the result: 4 (RGBA), or of features CLVR_FEATURE_PLANES; then, with direct light, that of the keys RGB and of the sky RGB.
constexpr int march_planes(March m, bool lit = true) {
    return m != March::features ? 4 : lit ? CLVR_FEATURE_PLANES + 6 : CLVR_FEATURE_PLANES;
}

class Marcher {
public:
    /// Features, with direct light. `rays` positions a pixel (1 or 4). All arguments outlive the marcher.
    Marcher(Device& device, const DeviceVolume& volume, const DeviceLights& light, const KeyLights& keys, const SkyLight& sky, int rays);
    /// dvr, mip, or features without direct light.
    Marcher(Device& device, const DeviceVolume& volume, const DeviceLights& light, March march, int rays);

    /// Marches pixels first_pixel .. first_pixel + pixels - 1 (numbered in 4x4 blocks) into planes[p * stride + offset + i].
    void run(std::uint32_t first_pixel, std::uint32_t pixels, std::vector<float>& planes, std::size_t stride, std::size_t offset);

    /// Likewise into planes of a film on the same device, from `first_plane` on.
    void run(std::uint32_t first_pixel, std::uint32_t pixels, Film& film, int first_plane);

    /// Pixels of one launch: few enough to keep it below about 100 ms. (Fewer where the light's sums would not fit.)
    static std::uint32_t pixels_per_launch(const Device& device);

    /// Of its own buffers.
    std::size_t bytes() const { return planes_.bytes() + sums_.bytes(); }

private:
    Marcher(Device& device, const DeviceVolume& volume, const DeviceLights& light, const KeyLights* keys, const SkyLight* sky, March march,
            int rays);

    void launch(std::uint32_t first, std::uint32_t pixels);

    Device device_;
    const DeviceVolume& volume_;
    const DeviceLights& light_;
    const KeyLights* keys_; // null without direct light
    const SkyLight* sky_;
    int count_, width_; // of planes, of packets
    std::uint32_t at_once_, stride_ = 0;
    Kernel march_, direct_light_, place_;
    Buffer planes_, sums_; // sums_: from march to direct_light
};

} // namespace clvr

// The feature, dvr and mip marcher on one device.
#pragma once
#include "host/render/device_volume.hpp"
#include "host/render/direct_light.hpp"
#include "host/render/light_tables.hpp"

#include <vector>

namespace clvr {

/// What a march writes: kernels/render/march.cl.
enum class March { features, dvr, mip };
/// Planes of the result: 16 for features (albedo RGB, normal XYZ, depth, opacity, depth deviation, half depth, light of the keys RGB, of
/// the sky RGB), 4 (RGBA) else.
constexpr int march_planes(March m) { return m == March::features ? 16 : 4; }

class Marcher {
public:
    /// Features, with direct light. `rays` positions a pixel (1 or 4). All arguments outlive the marcher.
    Marcher(Device& device, const DeviceVolume& volume, const LightTables& light, const KeyLights& keys, const SkyLight& sky, int rays);
    /// dvr or mip.
    Marcher(Device& device, const DeviceVolume& volume, const LightTables& light, March march, int rays);

    /// Marches pixels first_pixel .. first_pixel + pixels - 1 (numbered in 4x4 blocks) into planes[p * stride + offset + i].
    void run(std::uint32_t first_pixel, std::uint32_t pixels, std::vector<float>& planes, std::size_t stride, std::size_t offset);

    /// Pixels of one launch: few enough to keep it below about 100 ms.
    static std::uint32_t pixels_per_launch(const Device& device);

private:
    Marcher(Device& device, const DeviceVolume& volume, const LightTables& light, const KeyLights* keys, const SkyLight* sky, March march,
            int rays);

    Device device_;
    const DeviceVolume& volume_;
    const LightTables& light_;
    const KeyLights* keys_; // of features
    const SkyLight* sky_;
    March march_;
    int width_;
    std::uint32_t at_once_;
    Kernel kernel_;
    Buffer planes_;
};

} // namespace clvr

// Direct light for the features on one device: what the marcher needs for it.
#pragma once
#include "host/appearance/sky_split.hpp"
#include "host/render/device_volume.hpp"

namespace clvr {

/// The scene's lights of one direction: key light, headlight, the suns of its environment; those without power are left out.
std::vector<shared::KeyLight> key_lights(const shared::RenderParams& params, const SkySplit& sky);

/// Sky light in a volume: spherical harmonics at corners 2 voxels apart, or more so that there are at most 2^16 (9 MiB): 8 in 256^3. It
/// depends on the volume, its classification and the environment, not on the camera.
class SkyLight {
public:
    /// Marches from the corners near anything visible. A `draft` has at most 2^12 corners and takes a tenth of the time. Throws
    /// Error{device_memory}.
    SkyLight(Device& device, const DeviceVolume& volume, const SkySplit& sky, bool draft = false);
    bool is_draft() const { return draft_; }
    const shared::SkyGrid& grid() const { return grid_; }
    const Buffer& light() const { return light_; } ///< [corners * CLVR_SKY_TERMS] float4, x fastest

private:
    bool draft_;
    shared::SkyGrid grid_;
    Buffer light_;
};

/// The key lights of a view, and the surfaces' lobe.
class KeyLights {
public:
    KeyLights(Device& device, const std::vector<shared::KeyLight>& keys);
    /// As many keys in other directions: writes those alone.
    void set(Device& device, const std::vector<shared::KeyLight>& keys);
    int count() const { return count_; }
    const Buffer& lobe() const { return lobe_; }
    const Buffer& keys() const { return keys_; } ///< [count] KeyLight

private:
    int count_;
    Buffer lobe_, keys_;
};

} // namespace clvr

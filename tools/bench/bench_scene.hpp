// The standard scene of the benchmarks: a volume computed on the host, so that every device gets the same bits, and its parts on a device.
#pragma once
#include "host/render/device_lights.hpp"
#include "host/render/device_volume.hpp"
#include "host/render/direct_light.hpp"
#include "host/render/session.hpp"

#include <memory>

namespace clvr::bench {

/// edge^3 u8: smooth blobs in a hash of a coarse lattice, about a third of it visible: shells, hollows and clear space, as a scan has.
Voxels benchmark_volume(int edge);

/// The volume of an edge with its ranges, computed once a process.
const PreparedVolume& prepared_volume(int edge);

/// Path traced at `width` x `height`, without features.
Scene benchmark_scene(int width, int height, int spp);

/// What a RenderSession puts together, for the kernels alone.
struct SceneOnDevice {
    Classified classified;
    shared::VolumeParams volume_params;
    shared::RenderParams render_params;
    std::unique_ptr<DeviceVolume> volume;
    std::unique_ptr<DeviceLights> light;
    std::unique_ptr<KeyLights> keys;
    std::unique_ptr<SkyLight> sky;
    std::uint32_t pixels; ///< pixel numbers

    SceneOnDevice(Device& device, const PreparedVolume& prepared, const Scene& scene);
};

} // namespace clvr::bench

// The wavefront path tracer on one device.
#pragma once
#include "host/render/device_lights.hpp"
#include "host/render/device_volume.hpp"

#include <atomic>
#include <vector>

namespace clvr {

/// Running statistics of pixels on a device (numbered in 4x4 blocks, kernels/lib/paths.clh): float4 each, mean RGB and alpha, sum of
/// squared deviations of RGB.
struct PixelSums {
    Buffer mean, deviation;

    PixelSums() = default;
    /// All 0.
    PixelSums(Device& device, std::uint32_t pixels);
};

class PathTracer {
public:
    /// For a picture of so many pixel numbers. `volume` and `light` outlive the tracer; the light's view may change. Waves hold tunable
    /// "wave_paths" paths (default 65536 on CPUs, 4194304 elsewhere).
    PathTracer(Device& device, const DeviceVolume& volume, const DeviceLights& light, std::uint32_t pixels);

    /// Adds samples first_sample .. first_sample + samples - 1, in sample order, to those of pixels first_pixel .. first_pixel + pixels - 1
    /// in `before`, and leaves the sums in `after`; both hold the first pixel's at `offset`. Returns false, with those in `after`
    /// undefined, when `cancelled` became true: it is looked at between launches.
    bool trace(std::uint32_t first_pixel, std::uint32_t pixels, std::uint32_t first_sample, std::uint32_t samples, const PixelSums& before,
               PixelSums& after, std::uint32_t offset, const std::atomic<bool>& cancelled);

    /// The first flight alone of one sample of pixels 0 .. pixels - 1, for benchmarks; waits for it.
    void fly_camera_rays(std::uint32_t pixels);

    /// Pixels that fill a wave at a number of samples each.
    std::uint32_t pixels_per_wave(std::uint32_t samples) const;

private:
    struct Survivors {
        std::uint32_t going, lit;
    };
    bool trace_wave(std::uint32_t first_pixel, std::uint32_t pixels, std::uint32_t first_sample, std::uint32_t samples,
                    const std::atomic<bool>& cancelled);
    void start_paths(std::uint32_t first_pixel, std::uint32_t pixels, std::uint32_t first_sample, std::uint32_t samples);
    void fly(std::uint32_t active, std::uint32_t bounce);
    void shade(std::uint32_t active, std::uint32_t bounce);
    Survivors list_survivors(std::uint32_t active);
    void gather_light(std::uint32_t lit, std::uint32_t bounce);
    BufferList paths() const;
    Range packets(std::uint32_t count) const;

    Device device_;
    const DeviceVolume& volume_;
    const DeviceLights& light_;
    std::uint32_t capacity_;
    int width_, run_;                   // lanes of a packet; packets' worth of paths that a work-item flies
    std::size_t per_packet_, per_path_; // local sizes wanted
    Kernel camera_rays_, free_flight_, shade_, compact_, transmittance_, accumulate_;
    Buffer lobe_;
    Buffer path_id_, origin_, heading_, weight_, radiance_, shadow_heading_, shadow_light_;
    Buffer active_, next_active_, state_, shadowed_, counts_;
};

} // namespace clvr

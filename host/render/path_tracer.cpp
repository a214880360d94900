#include "host/render/path_tracer.hpp"
#include "host/render/surface_lobe.hpp"
#include "host/render/tunables.hpp"

#include <algorithm>
#include <string>

namespace clvr {

namespace {

constexpr std::uint32_t samples_per_wave = 16; // at most, of one pixel: neighbouring paths are then almost the same ray
constexpr std::uint32_t compact_run = 64;

/// Paths of a wave: the tunable, less where the picture has fewer or memory is short (half of what is left is for others).
std::uint32_t wave_paths(const Device& device, std::uint32_t pixels) {
    constexpr std::size_t bytes_per_path = 8 + 6 * 16 + 4 * 4 + 2 * 16, least = 4096;
    std::size_t n = static_cast<std::size_t>(device.tunable(tunables::wave_paths));
    n = std::min(n, std::size_t{pixels} * samples_per_wave);
    while (n > least && (n * bytes_per_path > device.free_bytes() / 2 || n * 16 > device.max_alloc_bytes())) n /= 2;
    return static_cast<std::uint32_t>(n);
}

} // namespace

PixelSums::PixelSums(Device& device, std::uint32_t pixels)
    : mean(device.buffer(std::size_t{16} * pixels, "pixel means")), deviation(device.buffer(std::size_t{16} * pixels, "pixel deviations")) {
    device.fill(mean, 0);
    device.fill(deviation, 0);
}

PathTracer::PathTracer(Device& device, const DeviceVolume& volume, const DeviceLights& light, std::uint32_t pixels)
    : device_(device), volume_(volume), light_(light), width_(packet_width(device)) {
    capacity_ = wave_paths(device, pixels);
    run_ = device.tunable(tunables::packet_run);
    per_packet_ = packet_group(device);
    per_path_ = static_cast<std::size_t>(device.tunable(tunables::shade_group));
    Defines packet = volume.defines(), scalar = volume.defines();
    packet["CLVR_WIDTH"] = std::to_string(width_);
    packet["CLVR_RUN"] = std::to_string(run_);
    packet["CLVR_REFILL"] = std::to_string(std::min(device.tunable(tunables::packet_refill), width_));
    scalar["CLVR_WIDTH"] = "1";
    camera_rays_ = device_.kernel("render/camera_rays", {{"CLVR_WIDTH", "1"}});
    free_flight_ = device_.kernel("render/free_flight", packet);
    shade_ = device_.kernel("render/shade", scalar);
    compact_ = device_.kernel("render/compact", {{"CLVR_RUN", std::to_string(compact_run)}});
    transmittance_ = device_.kernel("render/transmittance", packet);
    accumulate_ = device_.kernel("render/accumulate");

    lobe_ = device_.upload(surface_lobe_table(), "surface lobe");

    const std::size_t n = capacity_;
    path_id_ = device_.buffer(n * 8, "path numbers");
    for (Buffer* b : {&origin_, &heading_, &weight_, &radiance_, &shadow_heading_, &shadow_light_})
        *b = device_.buffer(n * 16, "path state");
    for (Buffer* b : {&active_, &next_active_, &state_, &shadowed_}) *b = device_.buffer(n * 4, "path lists");
    counts_ = device_.buffer(8, "path counts");
}

std::uint32_t PathTracer::pixels_per_wave(std::uint32_t samples) const {
    return std::max(1u, capacity_ / std::min(samples, samples_per_wave));
}

bool PathTracer::trace(std::uint32_t first_pixel, std::uint32_t pixels, std::uint32_t first_sample, std::uint32_t samples,
                       const PixelSums& before, PixelSums& after, std::uint32_t offset, const std::atomic<bool>& cancelled) {
    const std::uint32_t at_once = std::min(samples, samples_per_wave), wave = pixels_per_wave(samples);
    for (std::uint32_t done = 0; done < pixels; done += wave) {
        const std::uint32_t n = std::min(wave, pixels - done);
        for (std::uint32_t s = 0; s < samples; s += at_once) {
            const std::uint32_t k = std::min(at_once, samples - s);
            if (!trace_wave(first_pixel + done, n, first_sample + s, k, cancelled)) return false;
            const PixelSums& from = s == 0 ? before : after;
            device_.launch(accumulate_, {n}, accumulate_.group(64), {n * (64.0 + 16.0 * k), 0}, radiance_, from.mean, from.deviation,
                           after.mean, after.deviation, offset + done, n, k, first_sample + s);
        }
    }
    return true;
}

void PathTracer::fly_camera_rays(std::uint32_t pixels) {
    for (std::uint32_t first = 0; first < pixels; first += capacity_) {
        const std::uint32_t n = std::min(capacity_, pixels - first);
        start_paths(first, n, 0, 1);
        fly(n, 0);
    }
    device_.finish();
}

/// Into radiance_. False when cancelled.
bool PathTracer::trace_wave(std::uint32_t first_pixel, std::uint32_t pixels, std::uint32_t first_sample, std::uint32_t samples,
                            const std::atomic<bool>& cancelled) {
    if (cancelled) return false;
    start_paths(first_pixel, pixels, first_sample, samples);
    std::uint32_t active = pixels * samples;
    for (std::uint32_t bounce = 0; active > 0; ++bounce) {
        if (cancelled) return false;
        fly(active, bounce);
        if (cancelled) return false;
        shade(active, bounce);
        const auto [going, lit] = list_survivors(active);
        if (cancelled) return false;
        gather_light(lit, bounce);
        active = going;
    }
    return true;
}

void PathTracer::start_paths(std::uint32_t first_pixel, std::uint32_t pixels, std::uint32_t first_sample, std::uint32_t samples) {
    const std::uint32_t n = pixels * samples;
    device_.launch(camera_rays_, {n}, camera_rays_.group(per_path_), {n * 92.0, 0}, light_.render(), paths(), active_, n, first_pixel,
                   first_sample, samples);
}

void PathTracer::fly(std::uint32_t active, std::uint32_t bounce) {
    device_.launch(free_flight_, packets(active), free_flight_.group(per_packet_), {}, volume_.arguments(), light_.render(), paths(),
                   active_, active, bounce);
}

void PathTracer::shade(std::uint32_t active, std::uint32_t bounce) {
    device_.launch(shade_, {active}, shade_.group(per_path_), {}, volume_.arguments(), light_.arguments(), lobe_, paths(), active_, state_,
                   active, bounce);
}

PathTracer::Survivors PathTracer::list_survivors(std::uint32_t active) {
    Survivors counts;
    device_.fill(counts_, 0);
    device_.launch(compact_, {(active + compact_run - 1) / compact_run}, {1}, {active * 20.0, 0}, active_, state_, active, next_active_,
                   shadowed_, counts_);
    device_.read(counts_, &counts, sizeof counts);
    std::swap(active_, next_active_);
    return counts;
}

void PathTracer::gather_light(std::uint32_t lit, std::uint32_t bounce) {
    if (lit == 0) return;
    device_.launch(transmittance_, packets(lit), transmittance_.group(per_packet_), {}, volume_.arguments(), light_.render(), paths(),
                   shadowed_, lit, bounce);
}

BufferList PathTracer::paths() const { return {&path_id_, &origin_, &heading_, &weight_, &radiance_, &shadow_heading_, &shadow_light_}; }

Range PathTracer::packets(std::uint32_t count) const {
    const std::size_t paths = static_cast<std::size_t>(width_) * run_;
    return {(count + paths - 1) / paths};
}

} // namespace clvr

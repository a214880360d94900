// The device's own properties: launches, builds, bandwidth, arithmetic, samples.
#include "runtime/drivers/check.hpp"
#include "tools/bench/ceiling.hpp"
#include "tools/bench/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <unistd.h>

namespace clvr::bench {
namespace {

bool is_processor(const Device& d) { return d.facts().type == DeviceType::cpu && !d.facts().simulator; }

/// A variant of a probe: its run, and how it is named.
struct Variant {
    std::function<void()> run;
    std::string name;
};

/// The variant that takes least in two runs after one to warm up: what a device is capable of.
Variant fastest(const std::vector<Variant>& variants) {
    Variant best = variants.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Variant& v : variants) {
        v.run();
        for (int k = 0; k < 2; ++k) {
            const double begin = steady_seconds();
            v.run();
            const double t = steady_seconds() - begin;
            if (t < least) least = t, best = v;
        }
    }
    return best;
}

std::vector<int> widths(const Device& d) { return d.facts().simulator ? std::vector{4} : std::vector{1, 4, 16}; }

StageRun launch_latency(std::vector<Device>& devices, Size) {
    Device d = devices.front();
    const Kernel kernel = d.kernel("probe/nothing");
    const auto count = std::make_shared<Buffer>(d.upload(std::vector<cl_uint>{0}, "counter"));
    StageRun r;
    r.run = [=]() mutable {
        Kernel k = kernel;
        d.launch(k, {1}, {1}, {}, *count);
        d.finish();
    };
    r.hash = [=]() mutable { return d.download<cl_uint>(*count, 1).front() > 0 ? "counted" : "not counted"; };
    r.items = 1;
    return r;
}

/// From source to the end of the first launch. `cached`: the same program a second time, from the driver's cache or clvr's.
StageRun build(std::vector<Device>& devices, bool cached) {
    Device d = devices.front();
    const auto made = std::make_shared<float>(0);
    StageRun r;
    r.timed_inside = true;
    // A definition of its own defeats every cache.
    const std::string unique = fmt::format("{}{:x}", getpid(), std::chrono::steady_clock::now().time_since_epoch().count());
    const auto once = [made, unique, cached](Device& device) {
        const Defines defines{{"CLVR_WIDTH", "4"}, {"CLVR_UNIQUE", cached ? "1" : "0x" + unique.substr(unique.size() - 7)}};
        const double begin = steady_seconds();
        Kernel kernel = device.kernel("probe/fma_rate", defines);
        const Buffer to = device.buffer(16, "result");
        device.launch(kernel, {1}, {1}, {}, to, 0.5f, 1.0f, 4u, 1u);
        device.finish();
        *made = device.download<float>(to, 1).front();
        return steady_seconds() - begin;
    };
    if (cached) once(d);
    Device fresh = Device::open_untested(d.facts()); // knows no program yet
    r.seconds = once(fresh);
    r.run = [] {};
    r.hash = [made] { return hash_of({*made}); };
    r.items = 1;
    return r;
}

StageRun bandwidth(std::vector<Device>& devices, Size size, bool triad) {
    Device d = devices.front();
    const std::size_t floats = size == Size::tiny ? 1 << 14 : 1 << 24;
    const float scale = 0.75f;
    const auto a = std::make_shared<Buffer>(d.upload(noise_values(floats), "a"));
    const auto b = std::make_shared<Buffer>(triad ? d.upload(noise_values(floats), "b") : Buffer());
    const auto to = std::make_shared<Buffer>(d.buffer(floats * 4, "result"));
    std::vector<Variant> variants;
    for (const int width : widths(d))
        for (const int stream : {0, 1}) {
            const Kernel kernel = d.kernel(triad ? "probe/triad" : "probe/copy",
                                           {{"CLVR_WIDTH", std::to_string(width)}, {"CLVR_STREAM", std::to_string(stream)}});
            const auto vectors = static_cast<cl_uint>(floats / static_cast<std::size_t>(width));
            variants.push_back({[=]() mutable {
                                    Kernel k = kernel;
                                    const Range group = k.group(size == Size::tiny ? 16 : 256);
                                    if (triad)
                                        d.launch(k, {vectors}, group, {}, *a, *b, *to, scale, vectors);
                                    else
                                        d.launch(k, {vectors}, group, {}, *a, *to, vectors);
                                    d.finish();
                                },
                                fmt::format("width {}{}", width, stream ? ", streaming stores" : "")});
        }
    const Variant best = size == Size::tiny ? variants.front() : fastest(variants);
    StageRun r;
    r.run = best.run;
    r.hash = [=]() mutable { return hash_of(d.download<float>(*to, floats)); };
    r.items = r.bytes = static_cast<double>(floats) * (triad ? 12 : 8);
    r.note = best.name;
    if (!is_processor(d)) return r;
    const unsigned threads = d.facts().compute_units;
    const auto x = std::make_shared<native::AlignedFloats>(floats), y = std::make_shared<native::AlignedFloats>(floats),
               z = std::make_shared<native::AlignedFloats>(triad ? floats : 0);
    r.native = [=] {
        if (triad)
            native::triad(x->data(), z->data(), y->data(), scale, floats, threads);
        else
            native::copy(x->data(), y->data(), floats, threads);
    };
    r.native_amount = r.bytes;
    return r;
}

StageRun fma_rate(std::vector<Device>& devices, Size size) {
    Device d = devices.front();
    constexpr int chains = 12;
    const bool cpu = d.facts().type == DeviceType::cpu;
    const std::size_t lanes = size == Size::tiny ? 256 : cpu ? std::size_t{1} << 14 : std::size_t{1} << 20;
    // The bits that are compared are those of the first lanes, so that a device may have as many as it likes.
    constexpr std::size_t compared = 256;
    const cl_uint rounds = size == Size::tiny ? 16 : 2048;
    const auto to = std::make_shared<Buffer>(d.buffer(lanes * 4, "result"));
    std::vector<Variant> variants;
    for (const int width : d.facts().simulator ? std::vector{4} : std::vector{1, 4, 8, 16}) {
        const Kernel kernel = d.kernel("probe/fma_rate", {{"CLVR_WIDTH", std::to_string(width)}});
        const auto items = static_cast<cl_uint>(lanes / static_cast<std::size_t>(width));
        variants.push_back({[=]() mutable {
                                Kernel k = kernel;
                                d.launch(k, {items}, k.group(size == Size::tiny ? 16 : 64), {}, *to, 0.999f, 0.25f, rounds, items);
                                d.finish();
                            },
                            fmt::format("width {}", width)});
    }
    const Variant best = size == Size::tiny ? variants.front() : fastest(variants);
    StageRun r;
    r.run = best.run;
    r.hash = [=]() mutable { return hash_of(d.download<float>(*to, compared)); };
    r.flops = r.items = 2.0 * chains * rounds * static_cast<double>(lanes);
    r.note = best.name;
    return r;
}

struct SampledVolume {
    std::shared_ptr<Buffer> voxels, to;
    int side, steps;
    std::size_t columns;
};

SampledVolume sampled_volume(Device& d, Size size) {
    const int side = size == Size::tiny ? 12 : 128;
    const auto count = static_cast<std::size_t>(side) * side;
    return {std::make_shared<Buffer>(d.upload(noise_values(count * static_cast<std::size_t>(side)), "sampled volume")),
            std::make_shared<Buffer>(d.buffer(count * 4, "samples")), side, side, count};
}

std::function<void()> sample_from_buffer(Device& d, const SampledVolume& v, int width, Size size) {
    const Kernel kernel = d.kernel("probe/sample_buffer", {{"CLVR_WIDTH", std::to_string(width)}});
    const auto items = static_cast<cl_uint>(v.columns / static_cast<std::size_t>(width));
    return [=]() mutable {
        Kernel k = kernel;
        d.launch(k, {items}, k.group(size == Size::tiny ? 4 : 64), {}, *v.voxels, *v.to, v.side, v.steps, items);
        d.finish();
    };
}

StageRun buffer_samples(std::vector<Device>& devices, Size size) {
    Device d = devices.front();
    const SampledVolume v = sampled_volume(d, size);
    std::vector<Variant> variants;
    for (const int width : widths(d)) variants.push_back({sample_from_buffer(d, v, width, size), fmt::format("width {}", width)});
    const Variant best = size == Size::tiny ? variants.front() : fastest(variants);
    StageRun r;
    r.run = best.run;
    r.hash = [=]() mutable { return hash_of(d.download<float>(*v.to, v.columns)); };
    r.items = static_cast<double>(v.columns) * v.steps;
    r.note = best.name;
    return r;
}

/// Filters of devices have weights of 8 bits, so the samples are held against those from a buffer, to 1/128 of the range a sample.
StageRun image_samples(std::vector<Device>& devices, Size size) {
    Device d = devices.front();
    if (!d.facts().handle.getInfo<CL_DEVICE_IMAGE_SUPPORT>()) throw Error(ErrorKind::device, "has no images", d.facts().name);
    const SampledVolume v = sampled_volume(d, size);
    sample_from_buffer(d, v, size == Size::tiny ? 4 : 1, size)();
    const auto truth = std::make_shared<std::vector<float>>(d.download<float>(*v.to, v.columns));
    const auto image = std::make_shared<cl::Image3D>(cl_check("an image on " + d.facts().name, [&] {
        const auto n = static_cast<cl::size_type>(v.side);
        const std::vector<float> voxels = noise_values(v.columns * static_cast<std::size_t>(v.side));
        return cl::Image3D(d.context(), CL_MEM_READ_ONLY | CL_MEM_COPY_HOST_PTR, cl::ImageFormat(CL_R, CL_FLOAT), n, n, n, 0, 0,
                           const_cast<float*>(voxels.data()));
    }));
    const Kernel kernel = d.kernel("probe/sample_image");
    const auto items = static_cast<cl_uint>(v.columns);
    StageRun r;
    r.run = [=]() mutable {
        Kernel k = kernel;
        d.launch(k, {items}, k.group(64), {}, (*image)(), *v.to, v.side, v.steps, items);
        d.finish();
    };
    r.hash = [=]() mutable {
        const std::vector<float> found = d.download<float>(*v.to, v.columns);
        float worst = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            worst = std::max(worst, std::abs(found[i] - (*truth)[i]) / static_cast<float>(v.steps));
        return worst < 1.0f / 128 ? std::string("as from a buffer") : fmt::format("off by {:.4f} a sample", worst);
    };
    r.items = static_cast<double>(v.columns) * v.steps;
    return r;
}

} // namespace

std::vector<Stage> probe_stages() {
    const std::string slow = "a simulator's speed says nothing of it";
    return {
        {"launch latency", "us", 0, Ceiling::none, "", true, "", launch_latency},
        {"build, cold", "ms", 0, Ceiling::none, "", true, "", [](auto& d, Size) { return build(d, false); }},
        {"build, cached", "ms", 0, Ceiling::none, "", true, "", [](auto& d, Size) { return build(d, true); }},
        {"copy", "GB/s", 1e9, Ceiling::none, "", true, "", [](auto& d, Size s) { return bandwidth(d, s, false); }},
        {"triad", "GB/s", 1e9, Ceiling::none, "", true, "", [](auto& d, Size s) { return bandwidth(d, s, true); }},
        {"FMA rate", "GFLOP/s", 1e9, Ceiling::none, "", true, "", fma_rate},
        {"samples, buffer", "Msamples/s", 1e6, Ceiling::none, "", true, "", buffer_samples},
        {"samples, image", "Msamples/s", 1e6, Ceiling::none, "", false, slow, image_samples},
    };
}

} // namespace clvr::bench

#include "host/render/renderer.hpp"
#include "host/render/marcher.hpp"
#include "host/render/params.hpp"
#include "host/render/path_tracer.hpp"
#include "runtime/host_memory.hpp"
#include "runtime/size.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>

namespace clvr {

namespace {

constexpr double framing_opacity = 0.02; // what is fainter does not count for the camera's framing
const std::atomic<bool> never{false};

/// x, y of a pixel number: kernels/lib/paths.clh pixel_of.
std::array<std::uint32_t, 2> pixel_of(std::uint32_t number, int width) {
    const std::uint32_t blocks_x = (width + 3u) / 4, block = number / 16;
    return {block % blocks_x * 4 + number % 4, block / blocks_x * 4 + number / 4 % 4};
}

/// Calls put(pixel number, index in the frame) for every pixel of the picture.
template <class F>
void for_pixels(std::uint32_t numbers, int width, int height, F&& put) {
    for (std::uint32_t i = 0; i < numbers; ++i) {
        const auto [x, y] = pixel_of(i, width);
        if (x < static_cast<std::uint32_t>(width) && y < static_cast<std::uint32_t>(height))
            put(i, static_cast<std::size_t>(y) * width + x);
    }
}

Classified classify(const PreparedVolume& volume, const Scene& scene) {
    Classified c;
    c.voxels = &volume.voxels;
    c.grid = &volume.grid;
    double low = volume.grid.range[0], high = volume.grid.range[1];
    for (std::size_t k = 0; k < volume.grid.range.size(); k += 2) {
        low = std::min<double>(low, volume.grid.range[k]);
        high = std::max<double>(high, volume.grid.range[k + 1]);
    }
    c.table = tabulate(scene.transfer ? *scene.transfer : automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels)),
                       volume.voxels, low, high);
    c.majorants = majorants(volume.grid, c.table);
    return c;
}

std::vector<Double3> outline_of(const Classified& c, const Scene& scene) {
    std::vector<float> clear = c.majorants;
    for (float& m : clear)
        if (m <= framing_opacity) m = 0;
    return visible_outline(c.voxels->geometry, *c.grid, clear, visible_box(*c.voxels, *c.grid, c.table, framing_opacity),
                           clip_box_index(scene, *c.voxels));
}

/// Throws Error{memory} when the picture's own buffers would not fit into what the host has left: the kernel would end the process instead.
void refuse_what_host_memory_cannot_hold(const Scene& scene) {
    const double pixels = static_cast<double>(scene.width) * scene.height;
    const double wanted =
        pixels * (64 + 4 * 4 + 3 * 4 + (scene.features ? 2 * 4 * march_planes(March::features) : 0)); // sums twice, channels, planes
    const std::size_t left = available_memory();
    if (wanted > static_cast<double>(left))
        throw Error(ErrorKind::memory,
                    "a picture of " + std::to_string(scene.width) + "x" + std::to_string(scene.height) + " pixels takes " +
                        size_text(static_cast<std::size_t>(wanted)) + " of host memory, " + size_text(left) +
                        " are left; try a smaller one",
                    "--size");
}

} // namespace

/// One device's share of the work.
struct Renderer::Worker {
    Device device;
    std::shared_ptr<const DeviceVolume> volume; // sub-devices of one context share it
    std::optional<LightTables> light;
    std::optional<KeyLights> keys;       // of the view
    std::shared_ptr<const SkyLight> sky; // of all views; shared as the volume is
    std::optional<PathTracer> tracer;
    std::optional<Marcher> marcher;
    bool compared = false; // with the others
};

Renderer::Renderer(std::vector<Device> devices, const PreparedVolume& volume, const Scene& scene, const EnvironmentTables& environment,
                   bool steady)
    : dealer_(devices), scene_(scene), volume_(volume), environment_(environment), steady_(steady) {
    validate(scene);
    refuse_what_host_memory_cannot_hold(scene);
    const Classified c = classify(volume, scene);
    if (std::none_of(c.majorants.begin(), c.majorants.end(), [](float m) { return m > 0; }))
        warnings_.push_back("nothing is visible: the transfer function gives every voxel the opacity 0; try another --tf, or `clvr info` "
                            "for the range of the values");
    outline_ = outline_of(c, scene);
    numbers_ = (scene.width + 3u) / 4 * ((scene.height + 3u) / 4) * 16;
    workers_.resize(devices.size());
    dealer_.each([&](std::size_t k) {
        Device& d = devices[k];
        std::shared_ptr<const DeviceVolume> uploaded;
        for (std::size_t other = 0; other < k; ++other)
            if (workers_[other] && devices[other].context()() == d.context()()) uploaded = workers_[other]->volume;
        if (!uploaded) {
            const BrickLayout layout = device_layout(d, c);
            uploaded = std::make_shared<DeviceVolume>(d, c, layout, volume_params(scene, volume.voxels, volume.grid, c.table, layout));
        }
        workers_[k] = std::make_unique<Worker>(Worker{d, uploaded, {}, {}, {}, {}, {}, false});
    });
    aim(scene.camera, scene.view);
}

void Renderer::aim(const Camera& camera, int view) {
    scene_.camera = camera;
    scene_.view = view;
    params_ = render_params(scene_, volume_.voxels, resolve_view(scene_, outline_, steady_), environment_);
    dealer_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        w.light.emplace(w.device, params_, environment_);
        if (w.tracer) w.tracer->aim(*w.light);
    });
}

void Renderer::turn_to(const Scene& scene) {
    refuse_what_host_memory_cannot_hold(scene);
    scene_.seed = scene.seed;
    scene_.spp = scene.spp;
    scene_.features = scene.features;
    aim(scene.camera, scene.view);
}

Renderer::~Renderer() = default;

std::vector<Device> Renderer::devices() const {
    std::vector<Device> devices;
    for (const std::size_t k : dealer_.left()) devices.push_back(workers_[k]->device);
    return devices;
}

Frame Renderer::render(const RenderControl& control) {
    Frame frame;
    frame.width = scene_.width, frame.height = scene_.height;
    if (scene_.features) march(frame, true, control);
    if (scene_.mode == Mode::path)
        trace(frame, control);
    else
        march(frame, false, control);
    lay_background(frame);
    return frame;
}

/// Each device traces the same few pixels in the picture's middle: one that computes other bits than the others must not mix with them.
void Renderer::compare_devices() {
    if (std::exchange(workers_[dealer_.left().front()]->compared, true)) return;
    const std::uint32_t count = std::min(256u, numbers_), first = (numbers_ - count) / 2;
    dealer_.compare("pictures", [&](std::size_t k) {
        PixelSums sums{std::vector<shared::float4>(count), std::vector<shared::float4>(count)};
        workers_[k]->tracer->trace(first, count, 0, 2, sums, 0, never);
        std::string bytes;
        for (const auto* values : {&sums.mean, &sums.deviation})
            bytes.append(reinterpret_cast<const char*>(values->data()), values->size() * sizeof(shared::float4));
        return bytes;
    });
}

/// Adds samples to all pixels: `before` becomes `after`. False when cancelled.
bool Renderer::trace_pass(int first_sample, int samples, const PixelSums& before, PixelSums& after, const RenderControl& control) {
    const std::atomic<bool>& cancelled = control.cancelled ? *control.cancelled : never;
    std::vector<Dealer::Portion> portions(workers_.size());
    for (const std::size_t k : dealer_.left()) {
        const Worker& w = *workers_[k];
        const std::uint32_t wave = w.tracer->pixels_per_wave(static_cast<std::uint32_t>(samples)), least = std::max(16u, wave / 256 * 16);
        portions[k] = {least,
                       std::max(least, static_cast<std::uint32_t>(std::max(16, w.device.tunable("tile_pixels", static_cast<int>(wave)))))};
    }
    std::uint32_t done = 0;
    dealer_.deal("trace", numbers_, samples, portions, [&](std::size_t k, std::uint32_t first, std::uint32_t count) {
        // From `before`, which no device changes: what one that fails leaves behind does not count.
        std::copy_n(before.mean.begin() + first, count, after.mean.begin() + first);
        std::copy_n(before.deviation.begin() + first, count, after.deviation.begin() + first);
        if (!workers_[k]->tracer->trace(first, count, static_cast<std::uint32_t>(first_sample), static_cast<std::uint32_t>(samples), after,
                                        first, cancelled))
            return;
        const std::lock_guard lock(progress_);
        done += count;
        if (control.progress)
            control.progress({(first_sample + samples * static_cast<double>(done) / numbers_) / scene_.spp, first_sample});
    });
    return !cancelled;
}

void Renderer::trace(Frame& frame, const RenderControl& control) {
    using clock = std::chrono::steady_clock;
    const auto begin = clock::now();
    dealer_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        if (!w.tracer) w.tracer.emplace(w.device, *w.volume, *w.light, numbers_);
    });
    compare_devices();

    PixelSums sums{std::vector<shared::float4>(numbers_), std::vector<shared::float4>(numbers_)}, finished = sums;
    int reached = 0;
    double seconds_per_sample = 0;
    for (int pass = 1; reached < scene_.spp; pass = std::min(pass * 2, 16)) {
        int samples = std::min(pass, scene_.spp - reached);
        const auto start = clock::now();
        if (control.seconds > 0 && reached > 0) {
            const double left = control.seconds - std::chrono::duration<double>(start - begin).count();
            samples = std::min(samples, static_cast<int>(std::max(0.0, left / seconds_per_sample)));
            if (samples == 0) break;
        }
        if (!trace_pass(reached, samples, finished, sums, control)) break;
        finished = sums;
        reached += samples;
        seconds_per_sample = std::chrono::duration<double>(clock::now() - start).count() / samples;
        if (control.progress) control.progress({static_cast<double>(reached) / scene_.spp, reached});
    }
    if (reached == 0) throw Error(ErrorKind::interrupted, "interrupted before the first sample of every pixel was done; nothing was saved");

    auto& r = frame.channel("R");
    auto& g = frame.channel("G");
    auto& b = frame.channel("B");
    auto& a = frame.channel("A");
    for_pixels(numbers_, frame.width, frame.height, [&](std::uint32_t i, std::size_t at) {
        const shared::float4& m = finished.mean[i];
        r[at] = m.x, g[at] = m.y, b[at] = m.z, a[at] = m.w;
    });
    if (reached > 1) {
        auto& vr = frame.channel("variance.R");
        auto& vg = frame.channel("variance.G");
        auto& vb = frame.channel("variance.B");
        const double scale = 1.0 / (static_cast<double>(reached) * (reached - 1)); // of the mean
        for_pixels(numbers_, frame.width, frame.height, [&](std::uint32_t i, std::size_t at) {
            const shared::float4& d = finished.deviation[i];
            vr[at] = static_cast<float>(d.x * scale), vg[at] = static_cast<float>(d.y * scale), vb[at] = static_cast<float>(d.z * scale);
        });
    }
    frame.attributes["clvr.spp"] = std::to_string(reached);
}

std::vector<Dealer::Portion> Renderer::march_portions() const {
    std::vector<Dealer::Portion> portions(workers_.size());
    for (const std::size_t k : dealer_.left()) {
        const std::uint32_t most = Marcher::pixels_per_launch(workers_[k]->device);
        portions[k] = {most / 16, most};
    }
    return portions;
}

/// The key lights of this view, and at the first view the sky's light in the volume.
void Renderer::light_features() {
    if (!sky_) sky_ = split_sky(params_, environment_);
    const std::vector<shared::KeyLight> keys = key_lights(params_, *sky_);
    dealer_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        w.keys.emplace(w.device, keys);
        for (std::size_t other = 0; other < k && !w.sky; ++other)
            if (workers_[other] && workers_[other]->volume == w.volume) w.sky = workers_[other]->sky;
        if (!w.sky) w.sky = std::make_shared<SkyLight>(w.device, *w.volume, *sky_);
    });
}

void Renderer::march(Frame& frame, bool features, const RenderControl& control) {
    static const std::vector<std::string> feature_names{
        "albedo.R",        "albedo.G",   "albedo.B",    "normal.X",    "normal.Y",    "normal.Z",    "depth.Z",     "opacity.A",
        "depth.deviation", "depth.half", "light.key.R", "light.key.G", "light.key.B", "light.sky.R", "light.sky.G", "light.sky.B"};
    static const std::vector<std::string> color_names{"R", "G", "B", "A"};
    const March kind = features ? March::features : scene_.mode == Mode::dvr ? March::dvr : March::mip;
    const bool lit = features && control.light;
    auto names = features ? feature_names : color_names;
    names.resize(march_planes(kind, lit));
    const std::atomic<bool>& cancelled = control.cancelled ? *control.cancelled : never;

    std::vector<float> planes(names.size() * numbers_);
    if (lit) light_features();
    dealer_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        if (lit)
            w.marcher.emplace(w.device, *w.volume, *w.light, *w.keys, *w.sky, scene_.feature_samples);
        else
            w.marcher.emplace(w.device, *w.volume, *w.light, kind, scene_.feature_samples);
    });
    dealer_.deal(features ? "features" : "march", numbers_, 1, march_portions(),
                 [&](std::size_t k, std::uint32_t first, std::uint32_t count) {
                     if (cancelled) return;
                     workers_[k]->marcher->run(first, count, planes, numbers_, first);
                     const std::lock_guard lock(progress_);
                     if (control.progress) control.progress({0, 0});
                 });
    for (auto& w : workers_)
        if (w) w->marcher.reset();
    if (cancelled) throw Error(ErrorKind::interrupted, "interrupted before the features were done; nothing was saved");
    for (std::size_t p = 0; p < names.size(); ++p) {
        auto& channel = frame.channel(names[p]);
        const float* plane = &planes[p * numbers_];
        for_pixels(numbers_, frame.width, frame.height, [&](std::uint32_t i, std::size_t at) { channel[at] = plane[i]; });
    }
    if (!features) frame.attributes["clvr.spp"] = std::to_string(scene_.feature_samples);
}

/// Composites the picture over the background: C + (1 - A) B; A stays, and B in the channels background.R/G/B.
void Renderer::lay_background(Frame& frame) {
    if (scene_.background.kind == Background::Kind::transparent) return;
    std::vector<shared::float4> under(numbers_);
    if (scene_.background.kind == Background::Kind::color) {
        const auto& c = scene_.background.color;
        std::fill(under.begin(), under.end(),
                  shared::float4{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), 0});
    } else {
        dealer_.deal("background", numbers_, 1, march_portions(), [&](std::size_t k, std::uint32_t first, std::uint32_t count) {
            Worker& w = *workers_[k];
            Kernel kernel = w.device.kernel("render/background", {{"CLVR_WIDTH", "1"}});
            Buffer out = w.device.buffer(count * sizeof(shared::float4), "background");
            w.device.launch(kernel, {count}, kernel.group(64), {}, w.light->arguments(), first, count, out);
            w.device.read(out, &under[first], count * sizeof(shared::float4));
        });
    }
    std::array<std::vector<float>*, 3> color{&frame.channel("R"), &frame.channel("G"), &frame.channel("B")};
    std::array<std::vector<float>*, 3> below{&frame.channel("background.R"), &frame.channel("background.G"),
                                             &frame.channel("background.B")};
    const auto& alpha = frame.at("A");
    for_pixels(numbers_, frame.width, frame.height, [&](std::uint32_t i, std::size_t at) {
        const float b[3] = {under[i].x, under[i].y, under[i].z};
        for (int k = 0; k < 3; ++k) {
            (*below[k])[at] = b[k];
            (*color[k])[at] += (1 - alpha[at]) * b[k];
        }
    });
}

} // namespace clvr

#include "host/render/session.hpp"
#include "host/render/params.hpp"
#include "host/render/pixel_numbers.hpp"
#include "host/render/tunables.hpp"
#include "runtime/system/host_memory.hpp"
#include "runtime/system/size.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace clvr {

namespace {

constexpr double framing_opacity = 0.02; // what is fainter does not count for the camera's framing
const std::atomic<bool> never{false};

std::vector<Double3> outline_of(const Classified& c, const Scene& scene) {
    std::vector<float> clear = c.majorants;
    for (float& m : clear)
        if (m <= framing_opacity) m = 0;
    return visible_outline(c.voxels->geometry, *c.grid, clear, visible_box(*c.voxels, *c.grid, c.table, framing_opacity),
                           clip_box_index(scene, *c.voxels));
}

/// Throws Error{host_memory} when the picture's own buffers would not fit into what the host has left: the kernel would end the process
/// instead.
void refuse_what_host_memory_cannot_hold(int width, int height) {
    const double wanted =
        static_cast<double>(width) * height * (64 + 4 * 4 + 3 * 4 + 2 * 4 * march_planes(March::features)); // sums twice, channels, planes
    const std::size_t left = available_memory();
    if (wanted > static_cast<double>(left))
        throw Error(ErrorKind::host_memory,
                    "a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels takes " +
                        size_text(static_cast<std::size_t>(wanted)) + " of host memory, " + size_text(left) +
                        " are left; try a smaller one",
                    "--size");
}

const std::vector<std::string> beauty_channels{"R", "G", "B", "A", "variance.R", "variance.G", "variance.B"};

/// Channels of a march in the order of its planes.
std::vector<std::string> march_channels(March march, bool lit) {
    static const std::vector<std::string> features{
        "albedo.R",        "albedo.G",   "albedo.B",    "normal.X",    "normal.Y",    "normal.Z",    "depth.Z",     "opacity.A",
        "depth.deviation", "depth.half", "light.key.R", "light.key.G", "light.key.B", "light.sky.R", "light.sky.G", "light.sky.B"};
    const std::vector<std::string>& all = march == March::features ? features : beauty_channels;
    return {all.begin(), all.begin() + march_planes(march, lit)};
}

/// 1 / (n (n - 1)), which makes the variance of the mean of a sum of squared deviations, as the sum of two floats; 0 below two samples.
std::array<float, 2> variance_scale(int samples) {
    if (samples < 2) return {0, 0};
    const double scale = 1.0 / (static_cast<double>(samples) * (samples - 1));
    const auto high = static_cast<float>(scale);
    return {high, static_cast<float>(scale - high)};
}

} // namespace

/// A marcher, and what it was made for.
struct RenderSession::Marching {
    March kind;
    int rays;
    bool lit;
    Marcher marcher;
};

/// One device's share of the work.
struct RenderSession::Worker {
    Device device;
    std::shared_ptr<DeviceVolume> volume; // sub-devices of one context share it
    std::optional<DeviceLights> lights;
    std::optional<KeyLights> keys;       // of the view
    std::shared_ptr<const SkyLight> sky; // of all views; shared as the volume is
    std::optional<PathTracer> tracer;
    std::optional<Marching> marching;       // kept for the next view
    std::optional<PixelSums> before, after; // of a chunk, while the picture is kept on the host
    bool compared = false;                  // with the others

    /// Before what they refer to goes.
    void forget_passes() { tracer.reset(), marching.reset(); }
};

/// The picture on the host.
struct RenderSession::HostSums {
    struct Sums {
        std::vector<shared::float4> mean, deviation;
    };
    Sums sums, next; // of whole passes, and of the pass that runs
    Frame channels;
};

RenderSession::RenderSession(const std::vector<Device>& devices) : scheduler_(devices) {
    for (const Device& d : devices) workers_.push_back(std::make_unique<Worker>(Worker{d, {}, {}, {}, {}, {}, {}, {}, {}, false}));
}

RenderSession::RenderSession(const std::vector<Device>& devices, const PreparedVolume& volume, const Scene& scene,
                             const EnvironmentTables& environment, bool steady)
    : RenderSession(devices) {
    set_scene(volume, scene, environment, steady);
}

RenderSession::~RenderSession() = default;

void RenderSession::set_volume(const PreparedVolume& volume) {
    volume_ = &volume;
    restart();
    for (const std::size_t k : scheduler_.left()) workers_[k]->forget_passes(), workers_[k]->sky.reset(), workers_[k]->volume.reset();
    if (classified_.voxels) set_appearance(Appearance(scene_)); // another volume under the same one
}

void RenderSession::set_appearance(const Appearance& appearance) {
    static_cast<Appearance&>(scene_) = appearance;
    restart();
    view_set_ = false;
    classified_ = classify(*volume_, scene_.transfer);
    warnings_.clear();
    if (std::none_of(classified_.majorants.begin(), classified_.majorants.end(), [](float m) { return m > 0; }))
        warnings_.push_back("nothing is visible: the transfer function gives every voxel the opacity 0; try another --tf, or `clvr info` "
                            "for the range of the values");
    outline_ = outline_of(classified_, scene_);
    for (const std::size_t k : scheduler_.left()) workers_[k]->marching.reset(), workers_[k]->sky.reset();
    std::vector<std::size_t> done; // of the devices, in this call
    scheduler_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        const auto params = [&](const BrickLayout& layout) {
            return volume_params(scene_, volume_->voxels, volume_->grid, classified_.table, layout);
        };
        const auto same = std::find_if(done.begin(), done.end(),
                                       [&](std::size_t other) { return workers_[other]->device.context()() == w.device.context()(); });
        if (same != done.end()) {
            if (w.volume != workers_[*same]->volume) w.tracer.reset();
            w.volume = workers_[*same]->volume;
        } else if (!w.volume || !w.volume->set_appearance(w.device, classified_, params(w.volume->layout()))) {
            w.tracer.reset();
            w.volume.reset();
            const BrickLayout layout = device_layout(w.device, classified_);
            w.volume = std::make_shared<DeviceVolume>(w.device, classified_, layout, params(layout));
        }
        done.push_back(k);
    });
}

void RenderSession::set_lights(const Light& light, const EnvironmentTables& environment) {
    scene_.light = light;
    environment_ = environment;
    restart();
    view_set_ = false;
    sky_.reset();
    for (const std::size_t k : scheduler_.left()) workers_[k]->forget_passes(), workers_[k]->sky.reset(), workers_[k]->lights.reset();
}

void RenderSession::set_size(int width, int height) {
    refuse_what_host_memory_cannot_hold(width, height);
    scene_.width = width, scene_.height = height;
    restart();
    view_set_ = false;
    numbers_ = pixel_numbers(width, height);
    film_.reset(), host_.reset(), sums_.reset(), next_.reset(), display_.reset();
    for (const std::size_t k : scheduler_.left()) workers_[k]->tracer.reset();
}

void RenderSession::set_view(const Viewpoint& view, bool steady) {
    static_cast<Viewpoint&>(scene_) = view;
    steady_ = steady;
    restart();
    view_set_ = false;
}

void RenderSession::set_scene(const PreparedVolume& volume, const Scene& scene, const EnvironmentTables& environment, bool steady) {
    validate(scene);
    set_volume(volume);
    set_size(scene.width, scene.height);
    set_appearance(scene);
    set_lights(scene.light, environment);
    set_view(scene, steady);
}

void RenderSession::restart() {
    samples_ = resolved_ = rays_ = 0;
    if (film_) film_->denoised = false;
    traced_ = false;
    marched_.clear();
}

std::vector<Device> RenderSession::devices() const {
    std::vector<Device> devices;
    for (const std::size_t k : scheduler_.left()) devices.push_back(workers_[k]->device);
    return devices;
}

/// Brings camera and lights to every device.
void RenderSession::prepare_view() {
    if (view_set_) return;
    params_ = render_params(scene_, volume_->voxels, resolve_view(scene_, outline_, steady_), environment_);
    scheduler_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        if (w.lights)
            w.lights->set_view(w.device, params_);
        else
            w.lights.emplace(w.device, params_, environment_);
    });
    view_set_ = true, behind_set_ = false;
}

/// The key lights of this view, and after another volume, appearance or environment the sky's light in the volume.
void RenderSession::prepare_light(bool draft) {
    if (!sky_) sky_ = split_sky(params_, environment_);
    const std::vector<shared::KeyLight> keys = key_lights(params_, *sky_);
    scheduler_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        if (w.keys && w.keys->count() == static_cast<int>(keys.size())) {
            w.keys->set(w.device, keys);
        } else {
            w.marching.reset();
            w.keys.emplace(w.device, keys);
        }
        if (w.sky && w.sky->is_draft() && !draft) w.marching.reset(), w.sky.reset();
        for (const std::size_t other : scheduler_.left())
            if (other < k && !w.sky && workers_[other]->volume == w.volume) w.sky = workers_[other]->sky;
        if (!w.sky) w.sky = std::make_shared<SkyLight>(w.device, *w.volume, *sky_, draft);
    });
}

/// Where the picture is kept: decided once for a size.
void RenderSession::prepare_picture() {
    if (film_ || host_) return;
    // Beauty and variance, features, noisy input, known light, noise level, and some for other filters.
    constexpr std::size_t planes = 7 + 16 + 4 + 3 + 1 + 9;
    constexpr std::size_t bytes_per_pixel = 64 + 4 * planes; // the sums twice
    Device& first = workers_[scheduler_.left().front()]->device;
    const std::size_t plane_bytes = std::size_t{4} * scene_.width * scene_.height;
    if (scheduler_.left().size() == 1 && numbers_ * bytes_per_pixel <= first.free_bytes() / 2 &&
        planes * plane_bytes <= first.max_alloc_bytes()) {
        film_ = std::make_unique<Film>(first, scene_.width, scene_.height, planes);
        return;
    }
    host_ = std::make_unique<HostSums>();
    host_->channels.width = scene_.width, host_->channels.height = scene_.height;
}

/// Each device traces the same few pixels in the picture's middle: one that computes other bits than the others must not mix with them.
void RenderSession::compare_devices() {
    if (std::exchange(workers_[scheduler_.left().front()]->compared, true)) return;
    const std::uint32_t count = std::min(256u, numbers_), first = (numbers_ - count) / 2;
    scheduler_.compare("pictures", [&](std::size_t k) {
        Device& d = workers_[k]->device;
        const PixelSums zero(d, count);
        PixelSums sums(d, count);
        workers_[k]->tracer->trace(first, count, 0, 2, zero, sums, 0, never);
        std::string bytes;
        for (const Buffer* values : {&sums.mean, &sums.deviation}) {
            const std::vector<char> read = d.download<char>(*values, values->bytes());
            bytes.append(read.begin(), read.end());
        }
        return bytes;
    });
}

/// Adds samples to all pixels. False when cancelled: the sums stay as they were.
bool RenderSession::trace_pass(int samples, int wanted, const RenderControl& control) {
    const std::atomic<bool>& cancelled = control.cancelled ? *control.cancelled : never;
    std::vector<Scheduler::ChunkSize> chunk_sizes(workers_.size());
    for (const std::size_t k : scheduler_.left()) {
        const Worker& w = *workers_[k];
        const std::uint32_t wave = w.tracer->pixels_per_wave(static_cast<std::uint32_t>(samples)), least = std::max(16u, wave / 256 * 16);
        chunk_sizes[k] = {least,
                          std::max(least, static_cast<std::uint32_t>(w.device.tunable(tunables::tile_pixels, static_cast<int>(wave))))};
    }
    const auto before = static_cast<std::uint32_t>(samples_), added = static_cast<std::uint32_t>(samples);
    std::uint32_t done = 0;
    scheduler_.run("trace", numbers_, samples, chunk_sizes, [&](std::size_t k, std::uint32_t first, std::uint32_t count) {
        Worker& w = *workers_[k];
        if (film_) {
            if (!w.tracer->trace(first, count, before, added, *sums_, *next_, first, cancelled)) return;
        } else {
            const std::size_t bytes = count * sizeof(shared::float4);
            if (!w.before || w.before->mean.bytes() < bytes) w.before.emplace(w.device, count), w.after.emplace(w.device, count);
            // From `sums`, which no device changes: what one that fails leaves behind does not count.
            w.device.write(w.before->mean, &host_->sums.mean[first], bytes);
            w.device.write(w.before->deviation, &host_->sums.deviation[first], bytes);
            if (!w.tracer->trace(first, count, before, added, *w.before, *w.after, 0, cancelled)) return;
            w.device.read(w.after->mean, &host_->next.mean[first], bytes);
            w.device.read(w.after->deviation, &host_->next.deviation[first], bytes);
        }
        const std::lock_guard lock(progress_);
        done += count;
        if (control.progress) control.progress({(samples_ + samples * static_cast<double>(done) / numbers_) / wanted, samples_});
    });
    if (cancelled) return false;
    if (film_)
        std::swap(sums_, next_);
    else
        std::swap(host_->sums, host_->next);
    return true;
}

int RenderSession::accumulate(int samples, const RenderControl& control) {
    using clock = std::chrono::steady_clock;
    const auto begin = clock::now();
    prepare_view();
    prepare_picture();
    scheduler_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        if (!w.tracer) w.tracer.emplace(w.device, *w.volume, *w.lights, numbers_);
    });
    compare_devices();
    if (film_) film_->require(beauty_channels);
    if (!std::exchange(traced_, true)) samples_ = resolved_ = 0; // a march lay there
    if (samples_ == 0 && film_) {
        for (auto* s : {&sums_, &next_})
            if (!*s) s->emplace(film_->device(), numbers_);
        film_->device().fill(sums_->mean, 0);
        film_->device().fill(sums_->deviation, 0);
    } else if (samples_ == 0) {
        for (auto* s : {&host_->sums, &host_->next}) s->mean.assign(numbers_, {}), s->deviation.assign(numbers_, {});
    }

    const int had = samples_, wanted = samples_ + samples;
    double seconds_per_sample = 0;
    for (int pass = 1; samples_ < wanted; pass = std::min(pass * 2, 16)) {
        int now = std::min(pass, wanted - samples_);
        const auto start = clock::now();
        if (control.seconds > 0 && samples_ > had) {
            const double left = control.seconds - std::chrono::duration<double>(start - begin).count();
            now = std::min(now, static_cast<int>(std::max(0.0, left / seconds_per_sample)));
            if (now == 0) break;
        }
        if (!trace_pass(now, wanted, control)) break;
        samples_ += now;
        seconds_per_sample = std::chrono::duration<double>(clock::now() - start).count() / now;
        if (control.progress) control.progress({static_cast<double>(samples_) / wanted, samples_});
    }
    return samples_;
}

std::vector<Scheduler::ChunkSize> RenderSession::march_chunk_sizes() const {
    std::vector<Scheduler::ChunkSize> chunk_sizes(workers_.size());
    for (const std::size_t k : scheduler_.left()) {
        const std::uint32_t most = Marcher::pixels_per_launch(workers_[k]->device);
        chunk_sizes[k] = {most / 16, most};
    }
    return chunk_sizes;
}

bool RenderSession::march_features(int rays, const RenderControl& control) {
    const std::vector<std::string> wanted = march_channels(March::features, control.light);
    if (rays_ == rays && marched_.size() >= wanted.size() && (!draft_ || control.draft || !control.light)) {
        marched_.resize(wanted.size());
        return true;
    }
    return march(March::features, rays, control.light, control);
}

bool RenderSession::march_picture(Mode mode, int rays, const RenderControl& control) {
    return march(mode == Mode::dvr ? March::dvr : March::mip, rays, false, control);
}

bool RenderSession::march(March kind, int rays, bool lit, const RenderControl& control) {
    const std::atomic<bool>& cancelled = control.cancelled ? *control.cancelled : never;
    prepare_view();
    prepare_picture();
    if (lit) prepare_light(control.draft);
    const std::vector<std::string> names = march_channels(kind, lit);
    // The planes of all features lie together, whichever are wanted first.
    if (film_) film_->require(kind == March::features ? march_channels(kind, true) : beauty_channels);
    scheduler_.each([&](std::size_t k) {
        Worker& w = *workers_[k];
        if (w.marching && w.marching->kind == kind && w.marching->rays == rays && w.marching->lit == lit) return;
        w.marching.reset(); // its memory goes before the next one's is taken
        if (lit)
            w.marching.emplace(Marching{kind, rays, lit, Marcher(w.device, *w.volume, *w.lights, *w.keys, *w.sky, rays)});
        else
            w.marching.emplace(Marching{kind, rays, lit, Marcher(w.device, *w.volume, *w.lights, kind, rays)});
    });
    std::vector<float> planes(film_ ? 0 : names.size() * numbers_);
    scheduler_.run(kind == March::features ? "features" : "march", numbers_, 1, march_chunk_sizes(),
                   [&](std::size_t k, std::uint32_t first, std::uint32_t count) {
                       if (cancelled) return;
                       Marcher& marcher = workers_[k]->marching->marcher;
                       if (film_)
                           marcher.run(first, count, *film_, film_->find(names.front()));
                       else
                           marcher.run(first, count, planes, numbers_, first);
                       const std::lock_guard lock(progress_);
                       if (control.progress) control.progress({0, samples_});
                   });
    if (film_) film_->device().finish();          // so that a failure is known here
    for (const std::size_t k : scheduler_.left()) // kept for the next view where memory is not short
        if (workers_[k]->marching && workers_[k]->marching->marcher.bytes() > workers_[k]->device.free_bytes() / 8)
            workers_[k]->marching.reset();
    if (cancelled) return false;
    for (std::size_t p = 0; p < names.size() && !film_; ++p) {
        auto& channel = host_->channels.channel(names[p]);
        const float* plane = &planes[p * numbers_];
        for_pixels(scene_.width, scene_.height, [&](std::uint32_t i, std::size_t at) { channel[at] = plane[i]; });
    }
    if (kind == March::features)
        marched_ = names, rays_ = rays, draft_ = lit && workers_[scheduler_.left().front()]->sky->is_draft();
    else
        samples_ = resolved_ = rays, traced_ = false;
    return true;
}

/// Brings the planes R G B A and variance.* up to the sums.
void RenderSession::resolve() {
    if (resolved_ == samples_) return;
    const auto [scale, rest] = variance_scale(samples_);
    if (film_) {
        Device& d = film_->device();
        Kernel kernel = d.kernel("render/resolve");
        d.launch(kernel, {numbers_}, kernel.group(64), {60.0 * numbers_, 0}, sums_->mean, sums_->deviation, film_->width(), film_->height(),
                 scale, rest, film_->planes(), static_cast<cl_uint>(film_->find("R")));
    } else {
        std::array<std::vector<float>*, 7> to{};
        for (std::size_t c = 0; c < to.size(); ++c) to[c] = &host_->channels.channel(beauty_channels[c]);
        for_pixels(scene_.width, scene_.height, [&](std::uint32_t i, std::size_t at) {
            const shared::float4 &m = host_->sums.mean[i], &d = host_->sums.deviation[i];
            (*to[0])[at] = m.x, (*to[1])[at] = m.y, (*to[2])[at] = m.z, (*to[3])[at] = m.w;
            const auto variance = [scale = scale, rest = rest](float v) {
                return std::fma(v, scale, v * rest);
            }; // as kernels/render/resolve.cl
            (*to[4])[at] = variance(d.x), (*to[5])[at] = variance(d.y), (*to[6])[at] = variance(d.z);
        });
    }
    resolved_ = samples_;
    if (film_) film_->denoised = false;
}

Film* RenderSession::film() {
    if (!film_) return nullptr;
    if (film_->denoised) resolved_ = 0; // the samples' mean again
    resolve();
    film_->samples = samples_;
    return film_.get();
}

Frame RenderSession::frame(const Background& background, bool beauty_alone) {
    resolve();
    Frame frame;
    frame.width = scene_.width, frame.height = scene_.height;
    std::vector<std::string> names;
    if (!beauty_alone) names = marched_;
    const bool denoised = film_ && film_->denoised;
    if (samples_ > 0)
        names.insert(names.end(), beauty_channels.begin(), beauty_channels.begin() + (traced_ && samples_ > 1 && !beauty_alone ? 7 : 4));
    if (denoised && !beauty_alone) names.insert(names.end(), {"noisy.R", "noisy.G", "noisy.B", "noisy.A"});
    if (denoised) frame.attributes["clvr.denoised"] = "1";
    for (const std::string& name : names) frame.channels[name] = film_ ? film_->download(name) : host_->channels.at(name);
    if (samples_ > 0) frame.attributes["clvr.spp"] = std::to_string(samples_);
    if (samples_ > 0) lay_background(frame, background);
    return frame;
}

DisplayPixels RenderSession::picture(const Background& background, const Tonemap& tonemap, bool alpha) {
    if (samples_ == 0) throw Error(ErrorKind::internal, "there are no samples yet", "RenderSession::picture");
    if (!film_) return display_pixels(frame(background, true), tonemap, alpha);
    resolve();
    Device& device = film_->device();
    if (!display_) display_.emplace(device);
    Behind behind;
    if (background.kind == Background::Kind::color) {
        const auto& c = background.color;
        behind.opaque = true;
        behind.colour = {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), 0};
    } else if (background.kind == Background::Kind::environment) {
        const std::size_t bytes = numbers_ * sizeof(shared::float4);
        if (behind_.bytes() != bytes) behind_ = device.buffer(bytes, "background");
        if (!std::exchange(behind_set_, true)) see_environment(*workers_[scheduler_.left().front()], 0, numbers_, behind_);
        behind.picture = &behind_;
    }
    return display_->show(*film_, behind, tonemap, alpha);
}

/// The environment behind the pixels [count], float4 each.
void RenderSession::see_environment(Worker& w, std::uint32_t first, std::uint32_t count, Buffer& out) {
    Kernel kernel = w.device.kernel("render/background", {{"CLVR_WIDTH", "1"}});
    w.device.launch(kernel, {count}, kernel.group(64), {}, w.lights->arguments(), first, count, out);
}

void RenderSession::lay_background(Frame& frame, const Background& background) {
    if (background.kind == Background::Kind::transparent) return;
    std::vector<shared::float4> under(numbers_);
    if (background.kind == Background::Kind::color) {
        const auto& c = background.color;
        std::fill(under.begin(), under.end(),
                  shared::float4{static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), 0});
    } else {
        scheduler_.run("background", numbers_, 1, march_chunk_sizes(), [&](std::size_t k, std::uint32_t first, std::uint32_t count) {
            Worker& w = *workers_[k];
            Buffer out = w.device.buffer(count * sizeof(shared::float4), "background");
            see_environment(w, first, count, out);
            w.device.read(out, &under[first], count * sizeof(shared::float4));
        });
    }
    std::array<std::vector<float>*, 3> below{&frame.channel("background.R"), &frame.channel("background.G"),
                                             &frame.channel("background.B")};
    for_pixels(frame.width, frame.height, [&](std::uint32_t i, std::size_t at) {
        (*below[0])[at] = under[i].x, (*below[1])[at] = under[i].y, (*below[2])[at] = under[i].z;
    });
    for (const std::string picture : {"", "noisy."}) {
        if (!frame.has(picture + "A")) continue;
        const std::vector<float>& alpha = frame.at(picture + "A");
        for (std::size_t k = 0; k < 3; ++k) {
            std::vector<float>& color = frame.channel(picture + "RGB"[k]);
            for (std::size_t i = 0; i < color.size(); ++i) color[i] += (1 - alpha[i]) * (*below[k])[i];
        }
    }
}

void take(RenderSession& session, const Scene& scene, const RenderControl& control) {
    session.restart();
    if (scene.features && !session.march_features(scene.feature_samples, control))
        throw Error(ErrorKind::interrupted, "interrupted before the features were done; nothing was saved");
    if (scene.mode != Mode::path) {
        if (!session.march_picture(scene.mode, scene.feature_samples, control))
            throw Error(ErrorKind::interrupted, "interrupted before the picture was done; nothing was saved");
    } else if (session.accumulate(scene.spp, control) == 0) {
        throw Error(ErrorKind::interrupted, "interrupted before the first sample of every pixel was done; nothing was saved");
    }
}

Frame render(RenderSession& session, const Scene& scene, const RenderControl& control) {
    take(session, scene, control);
    return session.frame(scene.background);
}

Frame render(const std::vector<Device>& devices, const PreparedVolume& volume, const Scene& scene, const EnvironmentTables& environment,
             const RenderControl& control) {
    RenderSession session(devices, volume, scene, environment);
    return render(session, scene, control);
}

} // namespace clvr

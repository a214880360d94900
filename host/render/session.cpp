#include "host/render/framing.hpp"
#include "host/render/params.hpp"
#include "host/render/pixel_numbers.hpp"
#include "host/render/session_parts.hpp"
#include "host/render/tunables.hpp"
#include "runtime/system/host_memory.hpp"
#include "runtime/system/size.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace clvr {

namespace {

const std::atomic<bool> never{false};

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

/// Channels of a march in the order of its planes.
std::vector<std::string> march_channels(March march, bool lit) {
    static const std::vector<std::string> features{
        "albedo.R",        "albedo.G",   "albedo.B",    "normal.X",    "normal.Y",    "normal.Z",    "depth.Z",     "opacity.A",
        "depth.deviation", "depth.half", "light.key.R", "light.key.G", "light.key.B", "light.sky.R", "light.sky.G", "light.sky.B"};
    const std::vector<std::string>& all = march == March::features ? features : beauty_channels;
    return {all.begin(), all.begin() + march_planes(march, lit)};
}

} // namespace

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
    outline_ = framing_outline(classified_, scene_);
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
    drop_filtered();
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
    // Beauty and variance, features, noisy input, known light, and some for other filters.
    constexpr std::size_t planes = 7 + 16 + 4 + 3 + 10;
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
                       if (film_ && control.cancelled) film_->device().finish(); // or all chunks would be on their way at once
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

void take(RenderSession& session, const Scene& scene, const RenderControl& control) {
    if (!control.go_on) session.restart();
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

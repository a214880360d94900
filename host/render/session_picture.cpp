// A RenderSession's picture on its way out: from sums to planes, to the host, over a background, to 8 bits.
#include "host/render/pixel_numbers.hpp"
#include "host/render/session_parts.hpp"
#include "host/render/two_floats.hpp"
#include "host/render/view.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

namespace clvr {

namespace {

/// 1 / (n (n - 1)), which makes the variance of the mean of a sum of squared deviations, as the sum of two floats; 0 below two samples.
std::array<float, 2> variance_scale(int samples) {
    if (samples < 2) return {0, 0};
    return two_floats(1.0 / (static_cast<double>(samples) * (samples - 1)));
}

shared::float4 colour_of(const Background& background) {
    const auto& c = background.color;
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2]), 0};
}

} // namespace

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
    drop_filtered();
}

/// The picture is the samples' mean again.
void RenderSession::drop_filtered() {
    if (film_) film_->denoised = false;
    if (host_) host_->filtered.reset();
}

void RenderSession::set_filtered(Frame filtered) {
    if (!host_) throw Error(ErrorKind::internal, "the picture lies on a device", "RenderSession::set_filtered");
    host_->filtered = std::move(filtered);
}

Film* RenderSession::film() {
    if (host_) host_->filtered.reset();
    if (!film_) return nullptr;
    if (film_->denoised) resolved_ = 0;
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
    if (host_ && host_->filtered) {
        frame = *host_->filtered;
        if (beauty_alone)
            for (auto at = frame.channels.begin(); at != frame.channels.end();)
                at = std::find(names.begin(), names.end(), at->first) == names.end() ? frame.channels.erase(at) : std::next(at);
    } else {
        for (const std::string& name : names) frame.channels[name] = film_ ? film_->download(name) : host_->channels.at(name);
    }
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
        behind.opaque = true;
        behind.colour = colour_of(background);
    } else if (background.kind == Background::Kind::environment) {
        const std::size_t bytes = numbers_ * sizeof(shared::float4);
        if (behind_.bytes() != bytes) behind_ = device.buffer(bytes, "background");
        if (!std::exchange(behind_set_, true)) see_environment(*workers_[scheduler_.left().front()], 0, numbers_, behind_);
        behind.picture = &behind_;
    }
    return display_->show(*film_, behind, tonemap, alpha);
}

std::optional<Double3> RenderSession::position_at(double x, double y) {
    if (marched_.empty()) return std::nullopt;
    const int width = scene_.width, height = scene_.height;
    const auto pixel = [](double share, int side) { return std::clamp(static_cast<int>(share * side), 0, side - 1); };
    const int column = pixel(x, width), row = pixel(y, height);
    const std::size_t at = static_cast<std::size_t>(row) * width + column;
    const auto value = [&](const std::string& channel) {
        if (!film_) return host_->channels.at(channel)[at];
        return film_->device().download<float>(film_->planes(), 1, film_->find(channel) * film_->pixels() + at).front();
    };
    if (value("opacity.A") < 1.0f / 256) return std::nullopt;
    const float half = value("depth.half"), depth = half < 1 ? half : value("depth.Z");
    const double t = params_.depth_near + depth / params_.depth_scale;
    const View view = resolve_view(scene_, outline_, steady_);
    const Double3 aside = view.right * (2 * (column + 0.5) / width - 1) + view.up * (1 - 2 * (row + 0.5) / height);
    return view.orthographic ? view.eye + aside + view.forward * t : view.eye + unit(view.forward + aside) * t;
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
        std::fill(under.begin(), under.end(), colour_of(background));
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

} // namespace clvr

#include "host/denoise/channels.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>

namespace clvr {

namespace {

bool is_radiance(const std::string& name) { return name == "R" || name == "G" || name == "B"; }
/// 0, 1, 2 for known.R, known.G, known.B; else -1.
int known_colour(const std::string& name) { return name == "known.R" ? 0 : name == "known.G" ? 1 : name == "known.B" ? 2 : -1; }
const std::string noise_channel = "noise"; // (samples per pixel)^(-1/2), from the frame's attribute

} // namespace

double samples_of(const Frame& frame) {
    const auto spp = frame.attributes.find("clvr.spp");
    return spp == frame.attributes.end() ? 1 : std::clamp(std::atof(spp->second.c_str()), 1.0, 1e9);
}

ChannelPlan::ChannelPlan(const Model& model, bool with_target)
    : exposure_(model.exposure), weighted_(model.opacity_weight), known_(model.control_variate), known_cell_(model.control_variate_cell),
      albedo_floor_(model.albedo_floor) {
    const auto has = [&](const char* name) {
        return std::find(model.channels.begin(), model.channels.end(), name) != model.channels.end();
    };
    demodulate_ = model.demodulation && has("albedo.R") && has("albedo.G") && has("albedo.B");
    planes_ = {"R", "G", "B"};
    if (demodulate_) planes_.insert(planes_.end(), {"albedo.R", "albedo.G", "albedo.B"});
    const auto add = [&](const std::string& name) {
        if (plane(name) < 0) planes_.push_back(name);
    };
    if (weighted_) add("opacity.A"); // free of noise, which A of few paths is not
    if (known_) planes_.insert(planes_.end(), {"known.R", "known.G", "known.B"});
    for (const auto& name : model.channels) {
        if (name == noise_channel) {
            channels_.push_back({0, shared::CLVR_CHANNEL_NOISE});
            continue;
        }
        add(name);
        const auto kind = is_radiance(name) || known_colour(name) >= 0 ? shared::CLVR_CHANNEL_RADIANCE
                          : name.rfind("normal.", 0) == 0              ? shared::CLVR_CHANNEL_NORMAL
                                                                       : shared::CLVR_CHANNEL_PLAIN;
        channels_.push_back({plane(name), kind});
    }
    if (with_target) planes_.insert(planes_.end(), {"target.R", "target.G", "target.B"});
}

bool reads_light(const Model& model) {
    const ChannelPlan plan(model, false);
    return std::any_of(plan.planes().begin(), plan.planes().end(),
                       [](const std::string& name) { return known_colour(name) >= 0 || name.rfind("light.", 0) == 0; });
}

int ChannelPlan::plane(const std::string& name) const {
    const auto at = std::find(planes_.begin(), planes_.end(), name);
    return at == planes_.end() ? -1 : static_cast<int>(at - planes_.begin());
}

namespace {
/// Number of the plane of a film that the network reads as `name`: the result takes the place of R G B A.
int plane_in(const Film& film, const std::string& name) { return film.find(is_radiance(name) || name == "A" ? "noisy." + name : name); }
} // namespace

template <class Number>
shared::SourceParams ChannelPlan::params_by(double exposure, double samples, const Number& plane) const {
    constexpr float ceiling = 32; // kernels/denoise/README.md, "Switches"
    shared::SourceParams p{};
    p.beauty = plane("R");
    p.albedo = demodulate_ ? plane("albedo.R") : -1;
    p.opacity = weighted_ ? plane("opacity.A") : -1;
    p.target = plane("target.R");
    p.known = known_ ? plane("known.R") : -1;
    p.channels = static_cast<int>(channels_.size());
    p.exposure = exposure_ ? static_cast<float>(exposure) : 1.0f;
    p.ceiling = exposure_ ? ceiling : 0x1p126f;
    p.albedo_floor = albedo_floor_;
    p.noise = static_cast<float>(1 / std::sqrt(samples));
    return p;
}

shared::SourceParams ChannelPlan::params(const Frame& frame) const { return params(exposure_ ? exposure_of(frame) : 1, samples_of(frame)); }

shared::SourceParams ChannelPlan::params(double exposure, double samples) const {
    return params_by(exposure, samples, [this](const std::string& name) { return plane(name); });
}

shared::SourceParams ChannelPlan::params(double exposure, double samples, const Film& film) const {
    return params_by(exposure, samples, [&film](const std::string& name) { return plane_in(film, name); });
}

std::vector<std::array<std::int32_t, 2>> ChannelPlan::channels(const Film& film) const {
    std::vector<std::array<std::int32_t, 2>> there = channels_;
    for (auto& channel : there)
        if (channel[1] != shared::CLVR_CHANNEL_NOISE) channel[0] = plane_in(film, planes_[static_cast<std::size_t>(channel[0])]);
    return there;
}

std::vector<std::string> ChannelPlan::missing(const Frame& frame) const {
    std::vector<std::string> names;
    for (const auto& name : planes_) {
        if (name.rfind("target.", 0) == 0) continue;
        if (known_colour(name) >= 0) {
            for (const auto& read : known_light_channels())
                if (!frame.has(read) && std::find(names.begin(), names.end(), read) == names.end()) names.push_back(read);
            continue;
        }
        if (!frame.has(name) && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
    const bool reads_noise =
        std::any_of(channels_.begin(), channels_.end(), [](const auto& c) { return c[1] == shared::CLVR_CHANNEL_NOISE; });
    if (reads_noise && frame.attributes.count("clvr.spp") == 0) names.push_back(noise_channel);
    return names;
}

void ChannelPlan::check(const Frame& frame) const {
    std::vector<std::string> names = missing(frame);
    if (names.empty()) return;
    std::vector<std::string> has;
    for (const auto& [channel, values] : frame.channels) has.push_back(channel);
    const auto noise = std::find(names.begin(), names.end(), noise_channel);
    const bool samples = noise != names.end();
    if (samples) names.erase(noise);
    const char* const plural = names.size() == 1 ? "" : "s";
    throw Error(ErrorKind::input, fmt::format("lacks {}{}{} that the model reads; it has {}",
                                              names.empty() ? "" : fmt::format("channel{} {}", plural, fmt::join(names, " ")),
                                              samples && !names.empty() ? " and " : "",
                                              samples ? "the attribute clvr.spp (--spp gives it)" : "", fmt::join(has, " ")));
}

BeautyWithoutBackground::BeautyWithoutBackground(const Frame& frame, const std::string& colour) : beauty_(frame.at(colour).data()) {
    const std::vector<float>*background = frame.find("background." + colour), *alpha = frame.find("A");
    if (background && alpha) background_ = background->data(), alpha_ = alpha->data();
}

std::optional<KnownLight> ChannelPlan::known_light(const Frame& frame) const {
    if (!reads_known_light()) return std::nullopt;
    return KnownLight(frame, known_cell_);
}

std::size_t ChannelPlan::gather_plane(const std::string& name, const Frame& frame, const Region& region,
                                      const std::optional<KnownLight>& known, std::vector<float>& plane) const {
    std::size_t repaired = 0;
    const auto add = [&](const auto& value_of) {
        for (int y = region.y; y < region.y + region.height; ++y)
            for (int x = region.x; x < region.x + region.width; ++x) {
                float v = value_of(static_cast<std::size_t>(y) * frame.width + x);
                if (!std::isfinite(v)) v = 0, ++repaired;
                plane.push_back(v);
            }
    };
    if (const int c = known_colour(name); c >= 0)
        add([&known, c](std::size_t i) { return (*known)(c, i); });
    else if (is_radiance(name))
        add(BeautyWithoutBackground(frame, name));
    else
        add([values = frame.at(name).data()](std::size_t i) { return values[i]; });
    return repaired;
}

std::size_t ChannelPlan::gather(const Frame& frame, const Frame* target, const Region& region, const std::optional<KnownLight>& known,
                                std::vector<float>& planes) const {
    std::size_t repaired = 0;
    planes.reserve(planes.size() + planes_.size() * region.pixels());
    for (const auto& name : planes_) {
        const bool of_target = name.rfind("target.", 0) == 0;
        repaired += gather_plane(of_target ? name.substr(7) : name, of_target ? *target : frame, region, known, planes);
    }
    return repaired;
}

double exposure_of(const Frame& frame) {
    const std::vector<float>* const opacities = frame.opacity();
    const BeautyWithoutBackground red(frame, "R"), green(frame, "G"), blue(frame, "B");
    std::vector<ExposureBlock> blocks;
    for (int y0 = 0; y0 < frame.height; y0 += exposure_block)
        for (int x0 = 0; x0 < frame.width; x0 += exposure_block) {
            ExposureBlock block;
            for (int y = y0; y < std::min(y0 + exposure_block, frame.height); ++y)
                for (int x = x0; x < std::min(x0 + exposure_block, frame.width); ++x, ++block.pixels) {
                    const std::size_t i = static_cast<std::size_t>(y) * frame.width + x;
                    const double l = 0.2126 * red(i) + 0.7152 * green(i) + 0.0722 * blue(i);
                    if (std::isfinite(l)) block.luminance += std::max(l, 0.0);
                    const double a = opacities ? (*opacities)[i] : 1;
                    if (std::isfinite(a)) block.opacity += a;
                }
            blocks.push_back(block);
        }
    return exposure_of(blocks);
}

double exposure_of(const std::vector<ExposureBlock>& blocks) {
    double sum = 0;
    int counted = 0;
    for (const ExposureBlock& b : blocks)
        if (b.opacity > b.pixels / 64.0 && b.luminance > 0) sum += std::log2(b.luminance / b.pixels), ++counted;
    return counted == 0 ? 1 : 0.18 / std::exp2(sum / counted);
}

} // namespace clvr

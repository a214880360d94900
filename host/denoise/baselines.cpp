#include "host/denoise/baselines.hpp"
#include "host/denoise/channels.hpp"
#include "host/denoise/neural_grid.hpp"
#include "kernels/shared/filter_params.h"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clvr {

namespace {

constexpr const char* features[CLVR_FILTER_FEATURES] = {channel::opacity,   channel::albedo[0], channel::albedo[1], channel::albedo[2],
                                                        channel::normal[0], channel::normal[1], channel::normal[2], channel::depth};
constexpr float albedo_floor = 1.0f / 32, opacity_floor = 1.0f / 256;
constexpr int pad = 32, wavelet_levels = 5;

/// A frame on the device as FilterParams says.
class Filter {
public:
    Filter(const Device& device, const Frame& frame) : device_(device), frame_(frame) {
        for (const char* c : colour_channels)
            if (!frame.has(c)) throw Error(ErrorKind::input, fmt::format("lacks channel {}", c));
        width_ = NeuralGrid::pixel_width(device);
        shape_.width = frame.width, shape_.height = frame.height, shape_.pad = pad, shape_.step = 1;
        shape_.row = (frame.width + width_ - 1) / width_ * width_ + 2 * pad;
        shape_.plane = shape_.row * (frame.height + 2 * pad);
        opacity_ = frame.opacity();
        for (int c = 0; c < 3; ++c) albedo_[c] = frame.find(features[1 + c]);
        upload();
    }

    shared::FilterParams& shape() { return shape_; }

    /// Runs a stage with the present shape over all pixels; `buffers` follow the features.
    template <class... Buffers>
    void run(const char* stage, const Buffers&... buffers) {
        const Buffer params = device_.upload(std::vector<shared::FilterParams>{shape_}, "filter settings");
        Kernel kernel = device_.kernel(stage, {{"CLVR_WIDTH", std::to_string(width_)}});
        const Range items{static_cast<std::size_t>((shape_.width + width_ - 1) / width_), static_cast<std::size_t>(shape_.height)};
        device_.launch(kernel, items, kernel.group(width_ == 1 ? 64 : 4), {}, params, features_, buffers...);
        device_.finish(); // before the settings go
    }

    Buffer planes(int count) {
        Buffer b = device_.buffer(static_cast<std::size_t>(count) * shape_.plane * 4 + 64, "filtered planes");
        device_.fill(b, 0);
        return b;
    }

    Buffer colour;             ///< 3 planes and the variance
    bool has_variance = false; ///< whether plane 3 is filled

    /// The frame of a filtered colour.
    Frame result(const Buffer& filtered) {
        const std::vector<float> all = device_.download<float>(filtered, std::size_t{3} * shape_.plane);
        Frame f = frame_.blank();
        f.attributes = frame_.attributes, f.further = frame_.further;
        for (int c = 0; c < 3; ++c) {
            std::vector<float>& to = f.channel(colour_channels[c]);
            const std::vector<float>* const background = frame_.find(channel::background[static_cast<std::size_t>(c)]);
            for (std::size_t i = 0; i < to.size(); ++i) {
                to[i] = std::max(all[c * plane() + at(i)] * albedo(c, i) * opacity(i), 0.0f);
                if (background) to[i] += (1 - opacity(i)) * finite((*background)[i]);
            }
        }
        if (opacity_) f.channels["A"] = *opacity_;
        return f;
    }

private:
    Device device_;
    const Frame& frame_;
    shared::FilterParams shape_{};
    int width_ = 1;
    const std::vector<float>*opacity_ = nullptr, *albedo_[3] = {}; // of the frame, if it has them
    Buffer features_;

    std::size_t plane() const { return static_cast<std::size_t>(shape_.plane); }
    std::size_t at(std::size_t i) const {
        const std::size_t w = static_cast<std::size_t>(shape_.width);
        return (i / w + pad) * static_cast<std::size_t>(shape_.row) + pad + i % w;
    }
    float opacity(std::size_t i) const { return opacity_ ? finite((*opacity_)[i]) : 1; }
    float albedo(int c, std::size_t i) const { return albedo_[c] ? std::max(finite((*albedo_[c])[i]), albedo_floor) : 1; }

    void upload() {
        std::vector<float> planes(CLVR_FILTER_FEATURES * plane());
        for (std::size_t i = 0; i < frame_.pixels(); ++i) planes[at(i)] = opacity(i);
        for (int k = 1; k < CLVR_FILTER_FEATURES; ++k)
            if (const std::vector<float>* const values = frame_.find(features[k]))
                for (std::size_t i = 0; i < frame_.pixels(); ++i)
                    planes[static_cast<std::size_t>(k) * plane() + at(i)] = finite((*values)[i]);
        planes.resize(planes.size() + 16); // rows are read 16 pixels at once
        features_ = device_.upload(planes, "features");

        const float shares[] = {0.2126f, 0.7152f, 0.0722f};
        const std::vector<float>* variance[3];
        for (int c = 0; c < 3; ++c) variance[c] = frame_.find(channel::variance[static_cast<std::size_t>(c)]);
        has_variance = variance[0] && variance[1] && variance[2];
        planes.assign(4 * plane() + 16, 0);
        float* const luminance_variance = &planes[3 * plane()];
        for (int c = 0; c < 3; ++c) {
            const BeautyWithoutBackground beauty(frame_, colour_channels[c]);
            float* const to = &planes[static_cast<std::size_t>(c) * plane()];
            for (std::size_t i = 0; i < frame_.pixels(); ++i) {
                const float divisor = albedo(c, i) * std::max(opacity(i), opacity_floor), share = shares[c] / divisor;
                to[at(i)] = finite(beauty(i) / divisor);
                if (has_variance) luminance_variance[at(i)] += share * share * finite((*variance[c])[i]);
            }
        }
        colour = device_.upload(planes, "colour");
    }
};

float falloff(double sigma, const char* what) {
    if (!(sigma > 0 && std::isfinite(sigma)))
        throw Error(ErrorKind::usage, fmt::format("{} is {}; expected a positive number", what, sigma));
    return static_cast<float>(-0.5 / (sigma * sigma));
}

} // namespace

Frame denoise(const Device& device, const Frame& frame, const CrossBilateral& settings) {
    Filter filter(device, frame);
    filter.shape().spatial = falloff(settings.spatial, "the spatial sigma");
    filter.shape().feature = falloff(settings.feature, "the features' sigma");
    filter.shape().radius = std::clamp(static_cast<int>(std::lround(2 * settings.spatial)), 1, pad);
    const Buffer out = filter.planes(3);
    filter.run("denoise/cross_bilateral", filter.colour, out);
    return filter.result(out);
}

Frame denoise(const Device& device, const Frame& frame, const Wavelet& settings) {
    Filter filter(device, frame);
    if (!(settings.colour > 0 && std::isfinite(settings.colour)))
        throw Error(ErrorKind::usage, fmt::format("the colour's sigma is {}; expected a positive number", settings.colour));
    filter.shape().colour = static_cast<float>(1 / settings.colour);
    filter.shape().feature = falloff(settings.feature, "the features' sigma");
    filter.shape().radius = 2;
    if (!filter.has_variance) filter.run("denoise/spatial_variance", filter.colour);
    Buffer out = filter.planes(4);
    for (int level = 0; level < wavelet_levels; ++level) {
        filter.shape().step = 1 << level;
        filter.run("denoise/wavelet", filter.colour, out);
        std::swap(filter.colour, out);
    }
    return filter.result(filter.colour);
}

} // namespace clvr

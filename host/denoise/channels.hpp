// From a frame's named channels to the planes that the device reads.
#pragma once
#include "host/denoise/known_light.hpp"
#include "host/denoise/model.hpp"
#include "host/frame/film.hpp"
#include "host/frame/frame.hpp"
#include "kernels/shared/denoise_params.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// Which planes a model needs of a frame, and what becomes of them.
class ChannelPlan {
public:
    /// `with_target`: three planes more, for a target's R G B.
    ChannelPlan(const Model& model, bool with_target);

    /// Frame channels in the order of the planes; the target's are "target.R" ...
    const std::vector<std::string>& planes() const { return planes_; }
    /// (plane, ChannelKind) per channel of the network's input, as kernels/denoise/assemble.cl reads it.
    const std::vector<std::array<std::int32_t, 2>>& channels() const { return channels_; }
    /// The model's switches and plane numbers, with what it takes of the whole frame: exposure (exposure_of) and samples per pixel.
    shared::SourceParams params(double exposure, double samples) const;
    shared::SourceParams params(const Frame& frame) const;

    /// Whether planes() has known.R/G/B, which no frame has.
    bool reads_known_light() const { return plane("known.R") >= 0; }
    /// Both for the planes of a film that has all of planes(): as numbers there, noisy.R G B A in place of R G B A.
    std::vector<std::array<std::int32_t, 2>> channels(const Film& film) const;
    shared::SourceParams params(double exposure, double samples, const Film& film) const;

    /// Channels that the model reads and the frame lacks; "noise" where it does not say its samples per pixel.
    std::vector<std::string> missing(const Frame& frame) const;
    /// Throws Error{input} naming them, and what the frame has.
    void check(const Frame& frame) const;
    /// What gather() needs to know of the whole frame: nothing where the model reads no known light.
    std::optional<KnownLight> known_light(const Frame& frame) const;
    /// Appends the planes of a region, beauty without background, to `planes`; returns how many values were not finite and became 0.
    /// `target`: the frame of the target planes, or null. `known`: known_light(frame).
    std::size_t gather(const Frame& frame, const Frame* target, const Region& region, const std::optional<KnownLight>& known,
                       std::vector<float>& planes) const;

    /// One of planes() alone, not of the target, or another channel of the frame.
    std::size_t gather_plane(const std::string& name, const Frame& frame, const Region& region, const std::optional<KnownLight>& known,
                             std::vector<float>& plane) const;

private:
    std::vector<std::string> planes_;
    std::vector<std::array<std::int32_t, 2>> channels_;
    bool exposure_, demodulate_, weighted_, known_;
    int known_cell_;
    float albedo_floor_;

    int plane(const std::string& name) const; // its number; -1 where there is no such plane
    template <class Number>
    shared::SourceParams params_by(double exposure, double samples, const Number& plane) const;
};

/// Samples per pixel of a frame; 1 where it does not say.
double samples_of(const Frame& frame);

/// Whether a model reads the light.* channels of a frame.
bool reads_light(const Model& model);

/// The factor that brings radiance to a usual level (kernels/denoise/README.md, "Switches"): 0.18 / exp2(mean log2 luminance), the mean
/// over blocks of 16x16 pixels whose mean opacity is above 1/64 and whose luminance is above 0; 1 where there is none. Reads the whole
/// frame: R G B minus the background, opacity.A (else A).
double exposure_of(const Frame& frame);

/// Sums over a block of pixels.
struct ExposureBlock {
    double luminance = 0, opacity = 0;
    int pixels = 0;
};
/// Pixels a side of a block.
constexpr int exposure_block = 16;
/// exposure_of a picture of these blocks.
double exposure_of(const std::vector<ExposureBlock>& blocks);

/// A colour of a frame, minus the background seen through it, pixel by pixel. The frame must outlive it.
class BeautyWithoutBackground {
public:
    /// `colour`: R, G or B.
    BeautyWithoutBackground(const Frame& frame, const std::string& colour);
    float operator()(std::size_t pixel) const { return beauty_[pixel] - (background_ ? (1 - alpha_[pixel]) * background_[pixel] : 0); }

private:
    const float *beauty_, *background_ = nullptr, *alpha_ = nullptr; // no background: nothing is taken away
};

} // namespace clvr

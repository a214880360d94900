// The part of a frame's light that is known without noise: a control variate for what is filtered.
#pragma once
#include "host/frame/frame.hpp"

#include <array>
#include <string>
#include <vector>

namespace clvr {

/// The channels that KnownLight reads: light.key.*, light.sky.*, albedo.*, and opacity.A.
const std::vector<std::string>& known_light_channels();

/// a key + b sky + c albedo opacity for each colour: the shares a, b, c are those whose sum is closest to the frame's noisy radiance, by
/// weighted least squares over the pixels with opacity above 1/256. Light that was scattered more than once follows the direct light
/// closely enough for shares above 1 to hold part of it. The sums run over the pixels in order, in double: the same bits everywhere.
class KnownLight {
public:
    struct Shares {
        double key = 1, sky = 1, ambient = 0;
    };
    /// The frame (all of known_light_channels() and R G B) outlives it.
    explicit KnownLight(const Frame& frame);
    /// `colour`: 0 R, 1 G, 2 B. Finite.
    float operator()(int colour, std::size_t pixel) const;
    const Shares& shares(int colour) const { return shares_[static_cast<std::size_t>(colour)]; }

private:
    struct Colour {
        const float *key, *sky, *albedo;
    };
    std::array<Colour, 3> colours_;
    const float* opacity_;
    std::array<Shares, 3> shares_;
};

} // namespace clvr

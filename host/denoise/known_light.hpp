// The part of a frame's light that is known without noise: a control variate for what is filtered.
#pragma once
#include "host/frame/frame.hpp"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace clvr {

/// 0 for what is not finite.
inline float finite(float v) { return std::isfinite(v) ? v : 0; }

/// The channels that KnownLight reads: light.key.*, light.sky.*, albedo.*, and opacity.A.
const std::vector<std::string>& known_light_channels();

/// The known part of each colour: a key + b sky + c albedo opacity. The shares a, b, c bring it closest to the frame's noisy radiance, by
/// weighted least squares over the pixels with opacity above 1/256. Light that was scattered more than once follows the direct light so
/// closely that shares above 1 hold part of it. The sums run over the pixels in order, in double: the same bits everywhere.
///
/// `cell` > 0: the shares vary over the picture. Each square cell of so many pixels a side has its own. They are fitted to the cell and its
/// neighbours (weighted by a tent) and pulled towards the whole frame's shares, the more the noisier the cell is; between the centres of
/// cells they are bilinear. 0: the whole frame's shares everywhere.
class KnownLight {
public:
    struct Shares {
        double key = 1, sky = 1, ambient = 0;
    };
    /// The frame (all of known_light_channels() and R G B) outlives it.
    explicit KnownLight(const Frame& frame, int cell = 0);
    /// `colour`: 0 R, 1 G, 2 B. Finite.
    float operator()(int colour, std::size_t pixel) const;
    /// Those of the whole frame.
    const Shares& shares(int colour) const { return colours_[static_cast<std::size_t>(colour)].whole; }
    Shares shares_at(int colour, std::size_t pixel) const;

private:
    struct Colour {
        const float *key, *sky, *albedo;
        Shares whole;
        std::vector<Shares> cells; ///< [down_][across_]
    };
    void fit(Colour& colour, const Frame& frame, const std::string& name) const;

    std::array<Colour, 3> colours_;
    const float* opacity_;
    int width_, cell_, across_ = 0, down_ = 0;
};

} // namespace clvr

// The part of a frame's light that is known without noise: a control variate for what is filtered.
#pragma once
#include "host/frame/frame.hpp"
#include "kernels/shared/denoise_params.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace clvr {

/// 0 for what is not finite.
inline float finite(float v) { return std::isfinite(v) ? v : 0; }

/// The channels that KnownLight reads: light.key.*, light.sky.*, albedo.*, and opacity.A.
const std::vector<std::string>& known_light_channels();

/// What a linear combination takes of the light by keys, of the sky's, and of albedo times opacity.
struct LightShares {
    double key = 1, sky = 1, ambient = 0;
};

/// Weighted least squares of a value by three others, summed up over the pixels of a cell: the matrix's lower half by rows, the right
/// side, the values' squares, the count of pixels.
using LightFit = std::array<double, CLVR_FIT_SUMS>;

/// Shares of a whole picture, and of its cells.
struct FittedShares {
    LightShares whole;
    std::vector<LightShares> cells; ///< [down][across]; empty where they do not vary
};
/// From the sums of all cells of a picture, in rows of `across`. `varying`: each cell gets its own (KnownLight).
FittedShares fit_shares(std::vector<LightFit> cells, int across, bool varying);

/// The known part of each colour: a key + b sky + c albedo opacity. The shares a, b, c bring it closest to the frame's noisy radiance, by
/// weighted least squares over the pixels with opacity above 1/256. Light that was scattered more than once follows the direct light so
/// closely that shares above 1 hold part of it. The sums run over the pixels of a cell in order, then over the cells, in double: the same
/// bits everywhere. (PictureLight is the same on a device, with a cell's sums in float.)
///
/// `cell` > 0: the shares vary over the picture. Each square cell of so many pixels a side has its own. They are fitted to the cell and its
/// neighbours (weighted by a tent) and pulled towards the whole frame's shares, the more the noisier the cell is; between the centres of
/// cells they are bilinear. 0: the whole frame's shares everywhere.
class KnownLight {
public:
    using Shares = LightShares;
    /// The frame (all of known_light_channels() and R G B) outlives it.
    explicit KnownLight(const Frame& frame, int cell = 0);
    /// `colour`: 0 R, 1 G, 2 B. Finite.
    float operator()(int colour, std::size_t pixel) const;
    /// Those of the whole frame.
    const Shares& shares(int colour) const { return colours_[static_cast<std::size_t>(colour)].shares.whole; }
    Shares shares_at(int colour, std::size_t pixel) const;

private:
    struct Colour {
        const float *key, *sky, *albedo;
        FittedShares shares;
    };
    FittedShares fit(const Colour& colour, const Frame& frame, const std::string& name) const;

    std::array<Colour, 3> colours_;
    const float* opacity_;
    int width_, cell_, across_ = 1, down_ = 1;
};

} // namespace clvr

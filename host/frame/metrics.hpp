// How far two pictures are apart.
#pragma once
#include "host/frame/frame.hpp"

#include <vector>

namespace clvr {

/// Measures over whole frames. PSNR and SSIM act on clip(RGB, 0, 1)^(1/2.2), premultiplied over black; the rest as their comments say.
struct Metrics {
    double psnr = 0;        ///< [dB], infinite for equal pictures
    double ssim = 0;        ///< 11x11 Gaussian (sigma 1.5), range 1 (Wang et al. 2004), mean of R G B
    double ssim_opaque = 0; ///< over the windows whose centre's reference opacity is above 0.01; ssim without opacity
    double rmse = 0;        ///< linear RGB
    double smape = 0;       ///< mean |a-b| / (|a|+|b|+0.01), linear
    double relmse = 0;      ///< mean (a-b)^2 / (b^2+0.01), linear
    double flip = 0;        ///< mean LDR-FLIP (Andersson et al. 2020) of the tone-mapped sRGB pictures at 67 pixels per degree
};

/// Throws Error{input} when the sizes differ or a colour channel is missing. `tonemapped`: both already hold display values 0..1.
Metrics compare_frames(const Frame& image, const Frame& reference, bool tonemapped = false);
/// PSNR alone: cheap, for validation while training.
double psnr(const Frame& image, const Frame& reference);

} // namespace clvr

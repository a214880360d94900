// How far two pictures are apart.
#pragma once
#include "host/frame/frame.hpp"

#include <array>
#include <utility>

namespace clvr {

/// Measures over whole frames. PSNR and SSIM act on clip(RGB, 0, 1)^(1/2.2), premultiplied over black.
struct Metrics {
    double psnr = 0;        ///< [dB], infinite for equal pictures
    double ssim = 0;        ///< 11x11 Gaussian (sigma 1.5), range 1 (Wang et al. 2004), mean of R G B over the windows inside the picture
    double ssim_opaque = 0; ///< over the windows whose centre's reference opacity is above 0.01; equals ssim without an opacity
    double rmse = 0;        ///< linear RGB
    double smape = 0;       ///< mean |a-b| / (|a|+|b|+0.01), linear
    double relmse = 0;      ///< mean (a-b)^2 / (b^2+0.01), linear
    double flip = 0;        ///< mean LDR-FLIP (flip.hpp) of clip(RGB, 0, 1)
};

/// All of them with their names, in the order of the struct.
std::array<std::pair<const char*, double>, 7> named(const Metrics& metrics);

/// Throws Error{input} when the sizes differ, a colour channel is missing or a value is not finite.
Metrics compare_frames(const Frame& image, const Frame& reference);
/// PSNR alone.
double psnr(const Frame& image, const Frame& reference);

} // namespace clvr

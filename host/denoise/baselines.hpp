// The classical denoisers that the network is measured against.
#pragma once
#include "host/frame/frame.hpp"
#include "runtime/opencl/device.hpp"

namespace clvr {

/// Cross-bilateral filter (Eisemann, Durand 2004; Petschnigg et al. 2004) over the noise-free features.
struct CrossBilateral {
    double spatial = 12;  ///< sigma [pixels]; the window reaches 2 sigma, at most 32 pixels
    double feature = 0.2; ///< sigma of the distance of albedo (0..1), normal (-1..1), depth (0..8)
};

/// Edge-avoiding a-trous wavelet (Dammertz et al. 2010) with variance-guided colour weights (Schied et al. 2017), 5 levels.
struct Wavelet {
    double colour = 8;    ///< sigma of luminance [standard deviations]
    double feature = 0.4; ///< as above
};

/// Denoises with what the network has, too: radiance over albedo (not below 1/32), pixels weighted by opacity, features albedo.*, normal.*,
/// depth.Z (those that the frame lacks do not count), variance.* (estimated from the neighbourhood when absent). The result has R G B
/// (linear, premultiplied, with the background added below again) and A = opacity.A. Throws Error{input} when R G B is missing,
/// Error{usage} for a sigma that is not positive, Error{device_memory}.
Frame denoise(const Device& device, const Frame& frame, const CrossBilateral& settings);
Frame denoise(const Device& device, const Frame& frame, const Wavelet& settings);

} // namespace clvr

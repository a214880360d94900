// The classical denoisers in double precision, pixel by pixel as their papers write them.
#pragma once
#include <array>
#include <vector>

namespace clvr::reference {

/// A pixel: demodulated radiance over opacity, how much it counts, its features (albedo, normal, 8 depth), the variance of its luminance.
struct FilterPixel {
    std::array<double, 3> colour{};
    double opacity = 1;
    std::array<double, 7> features{};
    double variance = 0;
};

struct FilterImage {
    int width = 0, height = 0;
    std::vector<FilterPixel> pixels;
};

/// Colours of the cross-bilateral filter over a window of +-radius.
FilterImage cross_bilateral(const FilterImage& image, double spatial_sigma, double feature_sigma, int radius);
/// Colours after `levels` of the a-trous wavelet; variances as they are given, or of a 7x7 neighbourhood where `estimate`.
FilterImage wavelet(const FilterImage& image, double colour_sigma, double feature_sigma, int levels, bool estimate);

} // namespace clvr::reference

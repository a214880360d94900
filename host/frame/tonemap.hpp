// From linear radiance to what a display shows.
#pragma once
#include "host/frame/frame.hpp"

#include <array>
#include <string>

namespace clvr {

constexpr std::array<const char*, 4> tonemap_names{"filmic", "aces", "reinhard", "none"};

/// How linear radiance becomes display light: exposure in stops, then a curve, one of tonemap_names.
struct Tonemap {
    std::string curve = "filmic";
    double exposure = 0;
};

using Rgb = std::array<double, 3>;

/// A Tonemap, ready for colours.
class ToneCurve {
public:
    /// Throws Error{usage} when there is no such curve.
    explicit ToneCurve(const Tonemap& tonemap);
    /// Display light of a straight (not premultiplied) colour; 0..1 for "filmic" and "reinhard", others may exceed 1. Negative and NaN
    /// count as 0.
    Rgb operator()(const Rgb& straight) const;

private:
    Rgb (*curve_)(const Rgb&);
    double gain_;
};

/// The frame's R G B A with R G B as display light, premultiplied again: the curve acts on the straight colour C / A.
Frame tonemapped(const Frame& frame, const Tonemap& tonemap);

/// The sRGB transfer function (IEC 61966-2-1) for 0..1; srgb_decode (frame/srgb.hpp) is its inverse.
double srgb_encoded(double linear);

} // namespace clvr

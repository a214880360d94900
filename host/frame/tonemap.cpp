#include "host/frame/tonemap.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clvr {

namespace {

/// The shape of the Khronos "PBR Neutral" curve behind a gain: colours up to `knee` are only scaled, so that albedos keep the look that the
/// transfer function gives them; above, the greatest component rolls off towards 1. Hue is kept; far highlights lose saturation on their
/// way to white. The gain makes up for light lost between scatterings; a white Lambert surface that faces the key (radiance 1) becomes 0.9.
Rgb filmic(const Rgb& c) {
    constexpr double gain = 1.3, knee = 0.7, desaturation = 0.15;
    const double peak = gain * std::max({c[0], c[1], c[2]});
    if (peak <= knee) return {gain * c[0], gain * c[1], gain * c[2]};
    const double rolled = 1 - (1 - knee) * (1 - knee) / (peak + 1 - 2 * knee);
    const double white = 1 - 1 / (desaturation * (peak - rolled) + 1);
    Rgb out;
    for (int i = 0; i < 3; ++i) out[i] = gain * c[i] * (rolled / peak) * (1 - white) + rolled * white;
    return out;
}

/// K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2015, with the exposure factor 0.6 that its author gives to match the ACES reference.
Rgb aces(const Rgb& c) {
    Rgb out;
    for (int i = 0; i < 3; ++i) {
        const double x = 0.6 * c[i];
        out[i] = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    }
    return out;
}

/// E. Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 3 on Rec. 709 luminance.
Rgb reinhard(const Rgb& c) {
    const double s = 1 / (1 + 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]);
    return {c[0] * s, c[1] * s, c[2] * s};
}

Rgb unchanged(const Rgb& c) { return c; }

/// NaN would be shown as black anyway; the EXR keeps what the frame holds.
double displayable(double x) { return x > 0 ? std::min(x, 1e30) : 0.0; }

} // namespace

ToneCurve::ToneCurve(const Tonemap& tonemap) : curve_(nullptr), gain_(std::exp2(tonemap.exposure)) {
    constexpr std::array<Rgb (*)(const Rgb&), std::tuple_size_v<decltype(tonemap_names)>> curves{filmic, aces, reinhard, unchanged};
    const auto found = std::find(tonemap_names.begin(), tonemap_names.end(), tonemap.curve);
    if (found == tonemap_names.end()) throw Error(ErrorKind::usage, fmt::format("there is no tone map '{}'", tonemap.curve), "--tonemap");
    curve_ = curves[static_cast<std::size_t>(found - tonemap_names.begin())];
}

Rgb ToneCurve::operator()(const Rgb& straight) const {
    return curve_({displayable(gain_ * straight[0]), displayable(gain_ * straight[1]), displayable(gain_ * straight[2])});
}

Frame tonemapped(const Frame& frame, const Tonemap& tonemap) {
    const ToneCurve curve(tonemap);
    Frame display = frame.blank();
    const std::vector<float>*r = &frame.at("R"), *g = &frame.at("G"), *b = &frame.at("B"), *a = frame.shown_alpha();
    if (a) display.channels["A"] = *a;
    std::vector<float>* to[3] = {&display.channel("R"), &display.channel("G"), &display.channel("B")};
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const double alpha = a ? std::min(displayable((*a)[i]), 1.0) : 1.0;
        if (alpha <= 0) continue;
        const Rgb c = curve({(*r)[i] / alpha, (*g)[i] / alpha, (*b)[i] / alpha});
        for (int k = 0; k < 3; ++k) (*to[k])[i] = static_cast<float>(alpha * c[k]);
    }
    return display;
}

double srgb_encoded(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

} // namespace clvr

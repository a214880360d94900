#include "host/frame/display_pixels.hpp"
#include "host/frame/srgb.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace clvr {

namespace {

unsigned char eight_bits(double x) { return static_cast<unsigned char>(std::lrint(255 * std::clamp(x, 0.0, 1.0))); }
unsigned char srgb_code(double linear) { return eight_bits(srgb_encoded(linear)); }

/// For each code the least value in 0..1 that `code_of`, which never falls, maps to it.
std::array<double, 256> least_of_codes(unsigned char (*code_of)(double)) {
    std::array<double, 256> least{};
    for (std::size_t code = 1; code < least.size(); ++code) {
        double below = 0, at = 1;
        for (double middle = 0.5; middle > below && middle < at; middle = below + (at - below) / 2)
            (code_of(middle) < code ? below : at) = middle;
        least[code] = at;
    }
    return least;
}

} // namespace

DisplayPixels display_pixels(const Frame& whole, const Tonemap& tonemap, bool with_alpha) {
    const ToneCurve curve(tonemap);
    for (const char* name : {"R", "G", "B"})
        if (!whole.has(name)) throw Error(ErrorKind::input, fmt::format("there is no picture to write: the frame has no channel {}", name));
    Frame cut;
    if (whole.shown() != whole.window()) {
        Frame colours = whole.blank();
        for (const char* name : {"R", "G", "B", "A", "background.R"})
            if (const auto* values = whole.find(name)) colours.channels[name] = *values;
        cut = shown_part(colours);
    }
    const Frame& frame = whole.shown() != whole.window() ? cut : whole;
    const std::vector<float>*rgb[3] = {&frame.at("R"), &frame.at("G"), &frame.at("B")}, *alpha = frame.shown_alpha();
    DisplayPixels pixels{frame.width, frame.height, 4, {}};
    pixels.values.reserve(4 * frame.pixels());
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const double a = !alpha ? 1.0 : (*alpha)[i] > 0 ? std::min(static_cast<double>((*alpha)[i]), 1.0) : 0.0;
        const unsigned char a8 = eight_bits(a);
        Rgb straight{0, 0, 0};
        if (a8 > 0)
            for (int c = 0; c < 3; ++c) straight[c] = (*rgb[c])[i] / a;
        const Rgb mapped = curve(straight);
        for (int c = 0; c < 3; ++c) pixels.values.push_back(srgb_code(with_alpha ? mapped[c] : a * mapped[c]));
        pixels.values.push_back(a8);
    }
    return without_needless_alpha(std::move(pixels), with_alpha);
}

DisplayPixels without_needless_alpha(DisplayPixels rgba, bool alpha) {
    const std::size_t count = rgba.values.size() / 4;
    bool clear = false;
    for (std::size_t i = 0; i < count && !clear; ++i) clear = rgba.values[4 * i + 3] != 255;
    if (alpha && clear) return rgba;
    for (std::size_t i = 0; i < count; ++i) std::copy_n(&rgba.values[4 * i], 3, &rgba.values[3 * i]);
    rgba.values.resize(3 * count);
    rgba.components = 3;
    return rgba;
}

const std::array<double, 256>& least_of_srgb_codes() {
    static const std::array<double, 256> least = least_of_codes(srgb_code);
    return least;
}
const std::array<double, 256>& least_of_alpha_codes() {
    static const std::array<double, 256> least = least_of_codes(eight_bits);
    return least;
}

Frame frame_of(const DisplayPixels& pixels) {
    Frame frame;
    frame.width = pixels.width, frame.height = pixels.height;
    std::array<float, 256> linear;
    for (std::size_t v = 0; v < linear.size(); ++v) linear[v] = static_cast<float>(srgb_decode(static_cast<double>(v) / 255));
    const char* const names[] = {"R", "G", "B", "A"};
    const std::size_t components = static_cast<std::size_t>(pixels.components);
    for (std::size_t c = 0; c < components; ++c) {
        std::vector<float>& plane = frame.channel(names[c]);
        for (std::size_t i = 0; i < plane.size(); ++i) {
            const unsigned char* const pixel = &pixels.values[components * i];
            const float a = components == 4 ? static_cast<float>(pixel[3]) / 255 : 1.0f;
            plane[i] = c == 3 ? a : linear[pixel[c]] * a;
        }
    }
    return frame;
}

} // namespace clvr

#include "host/io/picture/display_pixels.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace clvr {

namespace {

unsigned char eight_bits(double x) { return static_cast<unsigned char>(std::lrint(255 * std::clamp(x, 0.0, 1.0))); }

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
    const bool opaque = !alpha || std::all_of(alpha->begin(), alpha->end(), [](float a) { return a >= 1; });

    DisplayPixels pixels{frame.width, frame.height, with_alpha && !opaque ? 4 : 3, {}};
    pixels.values.reserve(static_cast<std::size_t>(pixels.components) * frame.pixels());
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const double a = opaque ? 1.0 : (*alpha)[i] > 0 ? std::min(static_cast<double>((*alpha)[i]), 1.0) : 0.0;
        const unsigned char a8 = eight_bits(a);
        Rgb straight{0, 0, 0};
        if (a8 > 0)
            for (int c = 0; c < 3; ++c) straight[c] = (*rgb[c])[i] / a;
        const Rgb mapped = curve(straight);
        for (int c = 0; c < 3; ++c) pixels.values.push_back(eight_bits(srgb_encoded(with_alpha ? mapped[c] : a * mapped[c])));
        if (pixels.components == 4) pixels.values.push_back(a8);
    }
    return pixels;
}

Frame frame_of(const DisplayPixels& pixels) {
    Frame frame;
    frame.width = pixels.width, frame.height = pixels.height;
    std::array<float, 256> linear;
    for (std::size_t v = 0; v < linear.size(); ++v) linear[v] = static_cast<float>(srgb_decoded(static_cast<double>(v) / 255));
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

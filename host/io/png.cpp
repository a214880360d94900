#include "host/io/atomic_file.hpp"
#include "host/io/frame_file.hpp"
#include "host/render/scene.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <png.h>

namespace clvr {

namespace {

using Rgb = std::array<double, 3>;

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

Rgb clipped(const Rgb& c) { return c; }

using Curve = Rgb (*)(const Rgb&);
Curve curve_named(const std::string& name) {
    constexpr std::array<Curve, std::tuple_size_v<decltype(tonemap_names)>> curves{filmic, aces, reinhard, clipped};
    const auto found = std::find(tonemap_names.begin(), tonemap_names.end(), name);
    if (found == tonemap_names.end()) throw Error(ErrorKind::usage, fmt::format("there is no tone map '{}'", name), "--tonemap");
    return curves[static_cast<std::size_t>(found - tonemap_names.begin())];
}

unsigned char eight_bits(double x) { return static_cast<unsigned char>(std::lrint(255 * std::clamp(x, 0.0, 1.0))); }
double srgb_encode(double x) { return x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055; }
/// A picture of NaN would be black anyway; what the frame holds stays in its EXR.
double displayable(float x) { return x > 0 ? std::min(static_cast<double>(x), 1e30) : 0.0; }

/// In lower case.
std::string ending_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

} // namespace

void write_png(const Frame& frame, const Tonemap& tonemap, const std::string& path) {
    const Curve curve = curve_named(tonemap.curve);
    const double gain = std::exp2(tonemap.exposure);
    for (const char* name : {"R", "G", "B"})
        if (!frame.has(name))
            throw Error(ErrorKind::input, fmt::format("there is no picture to write: the frame has no channel {}", name), path);
    const std::vector<float>*rgb[3] = {&frame.at("R"), &frame.at("G"), &frame.at("B")}, *alpha = frame.has("A") ? &frame.at("A") : nullptr;
    const bool opaque = !alpha || std::all_of(alpha->begin(), alpha->end(), [](float a) { return a >= 1; });
    const std::size_t components = opaque ? 3 : 4;

    std::vector<unsigned char> pixels;
    pixels.reserve(components * frame.pixels());
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const double a = opaque ? 1.0 : std::min(displayable((*alpha)[i]), 1.0);
        const unsigned char a8 = eight_bits(a);
        Rgb straight{0, 0, 0};
        if (a8 > 0)
            for (int c = 0; c < 3; ++c) straight[c] = gain * displayable((*rgb[c])[i]) / a;
        const Rgb mapped = curve(straight);
        for (int c = 0; c < 3; ++c) pixels.push_back(eight_bits(srgb_encode(mapped[c])));
        if (!opaque) pixels.push_back(a8);
    }

    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(frame.width);
    image.height = static_cast<png_uint_32>(frame.height);
    image.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
    std::vector<unsigned char> encoded(size);
    if (!png_image_write_to_memory(&image, encoded.data(), &size, 0, pixels.data(), 0, nullptr))
        throw Error(ErrorKind::internal, fmt::format("libpng cannot encode {} x {} pixels: {}", frame.width, frame.height, image.message),
                    path);
    write_atomically(path, encoded.data(), size);
}

bool is_exr_path(const std::string& path) { return ending_of(path) == ".exr"; }

void check_frame_path(const std::string& path) {
    const std::string ending = ending_of(path);
    if (ending != ".exr" && ending != ".png")
        throw Error(ErrorKind::input, fmt::format("has the ending '{}'; expected .exr (all channels) or .png (a picture)", ending), path);
    check_writable(path);
}

void write_frame(const Frame& frame, const Tonemap& tonemap, const std::string& path) {
    if (is_exr_path(path))
        write_exr(frame, path);
    else
        write_png(frame, tonemap, path);
}

} // namespace clvr

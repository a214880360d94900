#include "host/io/atomic_file.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <png.h>

namespace clvr {

namespace {

unsigned char eight_bits(double x) { return static_cast<unsigned char>(std::lrint(255 * std::clamp(x, 0.0, 1.0))); }

/// In lower case.
std::string ending_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return ending;
}

} // namespace

std::vector<unsigned char> encode_png(const Frame& frame, const Tonemap& tonemap) {
    const ToneCurve curve(tonemap);
    for (const char* name : {"R", "G", "B"})
        if (!frame.has(name)) throw Error(ErrorKind::input, fmt::format("there is no picture to write: the frame has no channel {}", name));
    const std::vector<float>*rgb[3] = {&frame.at("R"), &frame.at("G"), &frame.at("B")}, *alpha = frame.shown_alpha();
    const bool opaque = !alpha || std::all_of(alpha->begin(), alpha->end(), [](float a) { return a >= 1; });
    const std::size_t components = opaque ? 3 : 4;

    std::vector<unsigned char> pixels;
    pixels.reserve(components * frame.pixels());
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const double a = opaque ? 1.0 : (*alpha)[i] > 0 ? std::min(static_cast<double>((*alpha)[i]), 1.0) : 0.0;
        const unsigned char a8 = eight_bits(a);
        Rgb straight{0, 0, 0};
        if (a8 > 0)
            for (int c = 0; c < 3; ++c) straight[c] = (*rgb[c])[i] / a;
        const Rgb mapped = curve(straight);
        for (int c = 0; c < 3; ++c) pixels.push_back(eight_bits(srgb_encoded(mapped[c])));
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
        throw Error(ErrorKind::internal, fmt::format("libpng cannot encode {} x {} pixels: {}", frame.width, frame.height, image.message));
    encoded.resize(size);
    return encoded;
}

void write_png(const Frame& frame, const Tonemap& tonemap, const std::string& path) {
    std::vector<unsigned char> encoded;
    try {
        encoded = encode_png(frame, tonemap);
    } catch (const Error& e) {
        throw e.where().empty() ? Error(e.kind(), e.what(), path) : e;
    }
    write_atomically(path, encoded.data(), encoded.size());
}

Frame read_png(const std::string& path) {
    will_read(path);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    const std::unique_ptr<png_image, void (*)(png_image*)> guard(&image, png_image_free);
    if (!png_image_begin_read_from_file(&image, path.c_str()))
        throw Error(ErrorKind::input, fmt::format("is no PNG: {}", image.message), path);
    constexpr png_uint_32 most = 1 << 16;
    if (image.width > most || image.height > most || static_cast<std::uint64_t>(image.width) * image.height > (std::uint64_t{1} << 28))
        throw Error(ErrorKind::input, fmt::format("is {} x {} pixels; expected at most 2^28 in all", image.width, image.height), path);
    const bool alpha = (image.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    image.format = PNG_FORMAT_RGBA; // libpng's own conversion to linear light is as coarse as 8 bits
    std::vector<unsigned char> pixels(PNG_IMAGE_SIZE(image));
    if (!png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr))
        throw Error(ErrorKind::input, fmt::format("is a damaged PNG: {}", image.message), path);
    Frame frame;
    frame.width = static_cast<int>(image.width), frame.height = static_cast<int>(image.height);
    std::array<float, 256> linear;
    for (std::size_t v = 0; v < linear.size(); ++v) linear[v] = static_cast<float>(srgb_decoded(static_cast<double>(v) / 255));
    const char* const names[] = {"R", "G", "B", "A"};
    for (std::size_t c = 0; c < (alpha ? 4 : 3); ++c) {
        std::vector<float>& plane = frame.channel(names[c]);
        for (std::size_t i = 0; i < plane.size(); ++i) {
            const float a = static_cast<float>(pixels[4 * i + 3]) / 255;
            plane[i] = c == 3 ? a : linear[pixels[4 * i + c]] * a;
        }
    }
    return frame;
}

Frame read_picture(const std::string& path) { return ending_of(path) == ".png" ? read_png(path) : read_exr(path); }

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

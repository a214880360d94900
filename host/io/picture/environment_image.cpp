#include "host/io/atomic_file.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"

#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <string_view>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function" // stb_image defines its whole interface as static functions
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace clvr {

namespace {

constexpr std::size_t largest_bytes = std::size_t{1} << 30; // a 16384 x 8192 Radiance file without compression has half of this
constexpr int largest_image_side = 16384;

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorKind::input, what); }

/// Takes lines and bytes off the front of a Radiance file; refuses to go past its end.
struct Cursor {
    std::string_view left;
    std::string_view line() {
        const std::size_t end = left.find('\n');
        if (end == left.npos) refuse("is no complete Radiance image: its header has no end");
        const std::string_view taken = left.substr(0, end);
        left.remove_prefix(end + 1);
        return taken;
    }
    std::string_view take(std::size_t n) {
        if (left.size() < n) refuse(fmt::format("is no complete Radiance image: {} bytes or more are missing at its end", n - left.size()));
        const std::string_view taken = left.substr(0, n);
        left.remove_prefix(n);
        return taken;
    }
    unsigned byte() { return static_cast<unsigned char>(take(1)[0]); }
};

/// Walks the file from header to last run. stb_image 2.27 reads zeros past the end of a file and loops for ever on a run of length 0.
void check_radiance(const std::string& bytes) {
    Cursor at{bytes};
    if (const auto magic = at.line(); magic != "#?RADIANCE" && magic != "#?RGBE")
        refuse("is no Radiance image: its first line is not #?RADIANCE");
    bool rgbe = false;
    for (std::string_view line = at.line(); !line.empty(); line = at.line()) rgbe = rgbe || line == "FORMAT=32-bit_rle_rgbe";
    if (!rgbe) refuse("has another pixel format than 32-bit_rle_rgbe");
    int width = 0, height = 0, end = 0;
    const std::string resolution(at.line().substr(0, 64));
    if (std::sscanf(resolution.c_str(), "-Y %d +X %d%n", &height, &width, &end) != 2 || resolution[static_cast<std::size_t>(end)] != '\0')
        refuse(fmt::format("has the resolution line '{}'; expected '-Y height +X width'", resolution));
    if (width < 1 || height < 1 || width > largest_image_side || height > largest_image_side)
        refuse(fmt::format("has {} x {} pixels; expected 1 x 1 to {} x {}", width, height, largest_image_side, largest_image_side));
    const std::size_t row = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    const bool runs = width >= 8 && at.left.size() >= 3 && at.left[0] == 2 && at.left[1] == 2 && !(at.left[2] & 0x80);
    if (!runs) {
        at.take(4 * row * rows);
        return;
    }
    for (std::size_t y = 0; y < rows; ++y) {
        const std::string_view start = at.take(4);
        if (start[0] != 2 || start[1] != 2 ||
            static_cast<int>(static_cast<unsigned char>(start[2]) << 8 | static_cast<unsigned char>(start[3])) != width)
            refuse(fmt::format("is damaged: line {} does not start with its width", y));
        for (int component = 0; component < 4; ++component)
            for (std::size_t x = 0; x < row;) {
                const unsigned code = at.byte();
                const std::size_t length = code > 128 ? code - 128 : code;
                if (length == 0 || length > row - x)
                    refuse(fmt::format("is damaged: a run of {} pixels in line {} from pixel {}", length, y, x));
                at.take(code > 128 ? 1 : length);
                x += length;
            }
    }
}

RgbImage read_radiance(const std::string& bytes) {
    check_radiance(bytes);
    RgbImage image;
    int components = 0;
    const std::unique_ptr<float, void (*)(void*)> pixels(stbi_loadf_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()),
                                                                                static_cast<int>(bytes.size()), &image.width, &image.height,
                                                                                &components, 3),
                                                         stbi_image_free);
    if (!pixels) refuse(fmt::format("is no readable Radiance image: {}", stbi_failure_reason()));
    image.rgb.assign(pixels.get(), pixels.get() + 3 * static_cast<std::size_t>(image.width) * image.height);
    return image;
}

RgbImage from_frame(const Frame& frame) {
    RgbImage image{frame.width, frame.height, std::vector<float>(3 * frame.pixels())};
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
        const auto channel = frame.channels.find(names[c]);
        if (channel == frame.channels.end()) refuse(fmt::format("has no channel {}; an environment needs R, G and B", names[c]));
        for (std::size_t i = 0; i < frame.pixels(); ++i) image.rgb[3 * i + c] = channel->second[i];
    }
    return image;
}

void check_radiances(const RgbImage& image) {
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        if (!(image.rgb[i] >= 0) || !std::isfinite(image.rgb[i]))
            refuse(fmt::format("has the radiance {} at pixel ({}, {}); expected finite values of 0 or more, so repair the image",
                               image.rgb[i], i / 3 % image.width, i / 3 / image.width));
}

} // namespace

RgbImage read_environment_image(const std::string& path) {
    will_read(path);
    check_readable(path);
    try {
        const std::string bytes = read_text(path, largest_bytes);
        constexpr std::string_view exr_magic("\x76\x2f\x31\x01", 4);
        const bool exr = std::string_view(bytes).substr(0, 4) == exr_magic;
        if (!exr && bytes.rfind("#?", 0) != 0) refuse("is neither a Radiance .hdr nor an OpenEXR image");
        RgbImage image = exr ? from_frame(read_exr(path)) : read_radiance(bytes);
        check_radiances(image);
        return image;
    } catch (const Error& e) {
        throw Error(e.kind(), e.what(), path);
    }
}

} // namespace clvr

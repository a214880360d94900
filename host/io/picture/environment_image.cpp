#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace clvr {

namespace {

[[noreturn]] void refuse_environment(const std::string& what) { throw Error(ErrorKind::input, what); }

RgbImage from_frame(const Frame& frame) {
    RgbImage image{frame.width, frame.height, std::vector<float>(3 * frame.pixels()), frame.notes};
    const char* names[3] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float>* const channel = frame.find(names[c]);
        if (!channel) refuse_environment(fmt::format("has no channel {}; an environment needs R, G and B", names[c]));
        for (std::size_t i = 0; i < frame.pixels(); ++i) image.rgb[3 * i + c] = (*channel)[i];
    }
    return image;
}

/// The frame, or the part of it that is shown. Where light would come from a small part of the sphere only, the file's windows are wrong.
RgbImage from_shown(const Frame& frame) {
    const Region shown = frame.shown(), window = frame.window();
    if (shown == window) return from_frame(frame);
    if (shown.pixels() / 64 > window.pixels())
        refuse_environment(
            fmt::format("shows {} x {} pixels (its display window), but has only {} x {} of them; store the whole environment", shown.width,
                        shown.height, window.width, window.height));
    return from_frame(shown_part(frame));
}

void check_radiances(const RgbImage& image) {
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        if (!(image.rgb[i] >= 0) || !std::isfinite(image.rgb[i]))
            refuse_environment(
                fmt::format("has the radiance {} at pixel ({}, {}); expected finite values of 0 or more, so repair the image", image.rgb[i],
                            i / 3 % image.width, i / 3 / image.width));
}

} // namespace

RgbImage read_environment_image(const std::string& path) {
    const PictureFormat format = picture_format(path);
    try {
        if (is_display_light(format)) refuse_environment("is a picture of 8 bits; an environment is a Radiance .hdr, OpenEXR or PFM image");
        RgbImage image = from_shown(read_picture(path));
        check_radiances(image);
        return image;
    } catch (const Error& e) {
        throw Error(e.kind(), e.what(), path);
    }
}

} // namespace clvr

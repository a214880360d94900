#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"

#include <cmath>
#include <fmt/format.h>

namespace clvr {

namespace {

[[noreturn]] void refuse(const std::string& what) { throw Error(ErrorKind::input, what); }

RgbImage from_frame(const Frame& frame) {
    RgbImage image{frame.width, frame.height, std::vector<float>(3 * frame.pixels()), frame.notes};
    const char* names[3] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float>* const channel = frame.find(names[c]);
        if (!channel) refuse(fmt::format("has no channel {}; an environment needs R, G and B", names[c]));
        for (std::size_t i = 0; i < frame.pixels(); ++i) image.rgb[3 * i + c] = (*channel)[i];
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
    const PictureFormat format = picture_format(path);
    try {
        if (is_display_light(format)) refuse("is a picture of 8 bits; an environment is a Radiance .hdr, OpenEXR or PFM image");
        const Frame frame = read_picture(path);
        RgbImage image = from_frame(frame.shown() == frame.window() ? frame : shown_part(frame));
        check_radiances(image);
        return image;
    } catch (const Error& e) {
        throw Error(e.kind(), e.what(), path);
    }
}

} // namespace clvr

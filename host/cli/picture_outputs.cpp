#include "host/cli/picture_outputs.hpp"
#include "host/io/picture/frame_file.hpp"

#include <algorithm>
#include <spdlog/spdlog.h>
#include <utility>

namespace clvr {

PictureOutputs::PictureOutputs(const std::vector<std::string>& paths, const std::string& over) : over_(over) {
    for (const auto& path : paths) check_frame_path(path);
}

void PictureOutputs::write(const Frame& frame, const Tonemap& tonemap, const std::vector<std::string>& paths) {
    const std::vector<float>* const alpha = frame.shown_alpha();
    for (const auto& path : paths) {
        const bool clear = alpha && std::any_of(alpha->begin(), alpha->end(), [](float a) { return a < 1; });
        if (is_jpeg_path(path) && clear) say_clear(path);
        if (!is_exr_path(path) && frame.pixel_aspect != 1 && !said_aspect_) {
            spdlog::warn("{}: its pixels are {:.4g} times as wide as high and are shown square", path, frame.pixel_aspect);
            said_aspect_ = true;
        }
        write_frame(frame, tonemap, path);
    }
}

void PictureOutputs::write(const std::function<DisplayPixels(bool)>& pixels, const std::vector<std::string>& paths) {
    for (const auto& path : paths) {
        if (!is_jpeg_path(path)) {
            write_png(pixels(true), path);
            continue;
        }
        if (!said_alpha_ && pixels(true).components == 4) say_clear(path);
        write_jpeg(pixels(false), path);
    }
}

void PictureOutputs::say_clear(const std::string& path) {
    if (!std::exchange(said_alpha_, true)) spdlog::warn("{}: JPEG has no alpha: the picture lies over black{}; .png keeps it", path, over_);
}

} // namespace clvr

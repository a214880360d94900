#include "host/cli/picture_outputs.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <utility>

namespace clvr {

namespace {

Frame beauty_of(const Frame& frame) {
    Frame beauty = frame.blank();
    beauty.attributes = frame.attributes, beauty.further = frame.further;
    for (const char* colour : colour_channels) beauty.channels[colour] = frame.at(colour);
    if (const std::vector<float>* const alpha = frame.shown_alpha()) beauty.channels["A"] = *alpha; // none over a background
    return beauty;
}

} // namespace

void add_channels_option(CLI::App& command, ExrChannels& channels) {
    command.add_option("--channels", channels.named, "EXR: all channels, or R G B A alone (a fifth of the bytes) [all]")
        ->type_name("beauty|all")
        ->group("Output");
}

PictureOutputs::PictureOutputs(const std::vector<std::string>& paths, const ExrChannels& channels, const std::string& over)
    : channels_(channels), over_(over) {
    if (channels.named != "all" && channels.named != "beauty")
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected beauty or all", channels.named), "--channels");
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
        if (is_exr_path(path) && channels_.beauty())
            write_exr(beauty_of(frame), path);
        else
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

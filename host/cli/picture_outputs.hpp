// The pictures that a command writes.
#pragma once
#include "host/frame/display_pixels.hpp"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// What an EXR holds of a frame, as --channels says.
struct ExrChannels {
    std::string named = "all"; ///< or beauty
    /// R G B A alone.
    bool beauty() const { return named == "beauty"; }
};
void add_channels_option(CLI::App& command, ExrChannels& channels);

/// Writes frames to files and says, once for all of them, what a format cannot hold: a JPEG's alpha, pixels that are not square.
class PictureOutputs {
public:
    /// Throws Error{input} unless all can be written (check_frame_path), Error{usage} for channels that have another name. `over`: what
    /// --background is called where the command has it.
    explicit PictureOutputs(const std::vector<std::string>& paths, const ExrChannels& channels, const std::string& over = "");
    /// write_frame for each path.
    void write(const Frame& frame, const Tonemap& tonemap, const std::vector<std::string>& paths);
    /// Only PNG and JPEG: `pixels(alpha)` are those of display_pixels.
    void write(const std::function<DisplayPixels(bool alpha)>& pixels, const std::vector<std::string>& paths);

private:
    ExrChannels channels_;
    std::string over_;
    bool said_alpha_ = false, said_aspect_ = false;

    void say_clear(const std::string& path);
};

} // namespace clvr

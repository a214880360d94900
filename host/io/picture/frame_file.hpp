// Frames to and from files.
#pragma once
#include "host/frame/tonemap.hpp"

#include <string>
#include <vector>

namespace clvr {

/// Scanline float32 ZIP OpenEXR with all channels and string attributes. Written beside, synced, renamed. Throws Error{input} when it
/// cannot be written.
void write_exr(const Frame& frame, const std::string& path);
/// Reads any scanline or tiled, half or float (or uint) EXR, channels in any order; the data window becomes the frame. Throws Error{input}.
Frame read_exr(const std::string& path);

/// R G B A of the frame as 8-bit sRGB PNG, RGBA with straight alpha when alpha is not 1 everywhere, else RGB. Exposure and curve act on the
/// straight colour C / A: the colour of a silhouette is that of the surface beside it, over every page that the picture is laid on. Throws
/// Error{input, usage}.
std::vector<unsigned char> encode_png(const Frame& frame, const Tonemap& tonemap);
void write_png(const Frame& frame, const Tonemap& tonemap, const std::string& path);
/// Any PNG as linear light 0..1 of its 8-bit sRGB (premultiplied; A where the file has an alpha). Throws Error{input}.
Frame read_png(const std::string& path);
/// read_png or read_exr, by the path's ending.
Frame read_picture(const std::string& path);

/// Whether the path ends in .exr.
bool is_exr_path(const std::string& path);
/// write_exr or write_png, by the path's ending.
void write_frame(const Frame& frame, const Tonemap& tonemap, const std::string& path);

/// Linear RGB image, row 0 on top: [width*height*3].
struct RgbImage {
    int width = 0, height = 0;
    std::vector<float> rgb;
};
/// Radiance .hdr or OpenEXR latitude-longitude image. Throws Error{input} (also for negative or non-finite radiance: names the pixel).
RgbImage read_environment_image(const std::string& path);

/// Throws Error{input} unless a file can be created at `path` with a known ending (.exr or .png): called before rendering starts.
void check_frame_path(const std::string& path);

} // namespace clvr

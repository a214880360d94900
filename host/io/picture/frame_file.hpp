// Frames to and from files.
#pragma once
#include "host/frame/display_pixels.hpp"
#include "host/frame/tonemap.hpp"

#include <string>
#include <vector>

namespace clvr {

/// Scanline float32 ZIP OpenEXR with all channels, both windows and all attributes, packed on all cores. Written beside, synced, renamed.
/// Throws Error{input} when it cannot be written.
void write_exr(const Frame& frame, const std::string& path);
/// Reads any scanline or tiled, half or float (or uint) EXR, channels in any order; the data window becomes the frame. Parts are joined
/// (exr_names.hpp); luminance and chroma become R G B, luminance alone too. Of several views the first, of mipmaps the largest. What is
/// left out or chosen stands in the notes. Throws Error{input}.
Frame read_exr(const std::string& path);
/// The same without values: size, attributes, and channels that are empty. Luminance and chroma alone have none.
Frame exr_outline(const std::string& path);

/// The part that the frame shows as 8-bit sRGB PNG, RGBA with straight alpha when alpha is not 1 everywhere, else RGB. Exposure and curve
/// act on the straight colour C / A: so a silhouette has the colour of the surface beside it, over any page that the picture is laid
/// on. Throws Error{input, usage}.
std::vector<unsigned char> encode_png(const Frame& frame, const Tonemap& tonemap);
void write_png(const Frame& frame, const Tonemap& tonemap, const std::string& path);
/// How much time a PNG may take to become small: quick is for pictures that are looked at once.
enum class PngEffort { usual, quick };
/// The same of pixels that are there already.
std::vector<unsigned char> encode_png(const DisplayPixels& pixels, PngEffort effort = PngEffort::usual);
void write_png(const DisplayPixels& pixels, const std::string& path);
/// Any PNG as linear light 0..1 of its 8-bit sRGB (premultiplied; A where the file has an alpha). Throws Error{input}.
Frame read_png(const std::string& path);

/// The same as JPEG over black, quality 95, every colour at full size. Throws Error{input, usage}; also for more than 65500 pixels a side.
void write_jpeg(const Frame& frame, const Tonemap& tonemap, const std::string& path);
struct JpegQuality {
    int percent = 95;
    bool full_colour = true; ///< else the colours have half the width and height
};
/// Pixels of three components, at most 65500 a side.
std::vector<unsigned char> encode_jpeg(const DisplayPixels& pixels, const JpegQuality& quality = {});
void write_jpeg(const DisplayPixels& pixels, const std::string& path);
/// Any JPEG of grey or RGB as linear light 0..1 of its sRGB. Throws Error{input}.
Frame read_jpeg(const std::string& path);

/// Radiance .hdr as linear R G B: stored values over the product of its EXPOSURE and COLORCORR lines, turned as the resolution line says.
/// Throws Error{input}.
Frame read_radiance(const std::string& path);
/// Portable float map, grey or colour, as R G B times the absolute value of its scale. Throws Error{input}.
Frame read_pfm(const std::string& path);

enum class PictureFormat { exr, png, jpeg, radiance, pfm };
/// By the first bytes. Throws Error{input} when they are another format's, naming those that clvr reads.
PictureFormat picture_format(const std::string& path);
/// Whether a format holds what a display shows, not linear radiance.
bool is_display_light(PictureFormat format);
/// Any of them. Throws Error{input}.
Frame read_picture(const std::string& path);

/// Whether the path ends in .exr, or in .jpg or .jpeg; case does not matter.
bool is_exr_path(const std::string& path);
bool is_jpeg_path(const std::string& path);
/// write_exr, write_jpeg or write_png, by the path's ending.
void write_frame(const Frame& frame, const Tonemap& tonemap, const std::string& path);

/// Linear RGB image, row 0 on top: [width*height*3].
struct RgbImage {
    int width = 0, height = 0;
    std::vector<float> rgb;
    std::vector<std::string> notes; ///< as Frame::notes
};
/// Radiance .hdr, OpenEXR or PFM latitude-longitude image. Throws Error{input} (also for negative or non-finite radiance: names the pixel).
RgbImage read_environment_image(const std::string& path);

/// Throws Error{input} unless a file can be created at `path` with a known ending (.png, .jpg or .exr): called before rendering starts.
void check_frame_path(const std::string& path);

} // namespace clvr

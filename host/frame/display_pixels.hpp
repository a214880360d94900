// What a picture for people holds.
#pragma once
#include "host/frame/tonemap.hpp"

#include <array>
#include <vector>

namespace clvr {

/// 8-bit sRGB, row 0 on top: [height][width][components].
struct DisplayPixels {
    int width = 0, height = 0, components = 3; ///< 4: with alpha, the colours straight
    std::vector<unsigned char> values;
};

/// R G B A of the part that the frame shows. Exposure and curve act on the straight colour C / A. With `alpha`, 4 components where alpha
/// (in 8 bits) is not 255 everywhere; without, the colours lie over black (in linear light). Throws Error{input} when R, G or B is missing,
/// Error{usage} for an unknown curve.
DisplayPixels display_pixels(const Frame& frame, const Tonemap& tonemap, bool alpha);

/// `rgba` with four components, or three of them where alpha is not wanted or is 255 everywhere.
DisplayPixels without_needless_alpha(DisplayPixels rgba, bool alpha);

/// The least values, in double, that become the 8-bit codes 0 to 255: of linear light in sRGB, and of alpha.
const std::array<double, 256>& least_of_srgb_codes();
const std::array<double, 256>& least_of_alpha_codes();

/// Linear light of an 8-bit sRGB picture, premultiplied; A where there are 4 components.
Frame frame_of(const DisplayPixels& pixels);

} // namespace clvr

// A picture on its way out of the live view.
#pragma once
#include "host/frame/display_pixels.hpp"

#include <cstdint>

namespace clvr {

enum class Phase {
    moving,       ///< quick: not the bits of its samples. Small while the scene changes, at last once in full size
    accumulating, ///< full size, as `clvr render` writes it at these samples; more follow
    settled       ///< full size, with all samples that the scene asks for: nothing follows
};

/// Where the background is transparent `pixels` have 4 components, unless alpha is 255 everywhere.
struct LivePicture {
    std::uint64_t number = 0;     ///< of the loop's pictures, from 1
    std::uint64_t generation = 0; ///< of the scene that it shows
    Phase phase = Phase::moving;
    int divider = 1; ///< of the scene's width and height
    int samples = 0; ///< per pixel
    DisplayPixels pixels;
    double elapsed_ms = 0; ///< that drawing it took
};

} // namespace clvr

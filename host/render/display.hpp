// A film's picture as a display shows it, made on the device.
#pragma once
#include "host/frame/display_pixels.hpp"
#include "host/frame/film.hpp"
#include "host/frame/tonemap.hpp"
#include "kernels/shared/types.h"

namespace clvr {

/// What a picture lies over when it is shown.
struct Behind {
    const Buffer* picture = nullptr; ///< linear R G B by pixel number, as kernels/render/background.cl leaves it
    bool opaque = false;             ///< without `picture`: over `colour`, else over nothing
    shared::float4 colour{};
};

/// R G B A of the film in 8 bits: the values of display_pixels for the frame that the film holds. Reads 4 bytes a pixel from the device.
/// Throws Error{usage} for an unknown curve.
class Display {
public:
    explicit Display(const Device& device);
    DisplayPixels show(Film& film, const Behind& behind, const Tonemap& tonemap, bool alpha);

private:
    Device device_;
    Kernel kernel_;
    Buffer least_;  // values of the codes: [2][256]
    Buffer pixels_; // kept for the next picture
};

} // namespace clvr

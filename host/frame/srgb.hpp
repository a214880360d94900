// sRGB component values to linear ones, from a committed table: no libm, so the same bits everywhere.
#pragma once

namespace clvr {

/// Linear value of an sRGB component in 0..1 (clamped): exact to 1 ulp at multiples of 1/255, interpolated between them (error below 6e-6).
double srgb_decode(double x);

} // namespace clvr

// Views from all around, for training.
#pragma once
#include <cstdint>
#include <vector>

namespace clvr {

/// Where a camera stands: as Camera's fields of the same names [degrees].
struct ViewPoint {
    double azimuth = 0, elevation = 0, zoom = 1;
};

/// `count` directions of a spherical Fibonacci set (Gonzalez, "Measurement of areas on a sphere using Fibonacci and latitude-longitude
/// lattices", 2010), each moved by up to half the set's spacing, elevations within +-80 degrees; zooms uniform between the two. The same
/// for a seed everywhere up to the last bit of the standard library's functions, which is why pairs.json keeps the numbers.
std::vector<ViewPoint> view_set(int count, std::uint64_t seed, double zoom_low, double zoom_high);

} // namespace clvr

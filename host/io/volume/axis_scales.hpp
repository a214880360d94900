// Voxel sizes from headers that give each axis a number and a unit of its own.
#pragma once
#include "host/volume/vec.hpp"

#include <array>
#include <string>
#include <vector>

namespace clvr {

/// What a file says of the distance of voxels along one axis.
struct AxisScale {
    double value = 0;   ///< in `unit`; 0 or less, or not finite: the file does not say
    std::string unit;   ///< as the file spells it; empty: none
    std::string source; ///< where it stands ("PhysicalSizeZ", "ImageJ's spacing="): for what is shown
};
/// x, y, z.
using AxisScales = std::array<AxisScale, 3>;

/// A spacing in mm and how it came to be.
struct ResolvedSpacing {
    Double3 spacing{1, 1, 1};
    std::vector<std::string> notes, decisions;
};
/// Each axis by its own unit. An axis that lacks a size takes x's (y's), which is noted. Where no unit is a length, proportions stay and
/// 1 mm a pixel is assumed along x, which is noted. `slices` is the size along z: a single slice needs no distance.
ResolvedSpacing resolve_spacing(const AxisScales& scales, std::size_t slices);

} // namespace clvr

// Axes of a volume as files give them, into Geometry.
#pragma once
#include "host/volume/geometry.hpp"

namespace clvr {

/// A negative spacing reverses its axis; the length of a direction that is no unit vector goes into the spacing.
void settle_axes(Geometry& g);
/// Gives the axes from number `given` on a direction (spacing 1): the world's axis of that number where it is independent of the given
/// axes, else one perpendicular to them.
void complete_axes(Geometry& g, int given);

} // namespace clvr

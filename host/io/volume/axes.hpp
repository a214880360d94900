// Axes of a volume as files give them, into Geometry.
#pragma once
#include "host/volume/geometry.hpp"

namespace clvr {

/// A negative spacing turns its axis round; a direction that is no unit vector gives its length to the spacing.
void settle_axes(Geometry& g);
/// Gives the axes from `given` on directions of their own (spacing 1): the world's axis of that number where it spans space with the
/// given ones, else one perpendicular to them.
void complete_axes(Geometry& g, int given);

} // namespace clvr

// Pictures of how far two pictures are apart.
#pragma once
#include "host/frame/frame.hpp"

namespace clvr {

/// The FLIP map (flip.hpp) as display light: black (0) over purple and orange to light yellow (1). Frames as for flip_map.
Frame flip_picture(const Frame& image, const Frame& reference);
/// |a - b| of clip(RGB, 0, 1)^(1/2.2), as display light that looks as bright as the difference is great.
Frame difference_picture(const Frame& image, const Frame& reference);

} // namespace clvr

// LDR-FLIP: the difference that a person sees when flipping between two pictures.
#pragma once
#include "host/frame/frame.hpp"

#include <vector>

namespace clvr {

/// P. Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", HPG 2020: colour differences after the eye's contrast
/// sensitivity, amplified at edges and points; for a screen 0.7 m wide with 3840 pixels at 0.7 m (67 pixels per degree). Per pixel 0
/// (equal) to 1. R G B are display light, clipped to 0..1. The frames are equally large and have R G B, finite.
std::vector<double> flip_map(const Frame& image, const Frame& reference);

} // namespace clvr

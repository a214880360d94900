// The parts of the computed head.
#pragma once
#include "host/volume/vec.hpp"
#include "kernels/shared/phantom.h"

#include <array>
#include <vector>

namespace clvr {

/// Distances of a body are kept within +-this [mm]: as far as the kernel looks at them.
constexpr std::array<float, shared::CLVR_BODIES> body_far{26, 18, 9, 3, 5, 6, 3, 3, 22, 14, 4, 3};

/// The parts of each body, in the order in which they are joined and cut. Positions in mm: x to the patient's left (mirrored, but for
/// vessels), y posterior, z up, the origin between the ear canals.
using Anatomy = std::array<std::vector<shared::PhantomPart>, shared::CLVR_BODIES>;
Anatomy head_anatomy();

} // namespace clvr

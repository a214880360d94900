// Volumes that clvr computes itself.
#pragma once
#include "host/volume/voxels.hpp"
#include "runtime/device.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace clvr {

/// The names that make_phantom knows: "head" is cut open on the patient's left to show skull and brain, "head-closed" is not.
std::vector<std::string> phantom_names();

/// Voxels that fill the head's box at 1.1 mm.
constexpr Int3 phantom_dims{176, 220, 232};

/// A CT-like head in Hounsfield units, with skin, skull, brain, and vessels with contrast agent; face towards -y, the patient's left
/// towards +x. It fills a fixed box of 194 x 242 x 255 mm, so `dims` set the spacing. The same bits on every device; `seed` changes texture
/// and noise. i16 and f32 hold Hounsfield units; the other types a linear scale of them, with slope and intercept set. Throws Error{usage}
/// for another name, or dims outside 1..2048.
Voxels make_phantom(Device& device, const std::string& name, const Int3& dims = phantom_dims, VoxelType type = VoxelType::i16,
                    std::uint64_t seed = 0);

} // namespace clvr

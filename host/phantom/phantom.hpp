// Volumes that clvr computes itself.
#pragma once
#include "host/volume/voxels.hpp"
#include "runtime/opencl/device.hpp"

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// The names that make_phantom knows: "head" is cut open on the patient's left to show skull and brain, "head-closed" is not; "beetle" is a
/// stag beetle, "snake" a young snake in its egg, "vessels" a tree of vessels, "foam" foam torn by turbulence, "machine" a machine part of
/// aluminium and steel, "skull" a bare skull on a holder, "cloud" a smooth field, "rock" a core of porous rock, "fibres" a woven composite.
std::vector<std::string> phantom_names();

struct PhantomOptions {
    std::optional<Int3> dims;        ///< 1..2048 each; by default phantom_size's
    std::optional<VoxelType> type{}; ///< by default phantom_size's
    std::uint64_t seed = 0;          ///< of growth, texture and noise
    const std::atomic<bool>* cancelled = nullptr;
};

/// What a volume is made with by default: head 176x220x232 i16, beetle 832x832x494 u16, snake 1024x1024x795 u8, ...
struct PhantomSize {
    Int3 dims{};
    VoxelType type = VoxelType::i16;
};
/// Throws Error{usage} for another name.
PhantomSize phantom_size(const std::string& name);

/// A CT-like volume in Hounsfield units; a patient's or animal's face towards -y, the left towards +x. It fills a fixed box (the head's:
/// 194 x 242 x 255 mm), so `dims` set the spacing. The same bits on every device. i16 and f32 hold Hounsfield units; the other types a
/// linear scale of them, with slope and intercept set. Throws Error{usage} for another name, or dims out of range; Error{interrupted}.
Voxels make_phantom(Device& device, const std::string& name, const PhantomOptions& options = {});

} // namespace clvr

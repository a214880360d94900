// Scenes, frames and networks that between them use every part of clvr; golden_values.hpp has the hashes of what they give. Their voxels
// and numbers are made of whole numbers, so that they are the same on every host.
#pragma once
#include "host/denoise/model.hpp"
#include "host/render/session.hpp"
#include "host/selftest/golden_values.hpp"

namespace clvr::selftest {

/// A solid ball with a rippled shell, 4 Mvoxel, made of whole numbers: the same voxels everywhere. Oblique, with three spacings.
const PreparedVolume& golden_volume();

/// The scene of that name among golden_hashes.
Scene golden_scene(const std::string& name);
Frame render_golden(const std::string& name, const std::vector<Device>& devices, const RenderControl& control = {});

/// 70x45 pixels with every channel that golden_network() reads, hard edges, partial opacity and variances.
Frame golden_noisy_frame();
/// The default shape of network with all preprocessing.
Model golden_network();
Frame golden_denoised(const Device& device);

/// Little enough for an interpreter, or for a compiler that takes minutes on wide vectors.
Model tiny_network();

/// A render of 12x12 pixels at 1 sample per pixel with all features, denoised by tiny_network(): every stage counts in its hash.
Frame golden_picture(Device device);

} // namespace clvr::selftest

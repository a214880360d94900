// What a live view of a volume takes: whole frames, from the camera's numbers to 8-bit pixels on the host.
#pragma once
#include "host/denoise/model.hpp"
#include "host/render/session.hpp"
#include "runtime/opencl/profile.hpp"

#include <string>
#include <vector>

namespace clvr::bench {

/// One way of looking, measured: medians over its frames.
struct LiveRow {
    std::string what; ///< "moving", "transfer function", "settled"
    int width = 0, height = 0, frames = 0;
    double frame_ms = 0;            ///< wall time of a frame
    double device_ms = 0;           ///< of that the device's commands; what is left is the host's
    std::vector<ProfileRow> stages; ///< mean of a frame's, longest first
};

/// Turns the camera (one sample and one feature ray a pixel, denoised), changes the transfer function, then lets the view settle (four
/// feature rays; samples are added, each frame denoised). Each row takes about `seconds`, after two frames of warming up.
std::vector<LiveRow> measure_live(Device& device, const PreparedVolume& volume, const Scene& scene, const Model& model, double seconds);

/// A table of the rows, and where the time of each goes.
std::string live_table(const std::vector<LiveRow>& rows);

} // namespace clvr::bench

// How readers answer --frame, --channel and --spacing.
#pragma once
#include "host/volume/volume_read_options.hpp"
#include "host/volume/voxels.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// The channel that --channel names; without it the first, and where there are several a note says so. Throws
/// Error{input} for one that is not there.
std::int64_t chosen_channel(const VolumeReadOptions& options, std::int64_t channels, const std::string& path,
                            std::vector<std::string>& notes);
/// How --frame was understood: "frame 2 of 0 to 4 along t"; nothing for a file with one frame. Returns Voxels::frames.
[[nodiscard]] int say_frame(int frame, std::int64_t frames, const char* axis, std::vector<std::string>& decisions);
/// Sets v's spacing: that of --spacing, else the file's `own` [mm], else 1 mm, which a note says.
void set_spacing(Voxels& v, const VolumeReadOptions& options, const std::optional<Double3>& own);

} // namespace clvr

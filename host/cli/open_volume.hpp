// The volume that a command works on: a file, a folder, or one that clvr computes.
#pragma once
#include "host/io/volume/volume_file.hpp"
#include "runtime/opencl/device.hpp"

#include <string>
#include <vector>

namespace clvr {

/// Whether the name means a volume that clvr computes ("demo:head").
bool is_demo_volume(const std::string& name);

/// Reads the file or folder, for which no device is needed, or computes the demo volume on the first device that can (those that fail
/// before are taken from the list, with a warning). Logs the reader's notes as warnings. Throws Error.
Voxels open_volume(const std::string& name, const VolumeReadOptions& options, std::vector<Device>& devices);

} // namespace clvr

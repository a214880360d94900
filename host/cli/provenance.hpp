// What an EXR says of its making.
#pragma once
#include "host/frame/frame.hpp"
#include "host/render/scene.hpp"
#include "runtime/opencl/device.hpp"

#include <string>
#include <vector>

namespace clvr {

/// Sets the attributes of `host/README.md`, "Frames". `scene_text`: the scene as JSON.
void add_provenance(Frame& frame, const Scene& scene, const std::string& scene_text, const std::vector<Device>& devices);

} // namespace clvr

// The files that a scene names.
#pragma once
#include "host/appearance/environment.hpp"
#include "host/render/scene.hpp"

#include <string>
#include <vector>

namespace clvr {

/// The tables of the scene's environment image; empty without one. `notes`, where given: how the image was read (Frame::notes). Throws
/// Error{input}.
EnvironmentTables read_environment(const Scene& scene, std::vector<std::string>* notes = nullptr);

} // namespace clvr

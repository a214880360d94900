// The files that a scene names.
#pragma once
#include "host/render/environment.hpp"
#include "host/render/scene.hpp"

namespace clvr {

/// The tables of the scene's environment image; empty without one. Throws Error{input}.
EnvironmentTables read_environment(const Scene& scene);

} // namespace clvr

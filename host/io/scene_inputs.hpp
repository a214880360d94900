// The files that a scene names.
#pragma once
#include "host/io/volume_file.hpp"
#include "host/render/environment.hpp"
#include "host/render/scene.hpp"

namespace clvr {

/// How the scene's volume is to be read.
VolumeReadOptions reading_options(const Scene& scene);
/// The tables of the scene's environment image; empty without one. Throws Error{input}.
EnvironmentTables read_environment(const Scene& scene);

} // namespace clvr

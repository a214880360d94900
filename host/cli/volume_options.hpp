// The options that say how a volume is read: the same for every command that takes one.
#pragma once
#include "host/io/volume/volume_file.hpp"

#include <CLI/CLI.hpp>

namespace clvr {

/// Adds --frame, --channel, --array, --series, --allow-gaps, --recursive, --dims, --type, --spacing and --endian, which set `options`. A
/// malformed value throws Error{usage}.
void add_volume_options(CLI::App& command, VolumeReadOptions& options);

/// Every option that was given in `given` replaces that in `options`.
void override_reading(VolumeReadOptions& options, const VolumeReadOptions& given);

/// "256x256x128". Throws Error{usage} naming --dims.
Int3 parse_dims(const std::string& text);

} // namespace clvr

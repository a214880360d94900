// The options that say how a volume is read: the same for every command that takes one.
#pragma once
#include "host/io/volume_file.hpp"

#include <CLI/CLI.hpp>

namespace clvr {

/// Adds --frame, --series, --allow-gaps, --dims, --type, --spacing and --endian, which set `options`. A malformed value throws
/// Error{usage}.
void add_volume_options(CLI::App& command, VolumeReadOptions& options);

/// "256x256x128". Throws Error{usage} naming --dims.
Int3 parse_dims(const std::string& text);

} // namespace clvr

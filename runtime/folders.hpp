// Where clvr keeps files of its own, by the XDG base directory rules.
#pragma once
#include <filesystem>
#include <optional>

namespace clvr {

/// $XDG_CACHE_HOME/clvr or ~/.cache/clvr; nothing when neither variable is an absolute path. Not created here.
std::optional<std::filesystem::path> cache_folder();

/// $XDG_CONFIG_HOME/clvr or ~/.config/clvr; nothing when neither variable is an absolute path. Not created here.
std::optional<std::filesystem::path> config_folder();

/// The folder exists, or was made just now, and takes new files.
bool writable_folder(const std::filesystem::path& folder);

} // namespace clvr

// Where clvr keeps files of its own (XDG base directories), and how it reads and replaces them.
#pragma once
#include "runtime/error.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace clvr {

/// $XDG_CACHE_HOME/clvr or ~/.cache/clvr, made if needed; its content can be made again at any time. Nothing, after one warning in the life
/// of the process, when it cannot be written.
std::optional<std::filesystem::path> cache_folder();

/// $XDG_CONFIG_HOME/clvr or ~/.config/clvr; nothing when neither variable is an absolute path. Not made here.
std::optional<std::filesystem::path> config_folder();

/// The folder exists, or was made just now, and takes new files.
bool writable_folder(const std::filesystem::path& folder);

/// The whole file, or nothing when it cannot be read.
std::optional<std::string> load_file(const std::filesystem::path& path);

/// Warns that a file of clvr's own is ignored because of this error: each line once in the life of the process.
void warn_of_ignored_file(const Error& error);

/// Makes the folder if needed and writes the file by `write_atomically`. Returns false when that fails; then nothing is left behind.
bool replace_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace clvr

// A command as one could type it again.
#pragma once
#include <CLI/CLI.hpp>

#include <string>

namespace clvr {

/// "clvr NAME" with the positional arguments and options that were given, from the line or a configuration file, less those that only say
/// where results go: -o and --json.
std::string command_text(const CLI::App& command);

} // namespace clvr

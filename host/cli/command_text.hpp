// A command as one could type it again.
#pragma once
#include <CLI/CLI.hpp>

#include <string>

namespace clvr {

/// "clvr NAME" with the positional arguments and the options that were given on the line or in a configuration file. -o and --json are left
/// out: they only say where results go.
std::string command_text(const CLI::App& command);

} // namespace clvr

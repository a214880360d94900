// The text of --help.
#pragma once
#include <CLI/CLI.hpp>

#include <string>

namespace clvr {

/// What the command does, its usage, commands, arguments and options by group, its footer; at most 80 columns but for examples.
std::string help_text(const CLI::App& command);

/// Lets --help of the app and of all its commands print help_text().
void use_help_text(CLI::App& app);

} // namespace clvr

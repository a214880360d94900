// The program as CLI11 knows it: all commands and their options, the source of --help, manual pages and completions.
#pragma once
#include "host/cli/described/option_text.hpp"

namespace clvr {

/// Adds every command and the options that all of them share.
void add_program(CLI::App& app);

/// What PRESET, SEL and the other placeholders of `clvr` stand for.
Placeholders placeholders();

} // namespace clvr

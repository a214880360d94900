// What a program installs about itself: manual pages and completions.
#pragma once
#include "host/cli/described/option_text.hpp"

#include <string>

namespace clvr {

/// Adds --completion SHELL, which prints a script and ends, and the hidden --share-files DIR, which writes the program's manual pages and
/// completions into DIR as they lie under /usr/share of Debian and ends: man/man1, bash-completion/completions, zsh/vendor-completions,
/// fish/vendor_completions.d. Both throw Error. The app must outlive its options.
void add_share_options(CLI::App& program, const std::string& version, const Placeholders& placeholders);

} // namespace clvr

// Manual pages from CLI11's description of a program.
#pragma once
#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace clvr {

/// The pages of a program and of each of its commands by file name: "clvr.1", "clvr-render.1"; commands inside commands are sections of
/// theirs. Hidden options and commands are left out. `version` stands at their foot.
std::map<std::string, std::string> man_pages(const CLI::App& program, const std::string& version);

} // namespace clvr

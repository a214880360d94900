// A command line without a command: `clvr VOLUME` is short for `clvr render VOLUME`.
#pragma once
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace clvr {

/// The words as CLI11 is to parse them. Where the first word that is no option of the program names no command but something that exists or
/// that clvr computes, or is an option of `clvr render` and no command follows: with `render --beside` before it. Throws Error{usage} for
/// another word, with the command that is meant where one is near.
std::vector<std::string> with_command(const CLI::App& program, std::vector<std::string> words);

/// The picture that `clvr VOLUME` writes: beside the file or folder with its name, without the ending (".nii.gz", ".ome.tif" as one) of a
/// file and with .png; of demo:NAME, NAME.png here. Throws Error{usage} where a name cannot be made of it.
std::string picture_beside(const std::string& volume);

} // namespace clvr

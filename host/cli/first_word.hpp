// A command line without a command: `clvr VOLUME` is short for `clvr render VOLUME`.
#pragma once
#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace clvr {

/// The words as CLI11 is to parse them. `render --beside` goes before them where the first word that is no option of the program names a
/// file, a folder or a volume that clvr computes, instead of a command; also where it is an option of `clvr render` and no command follows.
/// Any other word throws Error{usage}, with the command that may be meant.
std::vector<std::string> with_command(const CLI::App& program, std::vector<std::string> words);

/// The picture that `clvr VOLUME` writes. It lies beside the file or folder and has its name, with .png in place of a file's ending
/// (".nii.gz" and ".ome.tif" count as one). demo:NAME becomes NAME.png in the current folder. Throws Error{usage} where no name can be
/// made.
std::string picture_beside(const std::string& volume);

} // namespace clvr

// How many words an option takes from the command line.
#pragma once
#include <CLI/CLI.hpp>

namespace clvr {

/// Lets every option of the app and of its commands take exactly one word, so that what follows it is an argument: `-o a.png -o b.exr
/// scan.nii`. Several values are given by repeating the option or, where its description says so, by commas. Arguments without a name still
/// take all that is left. To be called when all options are added.
void take_single_values(CLI::App& app);

} // namespace clvr

// Standard input, output and error: results that cannot be printed are an error like a file that cannot be written.
#pragma once
#include <string>

namespace clvr {

/// First in main. Streams that are closed are opened on nothing, so that no file gets their number; what is written to a closed pipe, or
/// beyond a limit on file sizes (ulimit -f), fails with a reason and does not end the process.
void prepare_standard_streams();

/// Brings to the reader or the disk what was printed, through C and C++ streams. Returns why standard output could not take all of it;
/// empty: it could.
std::string standard_output_problem();

} // namespace clvr

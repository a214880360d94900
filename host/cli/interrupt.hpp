// Ctrl-C and SIGTERM as a flag.
#pragma once
#include <atomic>

namespace clvr {

/// From now on the first of these signals sets the flag instead of ending the program, so that what was finished can be saved; a second one
/// kills. Returns the flag.
const std::atomic<bool>& catch_interrupts();

} // namespace clvr

// The signals that ask a program to end: SIGINT (Ctrl-C), SIGTERM, SIGHUP (the terminal is gone).
#pragma once
#include <atomic>
#include <string>

namespace clvr {

/// From now on these signals are watched, except those that the program was told to ignore when it was started (nohup). A signal removes
/// all Temporary files and folders, prints one line and ends the program with exit code 130. To be called first in main, before any thread
/// begins; again in a child after fork().
void watch_signals(const std::string& program);

/// From now on the first signal only sets the flag, so that what was finished can be saved; a second SIGINT or SIGTERM ends the program at
/// once (a second SIGHUP does not, as shells and the kernel both send one). Returns the flag.
const std::atomic<bool>& catch_interrupts();

} // namespace clvr

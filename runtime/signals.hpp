// The signals that ask a program to end: SIGINT (Ctrl-C), SIGTERM, SIGHUP (the terminal is gone).
#pragma once
#include <atomic>
#include <string>

namespace clvr {

/// From now on these signals are watched, but those that whoever started the program has it ignore (nohup): Temporary files and folders are
/// removed, one line is said, exit code 130. First in main, before any thread begins; again in a child after fork().
void watch_signals(const std::string& program);

/// From now on the first signal sets the flag instead, so that what was finished can be saved; a second SIGINT or SIGTERM ends at once (a
/// second SIGHUP does not: shells and the kernel both send one). Returns the flag.
const std::atomic<bool>& catch_interrupts();

} // namespace clvr

// How the program ends: one line and an exit code that tells why, whoever ends it.
#pragma once
#include <string>

namespace clvr {

/// Runs the program's `body` and translates, once, what leaves it: Error, lack of memory, standard output that cannot be written, and
/// anything else. Before that it prepares the standard streams, watches the signals, and sees to it that a driver which ends the process
/// (LLVM calls exit(1) on a full disk) is named. Returns the exit code (runtime/error.hpp).
int run_program(const std::string& name, int (*body)(int argc, char** argv), int argc, char** argv);

/// Prints "<name>: <what>" to standard error. Never throws.
void complain(const std::string& name, const std::string& what) noexcept;

} // namespace clvr

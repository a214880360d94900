// Drivers are tried in a child process before clvr itself builds anything with them: a driver that cannot link, or crashes, ends only the
// child.
#pragma once
#include <map>
#include <string>

namespace clvr {

/// What is wrong with drivers, by the platform's place in the loader's list; -1 where not even a list can be had. A line each, without the
/// driver's name: "cannot link kernels: there is no linker (ld) in PATH", "crashed (Aborted)".
using DriverProblems = std::map<int, std::string>;

/// Builds and runs a small kernel on a device of each kind of each platform, in child processes, before this process has called OpenCL.
/// Takes a fraction of a second; that all went well is remembered in the cache folder as long as nothing changes that drivers depend on
/// (their files, their settings in the environment, the linkers in PATH), and then costs nothing. Problems are never remembered.
DriverProblems try_drivers();

/// What a driver's last words mean, in one line: `said` is what it printed, `end` what became of it ("crashed (Aborted)").
std::string driver_problem(const std::string& said, const std::string& end);

} // namespace clvr

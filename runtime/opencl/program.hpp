// Programs: one source file with its includes, built for one device with one set of definitions.
#pragma once
#include "runtime/drivers/facts.hpp"

#include <map>
#include <string>

namespace clvr {

/// The compiler options of every program of clvr on this device: OpenCL C 1.2, correct rounding where the driver offers the option, the
/// definitions. Never a fast-math option. Throws Error{internal} for a definition with blanks in it.
std::string build_options(const DeviceFacts& facts, const std::map<std::string, std::string>& defines);

/// Builds kernels/<path>. Throws Error{device} with the compiler's log (file and line) when it does not build.
cl::Program build_program(const cl::Context& context, const DeviceFacts& facts, const std::string& path,
                          const std::map<std::string, std::string>& defines);

} // namespace clvr

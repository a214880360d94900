// Memory of the host.
#pragma once
#include <cstddef>

namespace clvr {

/// Bytes that a process can still take without swapping: MemAvailable of Linux, else the physical memory.
std::size_t available_memory();

} // namespace clvr

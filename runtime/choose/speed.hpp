// The short probe that compares devices when no rule before it decides.
#pragma once
#include "runtime/drivers/facts.hpp"

#include <vector>

namespace clvr {

/// Milliseconds for a fixed small piece of work (kernels/probe/speed.cl), at the better of the widths 1 and 16. Throws what opening or
/// using the device throws.
double probe_speed_ms(const DeviceFacts& device);

/// The position in `devices` of the fastest of the `candidates` (positions, too) that pass the trust probe. The answer is stored per list
/// of candidates and driver versions. Throws Error{device} when none passes.
std::size_t fastest_device(const std::vector<DeviceFacts>& devices, const std::vector<std::size_t>& candidates);

} // namespace clvr

// Does a device compute as IEEE 754 says? Drivers' flags do not tell, so clvr compares bits once per device and driver
// (runtime/README.md, "Trust").
#pragma once
#include "runtime/opencl/device.hpp"

#include <optional>
#include <string>
#include <vector>

namespace clvr {

struct Trust {
    std::vector<std::string> failures;                ///< operations that differ from the host in any bit, with how often; empty: trusted
    bool denormals_in = false, denormals_out = false; ///< whether denormals are read and written as they are; a fact, not a condition

    bool ok() const { return failures.empty(); }
    /// "ok", or the failures.
    std::string text() const;
};

/// Runs kernels/probe/trust.cl at widths 1 and 16 on 10240 vectors of operands and compares with the host. Throws Error{device} when the
/// device cannot run it.
Trust probe_trust(const DeviceFacts& device);

/// The result that was stored for this device, driver and probe; nothing when there is none.
std::optional<Trust> stored_trust(const DeviceFacts& device);

/// The stored result, else probes and stores.
Trust trust_of(const DeviceFacts& device);

/// Throws Error{device} naming the device and the failing operations when it is not trusted.
void require_trust(const DeviceFacts& device);

/// Opens a device that is trusted, or any when `relaxed`. Throws Error{device} for one that is not, or has no compiler.
Device open_trusted(const DeviceFacts& facts, bool relaxed = false);

} // namespace clvr

// Workarounds for drivers, each named after what the driver does wrong. FACTS.md ("OpenCL") tells how each was seen.
#pragma once
#include <string>

namespace clvr::quirks {

/// PoCL 3.1 lists its platform with 0 devices when it cannot write its kernel cache (POCL_CACHE_DIR, XDG_CACHE_HOME, HOME).
/// Points POCL_CACHE_DIR to a private temporary folder, removed at exit, when the usual one is not writable. Must run before the first
/// OpenCL call.
void pocl_hides_devices_without_writable_cache();

/// PoCL 3.1 aborts the process on a broken program binary and has a cache of its own: never give it binaries.
bool pocl_aborts_on_broken_binaries(const std::string& platform);

/// Oclgrind claims to be CPU, GPU and accelerator at once, and interprets a thousand times slower than any of them.
bool oclgrind_claims_every_device_type(const std::string& platform);

/// Oclgrind 21.10 gives its compiler the source without regard for `#line`: its logs count lines of the whole text.
bool oclgrind_ignores_line_directives(const std::string& platform);

} // namespace clvr::quirks

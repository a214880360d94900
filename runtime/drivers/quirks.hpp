// Workarounds for drivers, each named after what the driver does wrong, with where it is known. tests/runtime/quirks_device_test.cpp looks
// whether the installed drivers still do it. What needs no code of its own is avoided by the kernels' rules: aligned vector loads through
// vloadN alone (PoCL faults on a float16* off 64-byte alignment) and little private memory per work-item (PoCL's groups live on 8 MiB
// thread stacks).
#pragma once
#include <cstdint>
#include <string>

namespace clvr::quirks {

/// PoCL 3.1 lists its platform with 0 devices when it cannot write its kernel cache (POCL_CACHE_DIR, XDG_CACHE_HOME, HOME).
/// Points POCL_CACHE_DIR to a private temporary folder, removed at exit, when the usual one is not writable. Returns whether there is a
/// writable one now. Must run before the first OpenCL call, and before there are threads, as it sets a variable: run_program calls it.
/// https://github.com/pocl/pocl/issues/325
bool pocl_hides_devices_without_writable_cache();

/// PoCL 3.1 cannot build without room in its kernel cache: LLVM says "IO failure" and calls exit(1), or the build fails. One line that
/// names the folder and why it takes no more (a full disk, a quota, ulimit -f); empty where there is room.
std::string pocl_cache_problem();

/// PoCL 3.1 aborts the process on a broken program binary (an assertion in pocl_binary.c) and has a cache of its own: never give it
/// binaries; fetching them compiles everything once more. https://github.com/inducer/pyopencl/issues/731
bool pocl_aborts_on_broken_binaries(const std::string& platform);

/// PoCL 3.1 puts a header that declares all 18,000 overloads of the built-in functions before each program, and reads it again whenever a
/// program is loaded: 30 ms each. clvr leaves it out, by its guard, and declares what its kernels call (kernels/lib/builtins.clh).
bool pocl_reads_a_header_of_all_builtins(const std::string& platform, const std::string& driver_version);

/// Oclgrind claims to be CPU, GPU and accelerator at once, and interprets a thousand times slower than any of them.
/// https://github.com/jrprice/Oclgrind/pull/99
bool oclgrind_claims_every_device_type(const std::string& platform);

/// Oclgrind 21.10 gives its compiler the source without regard for `#line`: its logs count lines of the whole text.
/// https://github.com/jrprice/Oclgrind/blob/master/src/core/Program.cpp
bool oclgrind_ignores_line_directives(const std::string& platform);

/// Oclgrind 21.10 stops at llvm.experimental.noalias.scope.decl, which clang leaves behind where it inlines a function that returns a
/// struct: such kernels are built with -fno-inline. https://github.com/jrprice/Oclgrind/issues/223
bool oclgrind_knows_no_noalias_scopes(const std::string& platform);

/// Some drivers give commands an end before their start (https://github.com/darktable-org/darktable/pull/21122), rusticl 22.3 one
/// nanosecond after it. The time in ms between two stamps; 0 when they are in the wrong order. What chooses by time measures with the
/// host's clock (speed.cpp).
double milliseconds_though_stamps_run_backwards(std::uint64_t start_ns, std::uint64_t end_ns);

} // namespace clvr::quirks

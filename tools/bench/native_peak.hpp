// The machine's own ceiling, for ratios.
#pragma once

namespace clvr::native {

/// Runs `rounds` of 16 independent chains of vector FMAs on two threads; returns the floating-point operations done.
double fma_chains(long rounds);

} // namespace clvr::native

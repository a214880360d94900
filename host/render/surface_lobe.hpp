// Directional albedo of the glossy lobe of kernels/lib/scatter.clh: what the diffuse lobe may have.
#pragma once
#include <vector>

namespace clvr {

/// [34]: directional albedo at cosine k/32, k = 0..32, then its cosine-weighted mean 2 * integral of E(mu) mu. Computed once, in double
/// without libm.
const std::vector<float>& surface_lobe_table();

} // namespace clvr

// The trackers as a C++ programmer would write them: scalar, one ray at a time, a flat volume, the standard library's functions, two
// threads. The same algorithms as kernels/render/free_flight.cl and march.cl (majorant grid, Philox, lattice, features), so that their
// times can be compared.
#pragma once
#include "host/appearance/transfer_function.hpp"
#include "host/volume/majorant_grid.hpp"
#include "kernels/shared/render_params.h"
#include "kernels/shared/volume_params.h"

#include <vector>

namespace clvr::native {

struct Inputs {
    const Voxels* voxels; ///< u8
    const MajorantGrid* grid;
    const TransferTable* table;
    const std::vector<float>* majorants;
    shared::VolumeParams volume;
    shared::RenderParams render;
};

/// First collision of one camera ray per pixel [mm], -1 where the ray passes: [width * height].
void delta_tracking(const Inputs& in, std::vector<float>& distance);

/// The ten feature planes of one ray per pixel: [10 * width * height].
void feature_march(const Inputs& in, std::vector<float>& planes);

} // namespace clvr::native

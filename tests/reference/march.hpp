// The feature march in double precision: every sample of the lattice visited, none skipped (host/README.md, "Features").
#pragma once
#include "host/render/view.hpp"
#include "tests/reference/volume.hpp"

#include <optional>

namespace clvr::reference {

struct MarchScene {
    const Voxels* voxels;
    const TransferTable* table;
    View view;
    int width, height, rays; ///< rays: 1 or 4 positions in a pixel
    double extinction, step; ///< [1/mm], [mm]
    IndexBox box;            ///< the clipped volume, index space
    std::optional<ClipPlane> plane;
};

/// One pixel's features, in the order and units of the renderer's planes.
struct Features {
    Double3 albedo{1, 1, 1}, normal{0, 0, 0};
    double depth = 1, opacity = 0, deviation = 0, half_depth = 1;
};
Features march_features(const MarchScene& scene, int x, int y);

} // namespace clvr::reference

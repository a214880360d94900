// A volume as a transfer function shows it, on the host: independent of the device.
#pragma once
#include "host/appearance/transfer_function.hpp"
#include "host/volume/majorant_grid.hpp"

#include <optional>
#include <utility>

namespace clvr {

/// The volume's part that no scene changes, computed once: majorant ranges.
struct PreparedVolume {
    Voxels voxels;
    MajorantGrid grid;
    explicit PreparedVolume(Voxels v) : voxels(std::move(v)), grid(majorant_grid(voxels)) {}
};

/// The volume prepared for a classification; the prepared volume outlives it.
struct Classified {
    const Voxels* voxels = nullptr;
    const MajorantGrid* grid = nullptr;
    TransferTable table;
    std::vector<float> majorants;
};

/// Without a transfer function by the automatic one. Throws Error{input} for one that the volume's values cannot have.
Classified classify(const PreparedVolume& volume, const std::optional<TransferFunction>& transfer);

} // namespace clvr

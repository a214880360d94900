#include "host/render/classified.hpp"
#include "host/appearance/majorants.hpp"

#include <algorithm>

namespace clvr {

Classified classify(const PreparedVolume& volume, const std::optional<TransferFunction>& transfer) {
    const auto [low, high] = std::minmax_element(volume.grid.range.begin(), volume.grid.range.end());
    Classified c{&volume.voxels, &volume.grid, {}, {}};
    c.table = tabulate(transfer ? *transfer : automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels)), volume.voxels,
                       *low, *high);
    c.majorants = majorants(volume.grid, c.table);
    return c;
}

} // namespace clvr

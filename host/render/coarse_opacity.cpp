#include "host/render/coarse_opacity.hpp"

#include <algorithm>
#include <array>

namespace clvr {

void mark_distances(std::vector<float>& grid, const shared::int4& cells) {
    // Two passes in opposite order over the 13 neighbours before each cell are exact for this distance (Rosenfeld, Pfaltz: "Sequential
    // operations in digital picture processing", 1966).
    const float farthest = static_cast<float>(std::max({cells.x, cells.y, cells.z}) + 1);
    for (float& v : grid)
        if (v <= 0) v = -farthest;
    const auto at = [&](int x, int y, int z) -> float& { return grid[(static_cast<std::size_t>(z) * cells.y + y) * cells.x + x]; };
    const auto approach = [&](int x, int y, int z, int sign) {
        float& here = at(x, y, z);
        if (here > 0) return;
        for (int n = 0; n < 13; ++n) { // the neighbours before it in the order of a pass
            const int i = x + sign * (n % 3 - 1), j = y + sign * (n / 3 % 3 - 1), k = z + sign * (n / 9 - 1);
            if (i < 0 || j < 0 || k < 0 || i >= cells.x || j >= cells.y || k >= cells.z) continue;
            here = std::max(here, std::min(at(i, j, k), 0.0f) - 1);
        }
    };
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x) approach(x, y, z, 1);
    for (int z = cells.z - 1; z >= 0; --z)
        for (int y = cells.y - 1; y >= 0; --y)
            for (int x = cells.x - 1; x >= 0; --x) approach(x, y, z, -1);
}

} // namespace clvr

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
    const auto width = static_cast<std::size_t>(cells.x);
    const auto row_of = [&](int y, int z) { return grid.data() + (static_cast<std::size_t>(z) * cells.y + y) * width; };
    // By rows: what the cells of the rows before it come to, which compilers do with vectors; then along the row.
    std::vector<float> columns(width + 2, -farthest - 1);
    const auto pass = [&](int y, int z, int sign) {
        std::fill(columns.begin(), columns.end(), -farthest - 1);
        for (int n = 0; n < 4; ++n) { // the rows before it in the order of a pass
            const int j = y + sign * (n < 3 ? n - 1 : -1), k = n < 3 ? z - sign : z;
            if (j < 0 || k < 0 || j >= cells.y || k >= cells.z) continue;
            const float* const before = row_of(j, k);
            for (std::size_t x = 0; x < width; ++x) columns[x + 1] = std::max(columns[x + 1], std::min(before[x], 0.0f));
        }
        float* const row = row_of(y, z);
        for (std::size_t n = 0; n < width; ++n) {
            const std::size_t x = sign > 0 ? n : width - 1 - n;
            if (row[x] > 0) continue;
            float nearest = std::max({columns[x], columns[x + 1], columns[x + 2]});
            if (n > 0) nearest = std::max(nearest, std::min(row[sign > 0 ? x - 1 : x + 1], 0.0f));
            row[x] = std::max(row[x], nearest - 1);
        }
    };
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y) pass(y, z, 1);
    for (int z = cells.z - 1; z >= 0; --z)
        for (int y = cells.y - 1; y >= 0; --y) pass(y, z, -1);
}

} // namespace clvr

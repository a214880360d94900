#include "host/volume/majorant_grid.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>

namespace clvr {
namespace {

constexpr std::size_t most_cells = std::size_t{1} << 21;

Int3 cells_of(const Int3& dims, int log2_edge) {
    Int3 cells;
    for (int a = 0; a < 3; ++a) cells[a] = (std::max(dims[a] - 2, 0) >> log2_edge) + 1;
    return cells;
}

/// The ranges of one layer of cells along z. The rows of a cell row are first folded into one row of minima and one of maxima (contiguous,
/// so the compiler vectorises it), then that row is cut into cells.
template <class T>
void layer_ranges(const Voxels& v, MajorantGrid& grid, int cell_z) {
    const T* voxels = v.data<T>();
    const std::size_t nx = v.dims[0], ny = v.dims[1], edge = std::size_t{1} << grid.log2_edge;
    const auto end = [&](std::size_t cell, int axis) { return std::min<std::size_t>(edge * cell + edge + 1, v.dims[axis]); };
    std::vector<T> low(nx), high(nx);
    for (int cell_y = 0; cell_y < grid.cells[1]; ++cell_y) {
        const std::size_t y0 = edge * cell_y, y1 = end(cell_y, 1), z0 = edge * cell_z, z1 = end(cell_z, 2);
        const T* first_row = voxels + (z0 * ny + y0) * nx;
        std::copy(first_row, first_row + nx, low.begin());
        std::copy(first_row, first_row + nx, high.begin());
        for (std::size_t z = z0; z < z1; ++z)
            for (std::size_t y = y0; y < y1; ++y) {
                const T* row = voxels + (z * ny + y) * nx;
                for (std::size_t x = 0; x < nx; ++x) {
                    low[x] = row[x] < low[x] ? row[x] : low[x];
                    high[x] = row[x] > high[x] ? row[x] : high[x];
                }
            }
        float* range = grid.range.data() + 2 * (static_cast<std::size_t>(cell_z) * grid.cells[1] + cell_y) * grid.cells[0];
        for (int cell_x = 0; cell_x < grid.cells[0]; ++cell_x) {
            const std::size_t x0 = edge * cell_x, x1 = end(cell_x, 0);
            range[2 * cell_x] = static_cast<float>(*std::min_element(low.begin() + x0, low.begin() + x1));
            range[2 * cell_x + 1] = static_cast<float>(*std::max_element(high.begin() + x0, high.begin() + x1));
        }
    }
}

} // namespace

int majorant_log2_edge(const Int3& dims) {
    int log2_edge = 4;
    const auto count = [&] {
        const Int3 c = cells_of(dims, log2_edge);
        return static_cast<std::size_t>(c[0]) * c[1] * c[2];
    };
    while (count() > most_cells) ++log2_edge;
    return log2_edge;
}

MajorantGrid majorant_grid(const Voxels& v) {
    MajorantGrid grid;
    grid.log2_edge = majorant_log2_edge(v.dims);
    grid.cells = cells_of(v.dims, grid.log2_edge);
    grid.range.resize(2 * grid.count());
    with_voxel_type(v.type, [&](auto sample) {
        for_each_index(static_cast<std::size_t>(grid.cells[2]),
                       [&](std::size_t z) { layer_ranges<decltype(sample)>(v, grid, static_cast<int>(z)); });
    });
    return grid;
}

} // namespace clvr

// The regular distance between the slices of a series, from positions that are rounded or jitter.
#pragma once
#include <cstddef>
#include <vector>

namespace clvr {

/// The regular places nearest to given ones.
struct SliceLattice {
    double step = 0;                ///< from the whole span [mm]
    std::size_t count = 1;          ///< of regular places
    std::vector<std::size_t> index; ///< the regular place of each given one
    std::vector<bool> in_step;      ///< whether it lies there, but for rounding
};

/// Of places in ascending order along a line [mm], at least two, whose texts are rounded to `rounding` (0: not rounded). Each gap is
/// counted by itself, so that rounding never adds up; the step is the span over the number of steps.
SliceLattice lattice_of(const std::vector<double>& along, double rounding);

} // namespace clvr

// Where a volume is empty, coarsely: for marches to leap over, and for soft light to be dimmed by.
#pragma once
#include "kernels/shared/types.h"

#include <vector>

namespace clvr {

/// In place of each 0 of a grid (`cells`, x fastest) minus its distance to the next cell that is above 0, the greatest of the three
/// distances along the axes [cells]; to the far side of the grid and one more where there is none. The cells closer than that are all 0.
void mark_distances(std::vector<float>& grid, const shared::int4& cells);

} // namespace clvr

// What a volume's values say about background and structure.
#pragma once
#include "host/volume/voxels.hpp"

#include <cstdint>
#include <vector>

namespace clvr {

/// Voxel counts over equal bins, in all of the volume and in its border (a shell of 1/32 of each axis, at least one voxel). Integer types
/// have a bin a value; f32 has 65536 bins over a range that leaves single outliers out (they count in the end bins).
struct ValueCounts {
    double low = 0, width = 1; ///< stored value at the middle of bin 0, distance of bins
    std::vector<std::uint64_t> all, border;
    double value(double bin) const { return low + width * bin; }
    std::size_t bins() const { return all.size(); }
};
/// `h`: of these voxels; of an integer type nothing is counted anew.
ValueCounts value_counts(const Voxels& v, const Histogram& h);

/// One side of the background value: structure lies from `threshold` to `top`, both in bins' stored values; `top` is on the other side of
/// the background when `sign` is -1.
struct ValueSide {
    int sign = 1;
    bool active = false; ///< holds structure at all
    bool surfaces =
        false;        ///< background and structure are apart: a gap or a valley in the counts. Otherwise the values fade out like a field
    bool cut = false; ///< a gap, and most structure right behind it: everything less dense was cut away before (surfaces only)
    double threshold = 0;     ///< what lies nearer to the background is background
    double solid = 0;         ///< on the way to the most frequent structure: where a surface is seen (surfaces only)
    double common = 0;        ///< the first structure that is frequent: flesh, bark (surfaces only)
    double dense = 0;         ///< where denser structure begins: bone
    double dense_share = 0;   ///< of the voxels beyond threshold
    double top = 0;           ///< robust end of the values
    std::vector<double> rank; ///< [65] share of this side's structure between threshold and threshold + k / 64 of the way to top
};

/// Background (the value that the border holds most) and the structure above and below it.
struct ValueShape {
    double low = 0, high = 0; ///< robust range of stored values; equal for a constant volume
    double background = 0;
    ValueSide above, below;
};
ValueShape value_shape(const ValueCounts& counts);

/// How much of the outside is dense: of the axis-parallel rays from all six faces (at most 128 x 128 a face) that meet a voxel beyond
/// `side.solid`, the share that meets one beyond `side.dense` within the three voxels after it. Small where dense structure is wrapped in
/// other structure.
double dense_outside(const Voxels& v, const ValueSide& side);

} // namespace clvr

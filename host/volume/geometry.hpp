// Where the voxels are: index space to world space.
#pragma once
#include "host/volume/vec.hpp"

namespace clvr {

/// World space is millimetres, LPS (x to the patient's left, y to posterior, z up = superior). Voxel centres lie at integer index;
/// the volume fills [-0.5, n-0.5] of index space on each axis.
struct Geometry {
    Double3 origin{0, 0, 0};  ///< world position of voxel (0,0,0) [mm]
    Double3 spacing{1, 1, 1}; ///< distance of voxel centres along each index axis [mm], > 0
    Matrix3 direction;        ///< columns: world directions of the index axes (unit length); det != 0, oblique and left-handed ones too

    /// The matrix of index-to-world: direction * diag(spacing).
    Matrix3 index_to_world() const {
        Matrix3 m = direction;
        for (auto& r : m.row)
            for (int j = 0; j < 3; ++j) r[j] *= spacing[j];
        return m;
    }
    Double3 to_world(const Double3& pos_index) const { return origin + index_to_world() * pos_index; }
    Double3 to_index(const Double3& pos_world) const { return index_to_world().inverse() * (pos_world - origin); }
};

} // namespace clvr

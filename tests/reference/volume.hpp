// Interpolation, gradient and classification in double precision, straight from host/README.md, "Geometry" and "Transfer function".
#pragma once
#include "host/appearance/transfer_function.hpp"

namespace clvr::reference {

/// The stored value of a voxel.
double stored_at(const Voxels& v, const Int3& voxel);
/// The lower voxel of the trilinear support of an index position: clamp(floor(p), 0, max(n-2, 0)) on each axis.
Int3 interpolation_base(const Voxels& v, const Double3& pos_index);
/// Trilinear stored value at an index position, clamped at the edge.
double interpolate(const Voxels& v, const Double3& pos_index);
/// Gradient of the physical value in world space [1/mm]: central difference of the interpolated field at +-1 voxel (edge-clamped, always
/// divided by 2), taken to world by the inverse transpose of index-to-world.
Double3 gradient_world(const Voxels& v, const Double3& pos_index);

struct Classified {
    double opacity;
    std::array<double, 3> color; ///< linear
};
/// The table, interpolated linearly, held constant outside.
Classified classify(const TransferTable& table, double stored);

} // namespace clvr::reference

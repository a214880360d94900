#include "tests/reference/volume.hpp"

#include <algorithm>
#include <cmath>

namespace clvr::reference {

double stored_at(const Voxels& v, const Int3& voxel) {
    const std::size_t i = (static_cast<std::size_t>(voxel[2]) * v.dims[1] + voxel[1]) * v.dims[0] + voxel[0];
    return with_voxel_type(v.type, [&](auto sample) { return static_cast<double>(v.data<decltype(sample)>()[i]); });
}

Int3 interpolation_base(const Voxels& v, const Double3& pos_index) {
    Int3 base;
    for (int a = 0; a < 3; ++a) base[a] = static_cast<int>(std::clamp(std::floor(pos_index[a]), 0.0, std::max(v.dims[a] - 2, 0) * 1.0));
    return base;
}

double interpolate(const Voxels& v, const Double3& pos_index) {
    const Int3 base = interpolation_base(v, pos_index);
    double sum = 0;
    for (int corner = 0; corner < 8; ++corner) {
        Int3 voxel;
        double weight = 1;
        for (int a = 0; a < 3; ++a) {
            const int upper = corner >> a & 1;
            const double t = std::clamp(pos_index[a], 0.0, v.dims[a] - 1.0) - base[a];
            voxel[a] = std::min(base[a] + upper, v.dims[a] - 1);
            weight *= upper ? t : 1 - t;
        }
        sum += weight * stored_at(v, voxel);
    }
    return sum;
}

Double3 gradient_world(const Voxels& v, const Double3& pos_index) {
    Double3 gradient_index;
    for (int a = 0; a < 3; ++a) {
        Double3 lower = pos_index, upper = pos_index;
        lower[a] -= 1;
        upper[a] += 1;
        gradient_index[a] = v.slope * (interpolate(v, upper) - interpolate(v, lower)) / 2;
    }
    return v.geometry.index_to_world().inverse().transposed() * gradient_index;
}

Classified classify(const TransferTable& table, double stored) {
    const double i = std::clamp((stored - table.first) * table.index_scale(), 0.0, transfer_entries - 1.0);
    const int e = std::min(static_cast<int>(i), transfer_entries - 2);
    const auto between = [&](double a, double b) { return a + (i - e) * (b - a); };
    Classified c{between(table.opacity[e], table.opacity[e + 1]), {}};
    for (int k = 0; k < 3; ++k) c.color[k] = between(table.color[4 * e + k], table.color[4 * (e + 1) + k]);
    return c;
}

} // namespace clvr::reference

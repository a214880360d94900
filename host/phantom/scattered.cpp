// The outlines of the computed volumes whose kernels scatter points in them: foam, rock.
#include "host/phantom/parts.hpp"

namespace clvr {

MadeVolume foam_volume() {
    MadeVolume v{"foam", {-50, -50, -50}, {100, 100, 100}, {320, 320, 320}, VoxelType::u8, {}};
    v.bodies.push_back({10, false, {}});
    SolidBody(v.bodies[0]).ellipsoid({0, 0, 0}, {44, 44, 44}, 1);
    return v;
}

MadeVolume rock_volume() {
    MadeVolume v{"rock", {-32, -32, -36}, {64, 64, 72}, {320, 320, 360}, VoxelType::u16, {}};
    v.bodies.push_back({3, false, {}});
    SolidBody(v.bodies[0]).cylinder({{0, 0, 0}}, 29, 33, 0.4, 0.1);
    return v;
}

} // namespace clvr

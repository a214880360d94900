// Where the parts of the computed skull are: the head's bones and teeth, stretched, some teeth lost; a holder under them.
#include "host/phantom/parts.hpp"

#include <algorithm>

namespace clvr {
namespace {

/// Stretches parts (ellipsoids, blocks, tubes) along x, y and z around the origin; radii of tubes stay.
void stretch(MadeBody& body, const Double3& by) {
    const double most = std::max({by[0], by[1], by[2]});
    const auto multiplied = [](const shared::float4& v, const Double3& s) { return Double3{v.x * s[0], v.y * s[1], v.z * s[2]}; };
    for (shared::PhantomPart& p : body.parts) {
        p.center = packed(multiplied(p.center, by), p.center.w * most);
        if (p.kind == CLVR_PART_TUBE) {
            const Double3 axis = multiplied(p.b, by);
            p.a = packed(multiplied(p.a, by), p.a.w);
            p.b = packed(axis, 1 / inner(axis, axis));
        } else
            for (shared::float4* row : {&p.a, &p.b, &p.c}) {
                const Double3 r = multiplied(*row, {1 / by[0], 1 / by[1], 1 / by[2]});
                *row = packed(r, norm(r));
            }
    }
}

/// Whether the part belongs to neck or throat.
bool below_skull(const shared::PhantomPart& p) { return (p.center.z < -28 && p.center.y > 5) || (p.center.z < -84 && p.center.y > -30); }

} // namespace

MadeVolume skull_volume(std::uint64_t seed) {
    const MadeVolume head = head_volume(false);
    MadeVolume v{"skull", {-80, -112, -104}, {160, 216, 240}, {256, 346, 384}, VoxelType::u8, {}};
    Chance chance(seed ^ 0x534b554c4cu);
    const Double3 by{chance.between(0.93, 1.06), chance.between(0.94, 1.06), chance.between(0.94, 1.05)};
    for (const int k : {shared::CLVR_CAVITY, shared::CLVR_FACE, shared::CLVR_TEETH, shared::CLVR_AIR, shared::CLVR_ORBIT}) {
        MadeBody body = head.bodies[static_cast<std::size_t>(k)];
        auto& parts = body.parts;
        if (k == shared::CLVR_FACE) parts.erase(std::remove_if(parts.begin(), parts.end(), below_skull), parts.end());
        if (k == shared::CLVR_TEETH) { // a crown and its root each
            std::vector<shared::PhantomPart> kept;
            for (std::size_t i = 0; i + 1 < parts.size(); i += 2)
                if (chance() > 0.12) kept.insert(kept.end(), {parts[i], parts[i + 1]});
            parts = kept;
        }
        stretch(body, by);
        v.bodies.push_back(body);
    }
    v.bodies.push_back({2, false, {}});
    v.bodies.push_back({1, false, {}});
    SolidBody holder(v.bodies[shared::CLVR_SKULL_HOLDER]), wires(v.bodies[shared::CLVR_SKULL_WIRES]);
    // A plate with a pole into the braincase, three thin rods up to the jaw and the back of the head, a strap of film around.
    holder.cylinder({{0, 5, -99}}, 62, 1, 0.5, 0.5).cylinder({{0, 30, -50}}, 3.5, 50, 0.5, 1);
    holder.tube({{34, -64, -99, 1}, {25, -76, -82, 1}}, 0.5).tube({{-34, -64, -99, 1}, {-25, -76, -82, 1}}, 0.5);
    holder.tube({{0, 64, -99, 1}, {0, 80, 0, 1}}, 0.5);
    holder.cylinder({{0, 30, 0}}, 16, 0.4, 0.2, 0.5);
    for (const double side : {1.0, -1.0})
        wires.curve({{side * 50, -22, -20, 0.35}, {side * 57, -20, -12, 0.35}, {side * 66, -22, -4, 0.35}, {side * 61, -26, 4, 0.35}}, 0.1);
    return v;
}

} // namespace clvr

// Where the parts of the computed machine part are: a cast housing on a plate, with ribs or fins, tapped bores, screws, a bearing and a
// spring.
#include "host/phantom/parts.hpp"

namespace clvr {
namespace {

/// The pose turned about z: its first axis points away from z.
Pose around(double turns, double radius, double z) {
    const Double3 out = on_circle(turns);
    return {{radius * out[0], radius * out[1], z}, out, {-out[1], out[0], 0}};
}

/// Three boxes make a hexagon, `flat` its half width over flats.
void hexagon(SolidBody& body, const Double3& at, double flat, double half_length, double turns) {
    for (int k = 0; k < 3; ++k) {
        Pose pose = around(turns + k / 6.0, 0, 0);
        pose.at = at;
        body.box(pose, {flat, flat * 0.57735, half_length}, 0.2, 0.02);
    }
}

/// A screw along z with its head's underside at `at`, as long as `length`.
void screw(SolidBody& steel, const Double3& at, double radius, double length, double pitch, double turns) {
    steel.cylinder({{at[0], at[1], at[2] - length / 2}}, radius, length / 2, 0.3, 0.1, 1, pitch);
    steel.cylinder({{at[0], at[1], at[2] + 0.4}}, radius * 2.1, 0.4, 0.1, 0.1);
    hexagon(steel, {at[0], at[1], at[2] + 0.8 + radius * 0.65}, radius * 1.6, radius * 0.65, turns);
}

/// Round wire around z.
void spring(SolidBody& steel, double radius, double wire, double low, double high, double coils) {
    constexpr int pieces = 20; // a coil
    std::vector<Node> nodes;
    const int count = static_cast<int>(coils * pieces);
    for (int k = 0; k <= count; ++k) {
        const Double3 out = on_circle(static_cast<double>(k) / pieces);
        nodes.push_back({radius * out[0], radius * out[1], low + (high - low) * k / count, wire});
    }
    steel.tube(nodes, 0.05);
}

} // namespace

MadeVolume machine_volume(std::uint64_t seed) {
    MadeVolume v{"machine", {-50, -50, -38}, {100, 100, 76}, {384, 384, 292}, VoxelType::u16, {}};
    for (const float far : {3.f, 5.f}) v.bodies.push_back({far, false, {}});
    SolidBody cast(v.bodies[shared::CLVR_MACHINE_ALUMINIUM]), steel(v.bodies[shared::CLVR_MACHINE_STEEL]);
    Chance chance(seed ^ 0x4d414348494e45u);

    // Plate, housing, flange; ribs or cooling fins; a pipe to the side; a thin-walled box.
    const double radius = chance.between(16, 19), width = chance.between(37, 42), depth = chance.between(33, 37), top = 14;
    const bool finned = chance() < 0.5;
    cast.box({{0, 0, -27}}, {width, depth, 3.5}, 1.2, 1);
    cast.cylinder({{0, 0, (top - 27) / 2}}, radius, (top + 27) / 2, 0.5, 4);
    const double side = chance.between(0.2, 0.3), box_side = side + 0.5;
    if (finned)
        for (double z = -16; z < top - 5; z += 3.2) cast.cylinder({{0, 0, z}}, radius + 7, 0.55, 0.4, 0.8);
    else
        for (int k = 0, n = 5 + static_cast<int>(chance() * 4); k < n; ++k)
            cast.box(around((k + 0.5) / n, radius + 3, -10), {7, 1.0, 14}, 0.5, 2.5);
    const Pose pipe = facing(around(side, radius + 8, -5).at, on_circle(side));
    cast.cylinder(pipe, 8, 14, 0.6, 2.5);
    Pose chamber = around(box_side, radius + 9, -15);
    cast.box(chamber, {9, 13, 9}, 1.5, 2);
    chamber.at[2] += 2;
    cast.box(chamber, {8.1, 12.1, 9}, 1, 0.4, -1);
    cast.cylinder({{0, 0, top}}, radius + 6, 2.5, 0.5, 3);
    // What is turned out, bored and tapped.
    const double pitch = chance.between(1.8, 2.6);
    cast.cylinder({{0, 0, 4}}, radius - 3, 14, 0.3, 0.3, -1);
    cast.cylinder({{0, 0, 0}}, radius - 8, 40, 0.2, 0.6, -1);
    cast.cylinder(pipe, 5.2, 24, 0.2, 0.3, -1, pitch);
    for (int k = 0; k < 6; ++k) { // a grille through the plate
        const Pose slot = around(box_side + 0.25 + 0.04 * (k - 2.5), 30, -27);
        cast.box(slot, {4, 1.1, 8}, 0.8, 0.4, -1);
    }
    const int screws = 6 + static_cast<int>(chance() * 3), missing = static_cast<int>(chance() * screws);
    for (int k = 0; k < screws; ++k) {
        const Double3 at = around(static_cast<double>(k) / screws, radius + 2.6, top + 2.5).at;
        cast.cylinder({{at[0], at[1], top}}, 1.7, 9, 0.1, 0.5, -1, 1.1);
        if (k != missing) screw(steel, at, 1.6, 8, 1.1, chance());
    }
    for (const double x : {-1.0, 1.0})
        for (const double y : {-1.0, 1.0}) {
            const Double3 at{x * (width - 6), y * (depth - 6), -23.5};
            cast.cylinder({at}, 3.4, 9, 0.1, 0.8, -1);
            cast.cylinder({at}, 6, 0.8, 0.1, 0.3, -1);
            if (x + y == 0) screw(steel, at, 3, 12, 1.6, chance());
        }
    // A shaft in a bearing, with a thread and a nut above, a keyway, a spring.
    const double shaft = radius - 11, outer = radius - 3.1, ball = (outer - shaft - 2.4) / 2, middle = (outer + shaft) / 2, height = 12.5;
    steel.cylinder({{0, 0, height}}, outer, 4, 0.4, 0.1);
    steel.cylinder({{0, 0, height}}, outer - 2, 6, 0, 0.1, -1);
    steel.cylinder({{0, 0, height}}, shaft + 2, 4, 0.3, 0.1);
    steel.cylinder({{0, 0, 1}}, shaft, 31, 0.6, 0.1);
    steel.box({{0, -shaft, -12}}, {1.4, 1.6, 9}, 0.3, 0.1, -1);
    steel.cylinder({{0, 0, 31}}, shaft - 0.8, 4, 0.5, 0.1, 1, pitch);
    hexagon(steel, {0, 0, 30.5}, shaft * 1.4, 1.8, chance());
    for (int k = 0, n = static_cast<int>(6.0 * middle / (2.3 * ball)); k < n; ++k)
        steel.ellipsoid(around((k + chance.between(-0.04, 0.04)) / n, middle, height).at, {ball, ball, ball}, 0.05);
    spring(steel, shaft + 2.2, 0.8, 17.5, 28, chance.between(3.5, 5));
    return v;
}

} // namespace clvr

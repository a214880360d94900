// Where the parts of the computed vessel tree are: it forks by C. D. Murray's law (the cubes of the branches' radii sum to the stem's),
// 1926.
#include "host/phantom/parts.hpp"

namespace clvr {
namespace {

constexpr Double3 middle{0, 0, 4}, reach{44, 34, 40}; ///< of the lobe [mm]

double depth_in_lobe(const Double3& p) { // 0 in the middle, 1 on the surface
    const Double3 q{(p[0] - middle[0]) / reach[0], (p[1] - middle[1]) / reach[1], (p[2] - middle[2]) / reach[2]};
    return norm(q);
}

void grow(SolidBody& tree, Chance& chance, Double3 at, Double3 along, double radius, int generation) {
    if (generation > 11 || radius < 0.32) return;
    // A few bends on the way, away from the surface where it comes near.
    const double length = radius * chance.between(5.5, 8.5) + 2;
    std::vector<Node> path{{at[0], at[1], at[2], radius}};
    for (int k = 0; k < 3; ++k) {
        along = unit(along + chance.direction() * 0.28);
        const Double3 next = at + along * (length / 3);
        if (depth_in_lobe(next) > 0.93) along = unit(along + (middle - at) * (0.9 / norm(middle - at)));
        at = at + along * (length / 3);
        path.push_back({at[0], at[1], at[2], radius * (1 - 0.04 * (k + 1))});
    }
    tree.curve(path, 0.3, 2);
    // The share of the flow that the larger branch takes decides radii and angles.
    const double share = chance.between(0.5, 0.8);
    const auto cube_root = [](double v) {
        double r = v > 1 ? v : 1;
        for (int k = 0; k < 40; ++k) r = (2 * r + v / (r * r)) / 3;
        return r;
    };
    const Double3 aside = unit(cross(along, chance.direction()));
    grow(tree, chance, at, unit(along + aside * (0.85 - 0.7 * share)), radius * 0.96 * cube_root(share), generation + 1);
    grow(tree, chance, at, unit(along - aside * (0.25 + 0.9 * share)), radius * 0.96 * cube_root(1 - share), generation + 1);
}

} // namespace

MadeVolume vessel_volume(std::uint64_t seed) {
    MadeVolume v{"vessels", {-48, -38, -44}, {96, 76, 96}, {384, 304, 384}, VoxelType::i16, {}};
    for (const float far : {8.f, 1.5f}) v.bodies.push_back({far, false, {}});
    SolidBody(v.bodies[shared::CLVR_VESSEL_LOBE]).ellipsoid(middle, reach, 1);
    Chance chance(seed ^ 0x564553u);
    SolidBody tree(v.bodies[shared::CLVR_VESSEL_TREE]);
    grow(tree, chance, {6, 0, -43}, unit({-0.1, 0.05, 1}), 4.2, 0);
    grow(tree, chance, {-8, 6, -42}, unit({0.15, -0.1, 1}), 3.4, 1);
    return v;
}

} // namespace clvr

// Where the parts of the computed fibres are: bundles woven over and under each other in two directions, stray fibres among them, in a
// block.
#include "host/phantom/parts.hpp"

namespace clvr {
namespace {

constexpr double half = 47, gap = 22; ///< of a bundle's length, from bundle to bundle [mm]

/// A place in a bundle's cross-section.
struct Strand {
    double across, up, radius; ///< [mm]
};

/// `along` runs from -half to half; twists a little, bends in waves of `wave` mm that begin at `phase` turns.
std::vector<Node> path_of(const Strand& s, bool along_x, double middle, double level, double wave, double phase, Chance& chance) {
    constexpr int nodes = 13;
    const double twist = chance.between(0.02, 0.1), wander = chance.between(0.1, 0.5), start = chance();
    std::vector<Node> path;
    for (int k = 0; k < nodes; ++k) {
        const double t = static_cast<double>(k) / (nodes - 1), along = half * (2 * t - 1);
        const Double3 turn = on_circle(twist * t), sway = on_circle(start + 1.7 * t), over = on_circle(phase + along / (2 * gap));
        const double across = middle + turn[0] * s.across - turn[1] * s.up + wander * sway[0];
        const double up = level + turn[1] * s.across + turn[0] * s.up + wander * sway[1] + wave * over[0];
        path.push_back({along_x ? along : across, along_x ? across : along, up, s.radius});
    }
    return path;
}

} // namespace

MadeVolume fibres_volume(std::uint64_t seed) {
    MadeVolume v{"fibres", {-45, -45, -22}, {90, 90, 44}, {384, 384, 188}, VoxelType::u8, {}};
    for (const float far : {0.8f, 0.8f}) v.bodies.push_back({far, false, {}});
    SolidBody carbon(v.bodies[shared::CLVR_FIBRES_CARBON]), glass(v.bodies[shared::CLVR_FIBRES_GLASS]);
    Chance chance(seed ^ 0x464942524553u);
    for (const double level : {-7.5, 7.5})
        for (const bool along_x : {true, false})
            for (int b = 0; b < 4; ++b) {
                const bool of_glass = chance() < 0.4;
                const double radius = of_glass ? chance.between(0.4, 0.75) : chance.between(0.18, 0.4), wide = chance.between(5.5, 8);
                const int count = static_cast<int>(of_glass ? 9 / radius : 14 / radius);
                for (int k = 0; k < count; ++k) {
                    const Double3 d = chance.direction(); // in an ellipse, few in its middle
                    const Strand s{wide * d[0], 2.3 * d[1], radius * chance.between(0.8, 1.2)};
                    const double phase = 0.5 * ((b + (along_x ? 1 : 0)) % 2);
                    (of_glass ? glass : carbon).curve(path_of(s, along_x, (b - 1.5) * gap, level, 2.6, phase, chance), 0.02, 2);
                }
            }
    for (int k = 0; k < 60; ++k) { // strays
        const Double3 from{chance.between(-half, half), chance.between(-half, half), chance.between(-15, 15)}, way = chance.direction();
        const double length = chance.between(8, 30), bow = chance.between(-4, 4), radius = chance.between(0.15, 0.3);
        const Double3 aside = unit(cross(way, chance.direction()));
        std::vector<Node> path;
        for (int i = 0; i < 4; ++i) {
            const Double3 at = from + Double3{way[0], way[1], 0.25 * way[2]} * (length * i / 3) + aside * (bow * i * (3 - i) / 2.25);
            path.push_back({at[0], at[1], at[2], radius});
        }
        carbon.curve(path, 0.02, 3);
    }
    return v;
}

} // namespace clvr

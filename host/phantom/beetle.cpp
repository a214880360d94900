// Where the parts of the computed stag beetle are, head towards -y. Everything is mirrored.
#include "host/phantom/parts.hpp"

namespace clvr {

MadeVolume beetle_volume(std::uint64_t seed) {
    MadeVolume v{"beetle", {-41.6, -41.6, -24.7}, {83.2, 83.2, 49.4}, {832, 832, 494}, VoxelType::u16, {}};
    for (const float far : {3.f, 1.5f, 0.6f}) v.bodies.push_back({far, true, {}});
    SolidBody(v.bodies[shared::CLVR_BEETLE_TRUNK])
        .ellipsoid({0, 15, 1}, {13, 20, 8.5}, 1)       // abdomen under the wing cases
        .ellipsoid({7, 2, 1}, {6, 7, 7}, 3)            // shoulders
        .ellipsoid({0, -10.5, 1}, {12.5, 6.5, 7}, 0.8) // prothorax
        .ellipsoid({8, -10, 0.5}, {5, 5, 5}, 2)
        .ellipsoid({0, -20, 0.5}, {8, 5, 4.8}, 0.8) // head
        .ellipsoid({6.5, -20, 0.5}, {3.5, 4, 3.5}, 1.5)
        .ellipsoid({8.6, -22, 1.2}, {1.6, 1.8, 1.6}, 0.3) // eye
        .cut({0, 12, -9.5}, {9, 18, 4}, 2);
    const std::vector<std::vector<Node>> limbs{
        {{9, -11, -4.5, 1.6}, {17, -15, -1, 1.7}, {25, -19, 2.5, 1.4}},                               // front thigh
        {{25, -19, 2.5, 1.3}, {29, -26, -5, 1.1}, {32, -31, -11, 1.0}},                               // shin
        {{32, -31, -11, 0.6}, {34, -34, -14, 0.55}, {36, -37, -15.5, 0.5}, {37, -39.5, -15.5, 0.35}}, // foot
        {{10, -1, -5.5, 1.7}, {19, -1, -1, 1.8}, {27.5, 1, 2.5, 1.5}},
        {{27.5, 1, 2.5, 1.3}, {31, 5, -6, 1.1}, {33, 9, -13, 1.0}},
        {{33, 9, -13, 0.6}, {35, 12, -15.5, 0.55}, {37.5, 15, -16.5, 0.5}, {39, 17.5, -16, 0.35}},
        {{9, 9, -6, 1.8}, {16, 13, -2, 1.9}, {24, 18, 2, 1.5}},
        {{24, 18, 2, 1.3}, {28, 26, -6, 1.2}, {30, 32, -13, 1.0}},
        {{30, 32, -13, 0.6}, {31.5, 35, -15.5, 0.55}, {33, 38, -16.5, 0.5}, {33.5, 40, -16, 0.35}},
        {{7.5, -24, 1.5, 0.55}, {12.5, -25.5, 4, 0.5}}, // antenna
        {{12.5, -25.5, 4, 0.45}, {15.5, -29, 5, 0.4}, {17.5, -33, 5, 0.45}}};
    SolidBody body(v.bodies[shared::CLVR_BEETLE_LIMBS]);
    for (const auto& limb : limbs) body.curve(limb, 0.6);
    for (int k = 0; k < 3; ++k) { // club of the antenna, spines of the shins
        const double x = 17.5 + 0.9 * k, y = -33 - 1.1 * k;
        body.tube({{x, y, 5, 0.35}, {x + 1.3, y - 0.2, 4.2, 0.6}}, 0.2)
            .tube({{29.0 + k, -26 - 1.6 * k, -5 - 2.0 * k, 0.5}, {31.0 + k, -25 - 1.6 * k, -5.6 - 2.0 * k, 0.2}}, 0.3)
            .tube({{31 + 0.7 * k, 5 + 1.4 * k, -6 - 2.4 * k, 0.45}, {33 + 0.7 * k, 4.6 + 1.4 * k, -5.6 - 2.4 * k, 0.15}}, 0.3)
            .tube({{28 + 0.7 * k, 26 + 2.0 * k, -6 - 2.4 * k, 0.45}, {30 + 0.7 * k, 25.5 + 2 * k, -5.6 - 2.4 * k, 0.15}}, 0.3);
    }
    // Jaws: antlers with a fork and teeth.
    body.curve({{4.5, -23.5, 0, 2}, {7.5, -28, 1, 1.7}, {9, -33, 2.5, 1.4}, {7.5, -37.5, 4, 1.1}, {4.2, -40, 5, 0.4}}, 0.8)
        .tube({{8.9, -32, 2.3, 1.1}, {5.6, -33.2, 3.2, 0.3}}, 0.8)
        .tube({{8.2, -36, 3.6, 0.9}, {8.0, -40.2, 5.2, 0.3}}, 0.8)
        .tube({{7.2, -27.5, 0.9, 0.9}, {5.2, -29, 1.4, 0.3}}, 0.6)
        .tube({{2, -24, -1.5, 0.4}, {3.2, -27, -2.5, 0.3}}, 0.2); // feelers of the mouth

    Chance chance(seed ^ 0x424545544c45u);
    SolidBody hairs(v.bodies[shared::CLVR_BEETLE_HAIRS]);
    for (int k = 0; k < 420; ++k) {
        const auto& limb = limbs[static_cast<std::size_t>(chance() * 9)];
        const std::size_t piece = static_cast<std::size_t>(chance() * static_cast<double>(limb.size() - 1));
        const Node &a = limb[piece], &b = limb[piece + 1];
        const Double3 at = place(a) + (place(b) - place(a)) * chance(), along = unit(place(b) - place(a));
        Double3 out = chance.direction();
        out = unit(out - along * (inner(out, along) * 0.7));
        const Double3 tip = at + out * (a.radius + chance.between(0.5, 1.5)) + along * 0.4;
        hairs.tube({{at[0], at[1], at[2], 0.09}, {tip[0], tip[1], tip[2], 0.04}}, 0.02);
    }
    for (int k = 0; k < 260; ++k) { // a fringe under the trunk
        const double y = chance.between(-14, 30), x = chance.between(6, 12), z = chance.between(-7.5, -4);
        hairs.tube({{x, y, z, 0.08}, {x + chance.between(0.2, 1.4), y + chance.between(-0.4, 0.8), z - chance.between(0.8, 1.8), 0.04}},
                   0.02);
    }
    return v;
}

} // namespace clvr

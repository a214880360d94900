// Where the parts of the computed snake are: two coils one over the other, the head on top, in half an egg.
#include "host/phantom/parts.hpp"

namespace clvr {
namespace {

/// A place on the snake's axis.
struct Station {
    Double3 at, along;
    double radius; ///< of the flesh [mm]
};

constexpr double step = 1.15; ///< from vertebra to vertebra [mm]

/// From the tail, inwards below, outwards above. Turns by rational rotations, which need no sine.
std::vector<Station> axis_of(Chance& chance) {
    std::vector<Station> stations;
    constexpr double outer = 18, inner_radius = 6.6, pitch = 5.7 / 6.2832; // [mm], [mm per radian]
    double radius = outer, c = 1, s = 0, travelled = 0;
    const double wobble = chance.between(0.5, 1.0);
    bool inwards = true;
    while (inwards || radius < 16.2) {
        const double angle = step / radius, q = angle / 2, cosine = (1 - q * q) / (1 + q * q), sine = 2 * q / (1 + q * q);
        const double next_c = c * cosine - s * sine, next_s = s * cosine + c * sine;
        c = next_c, s = next_s;
        radius += (inwards ? -pitch : pitch) * angle;
        if (radius < inner_radius) inwards = false;
        const double rise = inwards ? 0 : std::min(1.0, (radius - inner_radius) / 2.0);
        const double z = -9.2 + 5.4 * rise * rise * (3 - 2 * rise) + wobble * c * s;
        travelled += step;
        const double taper = std::min(1.0, travelled / 70);
        stations.push_back({{radius * c, radius * s, z}, {}, 0.35 + 2.15 * taper * (2 - taper)});
    }
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const Station &before = stations[i > 0 ? i - 1 : i], &after = stations[std::min(i + 1, stations.size() - 1)];
        stations[i].along = unit(after.at - before.at);
    }
    return stations;
}

/// The head lies along `along`, its back at `at`.
void head(MadeVolume& v, const Double3& at, const Double3& along, const Double3& side, const Double3& up) {
    const auto node = [&](double forward, double left, double high, double radius) {
        const Double3 p = at + along * forward + side * left + up * high;
        return Node{p[0], p[1], p[2], radius};
    };
    SolidBody(v.bodies[shared::CLVR_SNAKE_FLESH])
        .tube({node(-1, 0, 0, 2.3), node(2.5, 0, 0.4, 2.5), node(6.5, 0, 0.1, 1.5)}, 1.2)
        .tube({node(1.5, 1.1, 0.2, 1.9), node(4.5, 0.8, 0.2, 1.6)}, 1)
        .tube({node(1.5, -1.1, 0.2, 1.9), node(4.5, -0.8, 0.2, 1.6)}, 1);
    SolidBody bone(v.bodies[shared::CLVR_SNAKE_BONE]);
    bone.tube({node(0, 0, 0.9, 0.75), node(2.2, 0, 1.1, 0.95), node(4.2, 0, 0.9, 0.6), node(6.6, 0, 0.5, 0.35)}, 0.4);
    for (const double l : {1.0, -1.0})
        bone.tube({node(0.4, l * 0.8, 0.9, 0.25), node(0.2, l * 2.0, -0.2, 0.25)}, 0.2)                                // quadrate
            .tube({node(0.2, l * 2.0, -0.3, 0.28), node(3, l * 1.8, -0.9, 0.26), node(6.4, l * 0.5, -0.8, 0.18)}, 0.2) // lower jaw
            .tube({node(2.4, l * 1.9, 0.3, 0.22), node(5, l * 1.3, 0.1, 0.26), node(6.8, l * 0.4, 0.2, 0.22)}, 0.2)    // upper jaw
            .tube({node(3.6, l * 0.6, 1.2, 0.2), node(3.9, l * 1.5, 0.9, 0.18), node(3.6, l * 1.7, 0.3, 0.18)}, 0.2)   // orbit
            .tube({node(1.2, l * 0.9, 0.1, 0.2), node(4.8, l * 0.7, -0.1, 0.18)}, 0.2);                                // palate
}

} // namespace

MadeVolume snake_volume(std::uint64_t seed) {
    MadeVolume v{"snake", {-28, -28, -21.75}, {56, 56, 43.5}, {1024, 1024, 795}, VoxelType::u8, {}};
    for (const float far : {3.f, 1.5f, 0.8f, 0.8f}) v.bodies.push_back({far, false, {}});
    SolidBody(v.bodies[shared::CLVR_SNAKE_EGG]).ellipsoid({0, 0, 0}, {25, 25, 18}, 1);

    Chance chance(seed ^ 0x534e414b45u);
    const std::vector<Station> stations = axis_of(chance);
    SolidBody flesh(v.bodies[shared::CLVR_SNAKE_FLESH]), gut(v.bodies[shared::CLVR_SNAKE_GUT]), bone(v.bodies[shared::CLVR_SNAKE_BONE]);
    for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
        const Station &a = stations[i], &b = stations[i + 1];
        const Double3 side = unit(cross({0, 0, 1}, a.along)), up = cross(a.along, side);
        const auto node = [&](double left, double high, double forward, double radius) {
            const Double3 p = a.at + side * (left * a.radius) + up * (high * a.radius) + a.along * forward;
            return Node{p[0], p[1], p[2], radius * a.radius};
        };
        flesh.tube({{a.at[0], a.at[1], a.at[2], a.radius}, {b.at[0], b.at[1], b.at[2], b.radius}}, 0.05);
        if (i > 40 && i % 60 < 42) gut.tube({node(0.15, -0.35, 0, 0.22), node(0.1, -0.35, step, 0.22)}, 0.05);
        bone.tube({node(0, 0.42, -0.42 * step, 0.14), node(0, 0.42, 0.3 * step, 0.12)}, 0.1) // vertebra: body, spine, wings
            .tube({node(0, 0.5, 0, 0.07), node(0, 0.75, -0.15, 0.05)}, 0.1)
            .tube({node(-0.24, 0.44, 0, 0.06), node(0.24, 0.44, 0, 0.06)}, 0.1);
        if (i > 55 && i + 6 < stations.size())
            for (const double l : {1.0, -1.0})
                bone.tube({node(l * 0.2, 0.42, 0, 0.06), node(l * 0.6, 0.3, -0.15, 0.055), node(l * 0.82, -0.1, -0.35, 0.05),
                           node(l * 0.66, -0.55, -0.5, 0.03)},
                          0.05);
    }
    const Station& last = stations.back();
    const Double3 side = unit(cross({0, 0, 1}, last.along));
    head(v, last.at, last.along, side, cross(last.along, side));
    return v;
}

} // namespace clvr

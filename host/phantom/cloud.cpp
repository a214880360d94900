// Where the blobs of the computed cloud are: sprays that widen from nozzles below, with puffs that came loose.
#include "host/phantom/parts.hpp"

namespace clvr {

MadeVolume cloud_volume(std::uint64_t seed) {
    MadeVolume v{"cloud", {-40, -40, -50}, {80, 80, 100}, {256, 256, 320}, VoxelType::u8, {}};
    v.bodies.push_back({20, false, {}}); // turbulence moves points by less
    SolidBody body(v.bodies[0]);
    Chance chance(seed ^ 0x434c4f5544u);
    const int sprays = 1 + static_cast<int>(chance() * 3);
    for (int s = 0; s < sprays; ++s) {
        const Double3 out = on_circle(chance());
        const double aside = sprays > 1 ? chance.between(7, 11) : 0, lean = chance.between(-0.2, 0.04), strength = 2.2 / (1 + 0.3 * sprays);
        constexpr int blobs = 22;
        for (int k = 0; k < blobs; ++k) {
            const double t = (k + chance()) / blobs, size = 5.5 + 9 * t;
            const Double3 scatter = chance.direction() * (0.5 * size);
            const Double3 at = Double3{out[0] * (aside + lean * 80 * t), out[1] * (aside + lean * 80 * t), -38 + 52 * t} + scatter;
            body.blob(at, {size * chance.between(0.7, 1.1), size * chance.between(0.7, 1.1), size * chance.between(1.0, 1.6)},
                      strength * (1.2 - 0.7 * t) * chance.between(0.3, 1), chance.between(-0.4, 0.4), chance.between(-0.6, 0.6));
        }
    }
    for (int k = 0; k < 10; ++k) { // puffs
        const double size = chance.between(4, 8);
        const Double3 at = chance.direction() * 24 + Double3{0, 0, 8};
        body.blob(at, {size, size * chance.between(0.6, 1), size}, chance.between(0.2, 0.9), 0, chance.between(-1, 1));
    }
    return v;
}

} // namespace clvr

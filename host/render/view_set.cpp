#include "host/render/view_set.hpp"
#include "host/volume/vec.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

/// Uniform in [0, 1): SplitMix64 (Steele, Lea, Flood 2014).
struct Uniform {
    std::uint64_t state;
    double operator()() {
        std::uint64_t z = state += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
};

} // namespace

std::vector<ViewPoint> view_set(int count, std::uint64_t seed, double zoom_low, double zoom_high) {
    constexpr double golden_turn = 0.61803398874989485, steepest = 80;
    const double spacing = std::sqrt(4 * pi / count); // [rad] between neighbours
    Uniform uniform{seed};
    const double offset = uniform();
    std::vector<ViewPoint> views;
    for (int i = 0; i < count; ++i) {
        const double height = 1 - (2 * i + 1.0) / count, turns = offset + i * golden_turn;
        double elevation = std::asin(height) + (uniform() - 0.5) * spacing;
        elevation = std::clamp(elevation * 180 / pi, -steepest, steepest);
        const double across = std::max(0.2, std::cos(elevation * pi / 180));
        double azimuth = 360 * (turns - std::floor(turns)) + (uniform() - 0.5) * spacing / across * 180 / pi;
        azimuth -= 360 * std::floor(azimuth / 360);
        views.push_back({azimuth, elevation, zoom_low + uniform() * (zoom_high - zoom_low)});
    }
    return views;
}

} // namespace clvr

#include "host/render/view_set.hpp"
#include "host/volume/vec.hpp"
#include "runtime/system/split_mix.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

std::vector<ViewPoint> view_set(int count, std::uint64_t seed, double zoom_low, double zoom_high) {
    constexpr double golden_turn = 0.61803398874989485, steepest = 80;
    const double spacing = std::sqrt(4 * pi / count); // [rad] between neighbours
    SplitMix64 numbers(seed);
    const double offset = numbers.uniform();
    std::vector<ViewPoint> views;
    for (int i = 0; i < count; ++i) {
        const double height = 1 - (2 * i + 1.0) / count, turns = offset + i * golden_turn;
        double elevation = std::asin(height) + (numbers.uniform() - 0.5) * spacing;
        elevation = std::clamp(elevation * 180 / pi, -steepest, steepest);
        const double across = std::max(0.2, std::cos(elevation * pi / 180));
        double azimuth = 360 * (turns - std::floor(turns)) + (numbers.uniform() - 0.5) * spacing / across * 180 / pi;
        azimuth -= 360 * std::floor(azimuth / 360);
        views.push_back({azimuth, elevation, zoom_low + numbers.uniform() * (zoom_high - zoom_low)});
    }
    return views;
}

} // namespace clvr

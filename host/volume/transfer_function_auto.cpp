#include "host/volume/srgb.hpp"
#include "host/volume/transfer_function.hpp"
#include "host/volume/value_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

using Color = std::array<double, 3>;
using Point = TransferFunction::Point;

/// A piecewise linear curve over 0..1: opacity, or a colour in sRGB.
template <class T>
using Stops = std::vector<std::pair<double, T>>;

double lerp(double a, double b, double t) { return std::fma(t, b - a, a); }
Color lerp(const Color& a, const Color& b, double t) { return {lerp(a[0], b[0], t), lerp(a[1], b[1], t), lerp(a[2], b[2], t)}; }

template <class T>
T at(const Stops<T>& stops, double t) {
    std::size_t next = 1;
    while (next + 1 < stops.size() && stops[next].first <= t) ++next;
    const auto& [t0, a] = stops[next - 1];
    const auto& [t1, b] = stops[next];
    return lerp(a, b, std::clamp((t - t0) / (t1 - t0), 0.0, 1.0));
}

// Tissue, bark, bone: reddish where it is thin or light, ivory where it is dense.
const Stops<Color> surface_colors{
    {0, {0.74, 0.28, 0.17}}, {0.3, {0.85, 0.53, 0.36}}, {0.6, {0.93, 0.80, 0.63}}, {0.85, {0.97, 0.93, 0.85}}, {1, {0.99, 0.98, 0.96}}};
// Fields that fade out: a cool haze around a glowing core.
const Stops<Color> field_colors{
    {0, {0.22, 0.42, 0.72}}, {0.3, {0.30, 0.68, 0.74}}, {0.55, {0.97, 0.80, 0.38}}, {0.8, {0.95, 0.45, 0.20}}, {1, {0.98, 0.90, 0.75}}};
// The other side of a field with signs.
const Stops<Color> below_colors{{0, {0.35, 0.45, 0.75}}, {0.5, {0.35, 0.60, 0.88}}, {1, {0.85, 0.93, 0.99}}};

const Stops<double> field_opacity{{0, 0}, {0.1, 0.02}, {0.3, 0.1}, {0.6, 0.4}, {1, 0.9}};

/// Points from the threshold of one side outward, over stored values. Colours follow half the value and half its rank, so that each hue
/// gets its share.
std::vector<Point> outward(const ValueSide& side, const Stops<Color>& colors) {
    constexpr int steps = 32;
    const double solid = std::clamp((side.solid - side.threshold) / (side.top - side.threshold), 1.0 / steps, 0.9);
    const Stops<double> surface_opacity{{0, 0}, {0.5 * solid, 0.06}, {solid, 0.5}, {1, 0.95}};
    std::vector<Point> points;
    for (int k = 0; k <= steps; ++k) {
        const double t = k / double(steps), rank = side.rank[std::size_t(k) * 64 / steps];
        Point p{lerp(side.threshold, side.top, t), at(colors, 0.5 * t + 0.5 * rank),
                at(side.surfaces ? surface_opacity : field_opacity, t)};
        for (double& c : p.color) c = srgb_decode(c);
        points.push_back(p);
    }
    return points;
}

} // namespace

TransferFunction automatic_transfer_function(const Voxels& v, const Histogram& h) {
    TransferFunction tf;
    tf.name = "auto";
    const ValueShape shape = value_shape(value_counts(v, h.low, h.high));
    if (shape.below.active) {
        tf.points = outward(shape.below, shape.above.active ? below_colors : shape.below.surfaces ? surface_colors : field_colors);
        std::reverse(tf.points.begin(), tf.points.end());
    }
    if (shape.above.active) {
        const std::vector<Point> above = outward(shape.above, shape.above.surfaces ? surface_colors : field_colors);
        tf.points.insert(tf.points.end(), above.begin(), above.end());
    }
    if (tf.points.empty()) tf.points = {{shape.low, {0.5, 0.5, 0.5}, 0.5}}; // one value everywhere
    for (Point& p : tf.points) p.value = v.slope * p.value + v.intercept;
    if (v.slope < 0) std::reverse(tf.points.begin(), tf.points.end());
    return tf;
}

} // namespace clvr

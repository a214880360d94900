#include "host/appearance/transfer_function.hpp"
#include "host/frame/srgb.hpp"
#include "host/volume/value_statistics.hpp"
#include "host/volume/vec.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

using Color = std::array<double, 3>;
using Point = TransferFunction::Point;

/// A piecewise linear curve over 0..1: opacity, or a colour in sRGB.
template <class T>
using Stops = std::vector<std::pair<double, T>>;

template <class T>
T at(const Stops<T>& stops, double t) {
    std::size_t next = 1;
    while (next + 1 < stops.size() && stops[next].first <= t) ++next;
    const auto& [t0, a] = stops[next - 1];
    const auto& [t1, b] = stops[next];
    return lerp(a, b, std::clamp((t - t0) / (t1 - t0), 0.0, 1.0));
}

// Albedos are lighter and paler than the colours that one sees: light that scatters several times is coloured several times.
// Skin, bark, pottery: reddish where it is thin or light, ivory where it is dense.
const Stops<Color> solid_colors{
    {0, {0.95, 0.77, 0.65}}, {0.25, {0.95, 0.79, 0.66}}, {0.5, {0.96, 0.87, 0.75}}, {0.8, {0.98, 0.95, 0.90}}, {1, {0.99, 0.98, 0.96}}};
// Vessels, and other things that were cut out of their surroundings.
const Stops<Color> cut_colors{{0, {0.92, 0.55, 0.47}}, {0.3, {0.94, 0.64, 0.54}}, {0.6, {0.96, 0.80, 0.68}}, {1, {0.98, 0.94, 0.88}}};
// Fields that fade out: a cool haze around a glowing core.
const Stops<Color> field_colors{
    {0, {0.48, 0.70, 0.93}}, {0.3, {0.50, 0.83, 0.84}}, {0.55, {0.99, 0.82, 0.44}}, {0.8, {0.97, 0.54, 0.30}}, {1, {0.99, 0.90, 0.74}}};
// The other side of a field with signs.
const Stops<Color> below_colors{{0, {0.62, 0.70, 0.95}}, {0.5, {0.60, 0.80, 0.97}}, {1, {0.92, 0.96, 0.99}}};

const Stops<double> field_opacity{{0, 0}, {0.1, 0.02}, {0.3, 0.1}, {0.6, 0.4}, {1, 0.9}};

/// What lies outside is solid and hides the rest.
Stops<double> solid_opacity(double solid) {
    return {{0, 0}, {0.4 * solid, 0.06}, {solid, 0.3}, {lerp(solid, 1, 0.35), 0.65}, {lerp(solid, 1, 0.75), 1}, {1, 1}};
}

/// A thin skin around clear flesh, around solid bone.
Stops<double> wrapped_opacity(double solid, double common, double dense) {
    const double clear = lerp(common, dense, 0.35);
    return {{0, 0},         {0.5 * solid, 0.05}, {lerp(solid, common, 0.5), 0.05}, {lerp(solid, common, 0.9), 0.02},
            {clear, 0.025}, {dense, 0.3},        {lerp(dense, 1, 0.35), 0.9},      {1, 1}};
}

Stops<Color> wrapped_colors(double common, double dense) {
    return {{0, {0.95, 0.72, 0.60}},
            {common, {0.94, 0.66, 0.56}},
            {lerp(common, dense, 0.4), {0.95, 0.72, 0.60}},
            {dense, {0.98, 0.93, 0.85}},
            {1, {0.99, 0.97, 0.93}}};
}

/// Points from the threshold of one side outward, over stored values.
std::vector<Point> outward(const Voxels& v, const ValueSide& side, const Stops<Color>& fading_colors) {
    const auto share = [&](double value) { return std::clamp((value - side.threshold) / (side.top - side.threshold), 0.01, 0.99); };
    const double solid = share(side.solid), common = share(side.common), dense = share(side.dense);
    const bool wrapped = side.surfaces && !side.cut && side.dense_share > 0.01 && side.dense_share < 0.4 && dense_outside(v, side) < 0.2;
    const Stops<double> opacity = wrapped ? wrapped_opacity(solid, common, dense) : side.surfaces ? solid_opacity(solid) : field_opacity;
    const Stops<Color> colors = wrapped         ? wrapped_colors(common, dense)
                                : side.cut      ? cut_colors
                                : side.surfaces ? solid_colors
                                                : fading_colors;
    std::vector<double> places; // of the opacities, and as many for the colours
    for (const auto& stop : opacity) places.push_back(stop.first);
    for (int k = 1; k < 16; ++k) places.push_back(k / 16.0);
    std::sort(places.begin(), places.end());
    std::vector<Point> points;
    for (double t : places) {
        // Where nothing tells materials apart, colours follow half the value and half its rank, so that each hue gets its share.
        const std::size_t k = std::min(static_cast<std::size_t>(64 * t), std::size_t{63});
        const double rank = lerp(side.rank[k], side.rank[k + 1], 64 * t - static_cast<double>(k));
        Point p{lerp(side.threshold, side.top, t), at(colors, wrapped ? t : 0.5 * t + 0.5 * rank), at(opacity, t)};
        for (double& c : p.color) c = srgb_decode(c);
        points.push_back(p);
    }
    return points;
}

/// Share of the voxels whose physical value lies in low..high.
double share_between(const Voxels& v, const ValueCounts& counts, double low, double high) {
    double inside = 0;
    for (std::size_t i = 0; i < counts.bins(); ++i) {
        const double value = v.slope * counts.value(double(i)) + v.intercept;
        if (value >= low && value <= high) inside += static_cast<double>(counts.all[i]);
    }
    return inside / static_cast<double>(v.count());
}

/// Whether the values are Hounsfield units of a body: air and fat, water, muscle are there with a valley between, and something dense.
bool hounsfield_units(const Voxels& v, const ValueCounts& counts) {
    if (!v.modality.empty() && v.modality != "CT") return false;
    const double body = share_between(v, counts, -200, 200), valley = share_between(v, counts, -700, -300);
    return body > 0.02 && valley < body && share_between(v, counts, -1e9, -850) > 0.02 && share_between(v, counts, 250, 1e9) > 0;
}

/// CT: a thin skin around clear flesh, contrast agent in red, bone in ivory.
TransferFunction body_transfer_function() {
    const Color skin{0.95, 0.74, 0.62}, flesh{0.94, 0.66, 0.56}, vessel{0.95, 0.60, 0.51}, bone{0.98, 0.93, 0.85}, enamel{0.99, 0.97, 0.93};
    TransferFunction tf;
    tf.points = {{-600, skin, 0},   {-450, skin, 0.03},  {-200, skin, 0.03},  {-120, flesh, 0.01}, {-20, flesh, 0.015}, {20, flesh, 0.05},
                 {90, flesh, 0.05}, {160, vessel, 0.08}, {220, vessel, 0.15}, {330, bone, 0.5},    {550, bone, 0.9},    {1600, enamel, 1}};
    for (Point& p : tf.points)
        for (double& c : p.color) c = srgb_decode(c);
    return tf;
}

} // namespace

TransferFunction automatic_transfer_function(const Voxels& v, const Histogram& h) {
    const ValueCounts counts = value_counts(v, h);
    TransferFunction tf;
    if (hounsfield_units(v, counts)) {
        tf = body_transfer_function();
        tf.name = "auto";
        return tf;
    }
    tf.name = "auto";
    const ValueShape shape = value_shape(counts);
    if (shape.below.active) {
        tf.points = outward(v, shape.below, shape.above.active ? below_colors : field_colors);
        std::reverse(tf.points.begin(), tf.points.end());
    }
    if (shape.above.active) {
        const std::vector<Point> above = outward(v, shape.above, field_colors);
        tf.points.insert(tf.points.end(), above.begin(), above.end());
    }
    if (tf.points.empty()) tf.points = {{shape.low, {0.5, 0.5, 0.5}, 0.5}}; // one value everywhere
    for (Point& p : tf.points) p.value = v.slope * p.value + v.intercept;
    if (v.slope < 0) std::reverse(tf.points.begin(), tf.points.end());
    return tf;
}

} // namespace clvr

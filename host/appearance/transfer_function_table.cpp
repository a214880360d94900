#include "host/appearance/transfer_function.hpp"
#include "host/volume/vec.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace clvr {

namespace {

/// The points over stored values, ascending.
std::vector<TransferFunction::Point> over_stored_values(const TransferFunction& tf, const Voxels& v, double low, double high) {
    std::vector<TransferFunction::Point> points = tf.points;
    const bool reversed = v.slope < 0;
    for (auto& p : points) {
        if (tf.normalized)
            p.value = reversed ? lerp(high, low, p.value) : lerp(low, high, p.value);
        else
            p.value = (p.value - v.intercept) / v.slope;
        if (!(std::fabs(p.value) <= std::numeric_limits<float>::max())) // the device's numbers
            throw Error(ErrorKind::input,
                        fmt::format("the transfer function lies outside what slope {} and intercept {} can reach", v.slope, v.intercept),
                        tf.name);
    }
    if (reversed) std::reverse(points.begin(), points.end());
    return points;
}

/// How far the visible values reach, in stored values: what the entries above 0 and their ramps cover.
double visible_width(const TransferTable& table, double low, double high) {
    const auto visible = [](float opacity) { return opacity > 0; };
    const auto first = std::find_if(table.opacity.begin(), table.opacity.end(), visible);
    if (first == table.opacity.end()) return 0;
    const auto last = std::find_if(table.opacity.rbegin(), table.opacity.rend(), visible).base() - 1;
    const double entry = (table.last - table.first) / (transfer_entries - 1);
    const double from = std::max(table.first + entry * (first - table.opacity.begin() - 1.0), table.first);
    const double to = std::min(table.first + entry * (last - table.opacity.begin() + 1.0), table.last);
    // Values beyond an end point can be visible, too. They count for whether anything is visible, not for the width.
    const bool below = table.opacity.front() > 0 && low<table.first, above = table.opacity.back()> 0 && high > table.last;
    return below || above || (from <= high && to >= low) ? to - from : 0;
}

} // namespace

TransferTable tabulate(const TransferFunction& tf, const Voxels& v, double low, double high) {
    validate(tf, tf.name);
    if (v.slope == 0 || !std::isfinite(v.slope) || !std::isfinite(v.intercept))
        throw Error(ErrorKind::input,
                    fmt::format("slope {} and intercept {}; expected finite numbers and a slope other than 0", v.slope, v.intercept),
                    v.source);
    const std::vector<TransferFunction::Point> points = over_stored_values(tf, v, low, high);

    TransferTable table;
    table.first = points.front().value;
    table.last = points.back().value;
    const double greatest = std::max(std::fabs(table.first), std::fabs(table.last)), magnitude = greatest > 0 ? greatest
                                                                                                 : high > low ? high - low
                                                                                                              : 1;
    const double scale = std::max(magnitude, 0x1p-90);                 // so that index_scale() is a finite float
    const bool one_value = table.last - table.first < scale * 0x1p-22; // a constant or one step, as far as float values can tell
    if (one_value) {
        table.first -= scale * 0x1p-17;
        table.last += scale * 0x1p-17;
    }
    table.opacity.resize(transfer_entries);
    table.color.resize(transfer_entries * 4);
    std::size_t next = 0; // first point above the entry's value
    for (int e = 0; e < transfer_entries; ++e) {
        const double x = lerp(table.first, table.last, e / (transfer_entries - 1.0));
        while (next < points.size() && points[next].value <= x) ++next;
        TransferFunction::Point here = points[next == 0 ? 0 : next - 1];
        if (next > 0 && next < points.size()) {
            const auto &a = points[next - 1], &b = points[next];
            const double t = (x - a.value) / (b.value - a.value);
            for (int c = 0; c < 3; ++c) here.color[c] = lerp(a.color[c], b.color[c], t);
            here.opacity = lerp(a.opacity, b.opacity, t);
        }
        if (e == 0) here = points.front(); // the value that holds outside: a step at an end lies inside the table
        if (e == transfer_entries - 1) here = points.back();
        table.opacity[e] = static_cast<float>(here.opacity);
        for (int c = 0; c < 3; ++c) table.color[4 * e + c] = static_cast<float>(here.color[c]);
    }
    table.visible_width = visible_width(table, low, high);
    if (one_value && table.visible_width > 0)
        table.visible_width = std::max(table.visible_width, high - low); // values that hold outside reach to the volume's ends
    return table;
}

} // namespace clvr

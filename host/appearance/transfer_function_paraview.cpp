#include "host/appearance/transfer_function_json.hpp"
#include "host/frame/srgb.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_fields.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace clvr {

using nlohmann::json;

namespace {

constexpr int pieces = 16; // straight ones that stand for a curve between two points

/// x^e for x >= 0, 0 <= e <= 64, out of products and square roots alone: the same bits everywhere, unlike pow().
double power(double x, double e) {
    double result = 1;
    for (int i = 0; i < static_cast<int>(e); ++i) result *= x;
    double root = x, fraction = e - std::floor(e);
    for (int bit = 0; bit < 52 && fraction > 0; ++bit) {
        root = std::sqrt(root);
        fraction *= 2;
        if (fraction >= 1) {
            result *= root;
            fraction -= 1;
        }
    }
    return result;
}

// All colour spaces end in linear RGB.
Double3 linear_from_srgb(const Double3& c) { return {srgb_decode(c[0]), srgb_decode(c[1]), srgb_decode(c[2])}; }

// CIE L*a*b* under D65, with the sRGB primaries (IEC 61966-2-1).
const Matrix3 xyz_from_linear{{{{0.4124, 0.3576, 0.1805}, {0.2126, 0.7152, 0.0722}, {0.0193, 0.1192, 0.9505}}}};
const Double3 white_xyz = xyz_from_linear * Double3{1, 1, 1};

Double3 lab_from_srgb(const Double3& c) {
    const Double3 xyz = xyz_from_linear * linear_from_srgb(c);
    Double3 f;
    for (int i = 0; i < 3; ++i) {
        const double t = xyz[i] / white_xyz[i];
        f[i] = t > 216.0 / 24389 ? power(t, 1.0 / 3) : (t * 24389 / 27 + 16) / 116;
    }
    return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

Double3 linear_from_lab(const Double3& lab) {
    static const Matrix3 linear_from_xyz = xyz_from_linear.inverse();
    const double y = (lab[0] + 16) / 116;
    Double3 xyz{y + lab[1] / 500, y, y - lab[2] / 200};
    for (int i = 0; i < 3; ++i) {
        const double f = xyz[i];
        xyz[i] = white_xyz[i] * (f > 6.0 / 29 ? f * f * f : (116 * f - 16) * 27 / 24389);
    }
    Double3 rgb = linear_from_xyz * xyz;
    for (double& x : rgb) x = std::clamp(x, 0.0, 1.0);
    return rgb;
}

/// Hue, saturation and value, each 0..1.
Double3 hsv_from_srgb(const Double3& c) {
    const double high = std::max({c[0], c[1], c[2]}), low = std::min({c[0], c[1], c[2]}), range = high - low;
    if (range == 0) return {0, 0, high};
    const int i = high == c[0] ? 0 : high == c[1] ? 1 : 2; // the greatest component starts the third of the circle
    const double hue = (2 * i + (c[(i + 1) % 3] - c[(i + 2) % 3]) / range) / 6;
    return {hue < 0 ? hue + 1 : hue, range / high, high};
}

Double3 linear_from_hsv(const Double3& hsv) {
    Double3 c;
    for (int i = 0; i < 3; ++i) {
        double away = hsv[0] - i / 3.0; // around the circle, -1/2..1/2
        away -= std::floor(away + 0.5);
        c[i] = hsv[2] * (1 - hsv[1] * std::clamp(6 * std::fabs(away) - 1, 0.0, 1.0));
    }
    return linear_from_srgb(c);
}

/// ParaView's rule for going through white: two saturated ends whose hues are more than 60 degrees apart.
bool through_white(const Double3& a, const Double3& b) {
    const double chroma_a = std::sqrt(a[1] * a[1] + a[2] * a[2]), chroma_b = std::sqrt(b[1] * b[1] + b[2] * b[2]);
    return chroma_a > 0.05 * norm(a) && chroma_b > 0.05 * norm(b) && a[1] * b[1] + a[2] * b[2] < 0.5 * chroma_a * chroma_b;
}

/// Colour at the share t of the way between two sRGB colours.
Double3 between(const std::string& space, const Double3& from, const Double3& to, double t) {
    if (space == "HSV" || space == "HSVNoWrap") {
        Double3 a = hsv_from_srgb(from), b = hsv_from_srgb(to);
        if (space == "HSV" && b[0] - a[0] > 0.5) a[0] += 1; // the short way round
        if (space == "HSV" && a[0] - b[0] > 0.5) b[0] += 1;
        return linear_from_hsv(lerp(a, b, t));
    }
    if (space == "Lab" || space == "Diverging") {
        const Double3 a = lab_from_srgb(from), b = lab_from_srgb(to);
        if (space == "Lab" || !through_white(a, b)) return linear_from_lab(lerp(a, b, t));
        const Double3 white{std::max({norm(a), norm(b), 88.0}), 0, 0};
        return linear_from_lab(t < 0.5 ? lerp(a, white, 2 * t) : lerp(white, b, 2 * t - 1));
    }
    return linear_from_srgb(lerp(from, to, t));
}

/// vtkPiecewiseFunction's curve between two nodes: `midpoint` is where the middle is reached, `sharpness` goes from linear (0) to a step
/// (1).
double opacity_between(double y0, double y1, double midpoint, double sharpness, double t) {
    double s = t < midpoint ? 0.5 * t / midpoint : midpoint < 1 ? 0.5 + 0.5 * (t - midpoint) / (1 - midpoint) : 1;
    if (sharpness > 0.99) return s < 0.5 ? y0 : y1;
    if (sharpness < 0.01) return lerp(y0, y1, s);
    const double exponent = 1 + 10 * sharpness;
    s = s < 0.5 ? 0.5 * power(2 * s, exponent) : 1 - 0.5 * power(2 - 2 * s, exponent);
    const double ss = s * s, sss = ss * s, slope = (1 - sharpness) * (y1 - y0);
    const double y = (2 * sss - 3 * ss + 1) * y0 + (3 * ss - 2 * sss) * y1 + (2 * sss - 3 * ss + s) * slope;
    return std::clamp(y, std::min(y0, y1), std::max(y0, y1));
}

/// A piecewise linear curve of N components; two knots at one place make a step.
template <std::size_t n>
struct Curve {
    struct Knot {
        double x;
        std::array<double, n> y;
    };
    std::vector<Knot> knots;

    /// Limit at x from the left or from the right; constant outside.
    std::array<double, n> limit(double x, bool from_right) const {
        const auto after = from_right ? std::upper_bound(knots.begin(), knots.end(), x, [](double a, const Knot& k) { return a < k.x; })
                                      : std::lower_bound(knots.begin(), knots.end(), x, [](const Knot& k, double a) { return k.x < a; });
        if (after == knots.begin()) return knots.front().y;
        if (after == knots.end()) return knots.back().y;
        const Knot &a = *(after - 1), &b = *after;
        std::array<double, n> y;
        for (std::size_t i = 0; i < n; ++i) y[i] = lerp(a.y[i], b.y[i], (x - a.x) / (b.x - a.x));
        return y;
    }
};

/// The numbers of a list whose length is a multiple of `step`, in rows of `step` that ascend in their first number.
template <std::size_t step>
std::vector<std::array<double, step>> rows(JsonFields& fields, const std::string& name) {
    const json& list = fields.required(name);
    if (!list.is_array() || list.empty() || list.size() % step != 0) fields.fail(name, fmt::format("a list of {} numbers a point", step));
    std::vector<std::array<double, step>> result(list.size() / step);
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (!list[i].is_number()) fields.fail(name, "numbers");
        result[i / step][i % step] = list[i].get<double>();
        if (i % step == 0 && i > 0 && result[i / step][0] < result[i / step - 1][0]) fields.fail(name, "points with ascending values");
        if (i % step != 0 && !(result[i / step][i % step] >= 0 && result[i / step][i % step] <= 1))
            fields.fail(name, "0..1 in all numbers but the values");
    }
    if (!std::isfinite(result.back()[0] - result.front()[0])) fields.fail(name, "values whose span is a finite number");
    return result;
}

Curve<3> color_curve(JsonFields& fields) {
    std::string space = "RGB";
    fields.choose<std::string>("ColorSpace", space,
                               {{"RGB", "RGB"},
                                {"HSV", "HSV"},
                                {"HSVNoWrap", "HSVNoWrap"},
                                {"Lab", "Lab"},
                                {"CIELAB", "Lab"},
                                {"Diverging", "Diverging"},
                                {"Step", "Step"}});
    const auto points = rows<4>(fields, "RGBPoints");
    const auto color = [&](std::size_t i) { return Double3{points[i][1], points[i][2], points[i][3]}; };
    Curve<3> curve{{{points[0][0], linear_from_srgb(color(0))}}};
    for (std::size_t i = 1; i < points.size(); ++i) {
        const double from = points[i - 1][0], to = points[i][0];
        if (space == "Step") // the whole interval has its right colour
            curve.knots.push_back({from, linear_from_srgb(color(i))});
        else
            for (int k = 1; k < pieces && from < to; ++k)
                curve.knots.push_back({lerp(from, to, k / double(pieces)), between(space, color(i - 1), color(i), k / double(pieces))});
        curve.knots.push_back({to, linear_from_srgb(color(i))});
    }
    return curve;
}

Curve<1> opacity_curve(JsonFields& fields, double low, double high) {
    if (!fields.has("Points")) return {{{low, {0}}, {high, {1}}}};
    const auto points = rows<4>(fields, "Points");
    Curve<1> curve{{{points[0][0], {points[0][1]}}}};
    for (std::size_t i = 1; i < points.size(); ++i) {
        const auto [from, y0, midpoint, sharpness] = points[i - 1];
        const double to = points[i][0], y1 = points[i][1];
        if (sharpness > 0.99) {
            curve.knots.push_back({lerp(from, to, midpoint), {y0}});
            curve.knots.push_back({lerp(from, to, midpoint), {y1}});
        } else if (sharpness < 0.01) {
            curve.knots.push_back({lerp(from, to, midpoint), {lerp(y0, y1, 0.5)}});
        } else {
            for (int k = 1; k < pieces && from < to; ++k)
                curve.knots.push_back(
                    {lerp(from, to, k / double(pieces)), {opacity_between(y0, y1, midpoint, sharpness, k / double(pieces))}});
        }
        curve.knots.push_back({to, {y1}});
    }
    return curve;
}

} // namespace

TransferFunction from_paraview_json(const json& file, const std::string& where) {
    if (file.is_array() && file.empty()) throw Error(ErrorKind::input, "is an empty list; expected a ParaView colour map", where);
    JsonFields fields(file.is_array() ? file[0] : file, where);
    TransferFunction tf;
    tf.name = where;
    fields.get("Name", tf.name);
    const Curve<3> colors = color_curve(fields);
    const double low = colors.knots.front().x, high = colors.knots.back().x;
    const Curve<1> opacities = opacity_curve(fields, low, high);
    tf.normalized = low == 0 && high == 1;

    std::vector<double> places;
    for (const auto& knot : colors.knots) places.push_back(knot.x);
    for (const auto& knot : opacities.knots) places.push_back(knot.x);
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    for (double x : places) {
        const TransferFunction::Point left{x, colors.limit(x, false), opacities.limit(x, false)[0]};
        const TransferFunction::Point right{x, colors.limit(x, true), opacities.limit(x, true)[0]};
        tf.points.push_back(left);
        if (left.color != right.color || left.opacity != right.opacity) tf.points.push_back(right);
    }
    return tf;
}

} // namespace clvr

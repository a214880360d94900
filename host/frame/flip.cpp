#include "host/frame/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clvr {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double pixels_per_degree = 0.7 * 3840 / 0.7 * pi / 180;

using Plane = std::vector<double>;
using Planes = std::array<Plane, 3>;
using Colour = std::array<double, 3>;

/// Taps at -radius .. radius.
using Taps = std::vector<double>;

template <class F>
Taps taps(double reach, F f) {
    const int radius = static_cast<int>(std::ceil(reach));
    Taps t;
    for (int k = -radius; k <= radius; ++k) t.push_back(f(static_cast<double>(k)));
    return t;
}

/// Sums to 1; `by_sign`: the positive taps to 1 and the negative ones to -1.
Taps normalised(Taps t, bool by_sign) {
    double positive = 0, negative = 0;
    for (const double v : t) (v > 0 ? positive : negative) += v;
    for (double& v : t) v /= by_sign ? (v > 0 ? positive : -negative) : positive + negative;
    return t;
}

/// Convolves rows with `x` and columns with `y`; pixels beyond the border repeat it.
Plane filtered(const Plane& p, int width, int height, const Taps& x, const Taps& y) {
    const auto w = static_cast<std::size_t>(width);
    const int x_radius = static_cast<int>(x.size() / 2), y_radius = static_cast<int>(y.size() / 2);
    Plane rows(p.size()), out(p.size()), line(w + 2 * x_radius); // a row with its border
    for (int r = 0; r < height; ++r) {
        const double* const from = &p[r * w];
        for (int c = -x_radius; c < width + x_radius; ++c) line[c + x_radius] = from[std::clamp(c, 0, width - 1)];
        for (std::size_t k = 0; k < x.size(); ++k)
            for (std::size_t c = 0; c < w; ++c) rows[r * w + c] += x[k] * line[c + k];
    }
    for (int r = 0; r < height; ++r)
        for (std::size_t k = 0; k < y.size(); ++k) {
            const double* const from = &rows[std::clamp(r + static_cast<int>(k) - y_radius, 0, height - 1) * w];
            for (std::size_t c = 0; c < w; ++c) out[r * w + c] += y[k] * from[c];
        }
    return out;
}

// Linear Rec. 709 to CIE XYZ over the white point that equal R G B give, so that grey is (Y, Y, Y).
constexpr double to_xyz[3][3] = {{0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};

Colour relative_xyz(const Colour& rgb) {
    Colour xyz{};
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) xyz[i] += to_xyz[i][k] * rgb[k];
        xyz[i] /= to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
    }
    return xyz;
}

Colour rgb_of_relative_xyz(const Colour& xyz) {
    // Cramer's rule on to_xyz.
    const auto& m = to_xyz;
    Colour v;
    for (int i = 0; i < 3; ++i) v[i] = xyz[i] * (m[i][0] + m[i][1] + m[i][2]);
    const auto det = [](const Colour& a, const Colour& b, const Colour& c) {
        return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1]);
    };
    const Colour r{m[0][0], m[1][0], m[2][0]}, g{m[0][1], m[1][1], m[2][1]}, b{m[0][2], m[1][2], m[2][2]};
    const double d = det(r, g, b);
    return {det(v, g, b) / d, det(r, v, b) / d, det(r, g, v) / d};
}

/// The linear opponent space Y Cx Cz, relative to white.
Colour opponent(const Colour& rgb) {
    const auto [x, y, z] = relative_xyz(rgb);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}
Colour rgb_of_opponent(const Colour& c) {
    const double y = (c[0] + 16) / 116;
    return rgb_of_relative_xyz({y + c[1] / 500, y, y - c[2] / 200});
}

/// CIE L*a*b* of linear RGB with the Hunt effect: chroma counts less in the dark.
Colour hunt_lab(const Colour& rgb) {
    Colour f = relative_xyz(rgb);
    constexpr double delta = 6.0 / 29;
    for (double& v : f) v = v > delta * delta * delta ? std::cbrt(v) : v / (3 * delta * delta) + 4.0 / 29;
    const double l = 116 * f[1] - 16;
    return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}

double hyab(const Colour& a, const Colour& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }

/// Contrast sensitivity of the channels Y Cx Cz as two Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees (table 1).
struct Sensitivity {
    double a1, b1, a2, b2;
};
constexpr Sensitivity sensitivities[3] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};

/// A channel as the eye resolves it: the sum of two separable Gaussians, normalised together.
Plane seen(const Plane& p, int width, int height, const Sensitivity& s) {
    const double reach = 3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree;
    Plane sum(p.size());
    double total = 0;
    for (const auto& [a, b] : {std::pair(s.a1, s.b1), {s.a2, s.b2}}) {
        if (a == 0) continue;
        const double exponent = b;
        const Taps g =
            taps(reach, [&](double k) { return std::exp(-pi * pi * k * k / (pixels_per_degree * pixels_per_degree * exponent)); });
        double row = 0;
        for (const double v : g) row += v;
        const double weight = a * std::sqrt(pi / b);
        const Plane part = filtered(p, width, height, g, g);
        for (std::size_t i = 0; i < p.size(); ++i) sum[i] += weight * part[i];
        total += weight * row * row;
    }
    for (double& v : sum) v /= total;
    return sum;
}

constexpr double colour_exponent = 0.7, knee_in = 0.4, knee_out = 0.95, feature_exponent = 0.5;

/// HyAB distances to 0..1: most of the range for the smaller ones.
double redistributed(double distance) {
    static const double greatest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), colour_exponent);
    const double d = std::pow(distance, colour_exponent), knee = knee_in * greatest;
    return d < knee ? knee_out / knee * d : knee_out + (d - knee) / (greatest - knee) * (1 - knee_out);
}

Planes opponent_planes(const Frame& frame) {
    Planes p;
    for (Plane& plane : p) plane.resize(frame.pixels());
    const std::vector<float>* rgb[3] = {&frame.at("R"), &frame.at("G"), &frame.at("B")};
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        Colour c;
        for (int k = 0; k < 3; ++k) c[k] = std::clamp(static_cast<double>((*rgb[k])[i]), 0.0, 1.0);
        c = opponent(c);
        for (int k = 0; k < 3; ++k) p[k][i] = c[k];
    }
    return p;
}

/// Colours as the eye resolves them, in the Hunt-adjusted L*a*b*.
std::vector<Colour> seen_colours(const Planes& planes, int width, int height) {
    Planes p;
    for (int k = 0; k < 3; ++k) p[k] = seen(planes[k], width, height, sensitivities[k]);
    std::vector<Colour> colours(p[0].size());
    for (std::size_t i = 0; i < colours.size(); ++i) {
        Colour rgb = rgb_of_opponent({p[0][i], p[1][i], p[2][i]});
        for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
        colours[i] = hunt_lab(rgb);
    }
    return colours;
}

/// Magnitudes of edges and of points in a picture's lightness.
std::pair<Plane, Plane> features(const Plane& y, int width, int height) {
    constexpr double degrees = 0.082, deviation = 0.5 * degrees * pixels_per_degree, variance = deviation * deviation;
    const auto gauss = [](double k) { return std::exp(-k * k / (2 * variance)); };
    const Taps smooth = normalised(taps(3 * deviation, gauss), false);
    const Taps edge = normalised(taps(3 * deviation, [&](double k) { return -k * gauss(k); }), true);
    const Taps point = normalised(taps(3 * deviation, [&](double k) { return (k * k / variance - 1) * gauss(k); }), true);
    Plane grey(y.size());
    std::transform(y.begin(), y.end(), grey.begin(), [](double v) { return (v + 16) / 116; });
    const auto magnitude = [&](const Taps& t) {
        Plane m = filtered(grey, width, height, t, smooth);
        const Plane vertical = filtered(grey, width, height, smooth, t);
        for (std::size_t i = 0; i < m.size(); ++i) m[i] = std::hypot(m[i], vertical[i]);
        return m;
    };
    return {magnitude(edge), magnitude(point)};
}

} // namespace

std::vector<double> flip_map(const Frame& image, const Frame& reference) {
    const int width = image.width, height = image.height;
    const Planes a = opponent_planes(image), b = opponent_planes(reference);
    const std::vector<Colour> seen_a = seen_colours(a, width, height), seen_b = seen_colours(b, width, height);
    const auto [edges_a, points_a] = features(a[0], width, height);
    const auto [edges_b, points_b] = features(b[0], width, height);
    std::vector<double> map(image.pixels());
    for (std::size_t i = 0; i < map.size(); ++i) {
        const double colour = redistributed(hyab(seen_a[i], seen_b[i]));
        const double change = std::max(std::abs(edges_a[i] - edges_b[i]), std::abs(points_a[i] - points_b[i]));
        map[i] = std::pow(colour, 1 - std::pow(change / std::sqrt(2.0), feature_exponent));
    }
    return map;
}

} // namespace clvr

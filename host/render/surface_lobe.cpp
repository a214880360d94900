#include "host/render/surface_lobe.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

constexpr double alpha = 0.3, reflectance = 0.04;
constexpr int intervals = 32, grid = 96;

double masking(double cosine) { return 2 * cosine / (cosine + std::sqrt(alpha * alpha + (1 - alpha * alpha) * cosine * cosine)); }

/// Mean of Fresnel times masking over reflections at visible normals: midpoints of a grid over the projected disc (Heitz 2018).
double directional_albedo(double mu) {
    const double ox = alpha * std::sqrt(1 - mu * mu), length = std::sqrt(ox * ox + mu * mu), vx = ox / length, vz = mu / length;
    double sum = 0;
    int inside = 0;
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const double x = (2 * i + 1.0) / grid - 1, y = (2 * j + 1.0) / grid - 1;
            if (x * x + y * y > 1) continue;
            ++inside;
            const double half_z = 0.5 * (1 + vz), q = half_z * y + (1 - half_z) * std::sqrt(1 - x * x);
            const double r = std::sqrt(std::max(0.0, 1 - x * x - q * q));
            // Frame (t1, t2, v) with t1 = (0, 1, 0), t2 = v x t1 = (-vz, 0, vx).
            double nx = alpha * (r * vx - q * vz), ny = alpha * x, nz = std::max(1e-6, r * vz + q * vx);
            const double s = 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
            nx *= s, nz *= s;
            const double out_x = std::sqrt(1 - mu * mu), cos_half = nx * out_x + nz * mu, in_z = 2 * cos_half * nz - mu;
            if (in_z <= 0) continue;
            const double m = 1 - std::clamp(cos_half, 0.0, 1.0), m2 = m * m;
            sum += (reflectance + (1 - reflectance) * m2 * m2 * m) * masking(in_z);
        }
    return sum / inside;
}

std::vector<float> make_table() {
    std::vector<double> e(intervals + 1);
    for (int k = 0; k <= intervals; ++k) e[k] = directional_albedo(std::max(1e-4, static_cast<double>(k) / intervals));
    double mean = 0; // exact for the piecewise linear table
    for (int k = 0; k < intervals; ++k) {
        const double a = static_cast<double>(k) / intervals, h = 1.0 / intervals;
        mean += 2 * h * (e[k] * (a / 2 + h / 6) + e[k + 1] * (a / 2 + h / 3));
    }
    std::vector<float> table(e.begin(), e.end());
    table.push_back(static_cast<float>(mean));
    return table;
}

} // namespace

const std::vector<float>& surface_lobe_table() {
    static const std::vector<float> table = make_table();
    return table;
}

} // namespace clvr

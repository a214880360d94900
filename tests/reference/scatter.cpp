#include "tests/reference/scatter.hpp"

namespace clvr::reference {

namespace {
constexpr double alpha2 = 0.3 * 0.3, reflectance = 0.04;

double masking(double cosine) { return 2 / (1 + std::sqrt(1 + alpha2 * (1 - cosine * cosine) / (cosine * cosine))); }
} // namespace

double phase_density(double g, double cosine) { return (1 - g * g) / (4 * pi * std::pow(1 + g * g - 2 * g * cosine, 1.5)); }

double phase_distribution(double g, double cosine) {
    if (g == 0) return (cosine + 1) / 2;
    return (1 - g * g) / (2 * g) * (1 / std::sqrt(1 + g * g - 2 * g * cosine) - 1 / (1 + g));
}

double phase_cosine(double g, double u) {
    if (g == 0) return 2 * u - 1;
    const double s = 1 / (1 / (1 + g) + u * 2 * g / (1 - g * g));
    return (1 + g * g - s * s) / (2 * g);
}

double glossy_value(const Double3& normal, const Double3& out, const Double3& in) {
    const double cos_out = inner(normal, out), cos_in = inner(normal, in);
    if (cos_out <= 0 || cos_in <= 0) return 0;
    const Double3 half = unit(out + in);
    const double cos_half = inner(normal, half), d = cos_half * cos_half * (alpha2 - 1) + 1;
    const double distribution = alpha2 / (pi * d * d), fresnel = reflectance + (1 - reflectance) * std::pow(1 - inner(half, in), 5);
    return distribution * fresnel * masking(cos_out) * masking(cos_in) / (4 * cos_out);
}

double glossy_albedo(double cosine) {
    const Double3 out{std::sqrt(1 - cosine * cosine), 0, cosine};
    constexpr int polar = 1000, around = 200; // midpoints; the integrand is even in the azimuth
    double sum = 0;
    for (int i = 0; i < polar; ++i) {
        const double theta = (i + 0.5) * pi / 2 / polar, s = std::sin(theta), c = std::cos(theta);
        for (int j = 0; j < around; ++j) {
            const double phi = (j + 0.5) * pi / around;
            sum += s * glossy_value({0, 0, 1}, out, {s * std::cos(phi), s * std::sin(phi), c});
        }
    }
    return sum * (pi / 2 / polar) * (2 * pi / around);
}

} // namespace clvr::reference

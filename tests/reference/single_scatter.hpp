// Light scattered once in a uniform box, by quadrature in double precision.
#pragma once
#include "host/volume/vec.hpp"
#include "tests/reference/quadrature.hpp"
#include "tests/reference/scatter.hpp"

namespace clvr::reference {

/// A uniform medium: world box [mm], extinction [1/mm], albedo.
struct UniformBox {
    Double3 low, high;
    double extinction, albedo;
};

/// Light from one direction: unit vector towards it, and the radiance that a collision would scatter into the ray if nothing were in the
/// way and the albedo 1.
struct Scattered {
    Double3 towards;
    double radiance;
};

/// Length of the way from a point inside along a unit direction to the border.
double way_out(const UniformBox& box, const Double3& from, const Double3& dir);

/// Radiance that a ray from outside gathers of light scattered exactly once: the sum over `lights`, the integral over its way inside by
/// `rule`.
double single_scatter(const UniformBox& box, const Double3& origin, const Double3& dir, const std::vector<Scattered>& lights,
                      const Quadrature& rule);

/// Light of radiance(towards) from the whole sphere, in directions that the phase function makes equally likely for a ray along `dir`.
template <class F>
std::vector<Scattered> scattered_everywhere(double g, const Double3& dir, F&& radiance, int rows = 96, int columns = 48) {
    const Double3 side = unit(cross(dir, std::abs(dir[2]) < 0.9 ? Double3{0, 0, 1} : Double3{1, 0, 0})), other = cross(dir, side);
    std::vector<Scattered> lights;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) {
            const double cosine = phase_cosine(g, (i + 0.5) / rows), sine = std::sqrt(1 - cosine * cosine),
                         azimuth = 2 * pi * (j + 0.5) / columns;
            const Double3 towards = dir * cosine + side * (sine * std::cos(azimuth)) + other * (sine * std::sin(azimuth));
            lights.push_back({towards, radiance(towards) / (rows * columns)});
        }
    return lights;
}

} // namespace clvr::reference

// Scattering in double precision, from the formulas that host/README.md, "Shading" names.
#pragma once
#include "host/volume/vec.hpp"

namespace clvr::reference {

/// Henyey-Greenstein density [1/sr] for the cosine between the directions of travel before and after.
double phase_density(double g, double cosine);
/// Its distribution function over the cosine: the chance of a smaller one.
double phase_distribution(double g, double cosine);
/// The cosine whose distribution function is u.
double phase_cosine(double g, double u);

/// The glossy lobe: GGX of roughness alpha 0.3, height-uncorrelated Smith masking, Schlick's reflectance of ior 1.5; times the cosine of
/// `in`. All unit vectors, `out` and `in` point away from the surface.
double glossy_value(const Double3& normal, const Double3& out, const Double3& in);
/// Its integral over the hemisphere of `in`, for the cosine of `out`.
double glossy_albedo(double cosine);

} // namespace clvr::reference

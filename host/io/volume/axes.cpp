#include "host/io/volume/axes.hpp"

#include <cmath>

namespace clvr {

namespace {

void set_column(Matrix3& m, int j, const Double3& v) {
    for (std::size_t i = 0; i < 3; ++i) m.row[i][static_cast<std::size_t>(j)] = v[i];
}

Double3 unit_axis(std::size_t i) {
    Double3 v{0, 0, 0};
    v[i] = 1;
    return v;
}

/// A unit vector perpendicular to v.
Double3 perpendicular(const Double3& v) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (std::abs(v[i]) < std::abs(v[least])) least = i;
    return unit(cross(v, unit_axis(least)));
}

} // namespace

void settle_axes(Geometry& g) {
    for (std::size_t j = 0; j < 3; ++j) {
        if (g.spacing[j] < 0) {
            g.spacing[j] = -g.spacing[j];
            for (auto& row : g.direction.row) row[j] = -row[j];
        }
        if (const double length = norm(g.direction.column(static_cast<int>(j)));
            length > 0 && std::isfinite(length) && std::abs(length - 1) > 1e-6) {
            g.spacing[j] *= length;
            for (auto& row : g.direction.row) row[j] /= length;
        }
    }
}

void complete_axes(Geometry& g, int given) {
    for (int j = given; j < 3; ++j) {
        g.spacing[static_cast<std::size_t>(j)] = 1;
        set_column(g.direction, j, unit_axis(static_cast<std::size_t>(j)));
    }
    if (given >= 3 || std::abs(g.direction.determinant()) >= 1e-3) return;
    if (given < 2) set_column(g.direction, 1, perpendicular(g.direction.column(0)));
    const Double3 normal = cross(g.direction.column(0), g.direction.column(1));
    if (norm(normal) > 0) set_column(g.direction, 2, unit(normal));
}

} // namespace clvr

#include "tests/reference/march.hpp"

#include <algorithm>

namespace clvr::reference {

namespace {

struct Interval {
    double low, high;
};

/// The part of a ray (index space, per mm) inside the clipped volume, not behind its origin.
Interval inside(const MarchScene& s, const Double3& origin, const Double3& dir_index, const Double3& eye_world, const Double3& dir_world) {
    Interval t{0, 1e30};
    for (int a = 0; a < 3; ++a) {
        if (dir_index[a] == 0) {
            if (origin[a] < s.box.low[a] || origin[a] > s.box.high[a]) return {0, 0};
            continue;
        }
        const double u = (s.box.low[a] - origin[a]) / dir_index[a], v = (s.box.high[a] - origin[a]) / dir_index[a];
        t = {std::max(t.low, std::min(u, v)), std::min(t.high, std::max(u, v))};
    }
    if (s.plane) { // inner(normal, x) <= offset stays
        const double slope = inner(s.plane->normal, dir_world), cut = (s.plane->offset - inner(s.plane->normal, eye_world)) / slope;
        if (slope > 0)
            t.high = std::min(t.high, cut);
        else
            t.low = std::max(t.low, cut);
    }
    return t;
}

/// Distances of the nearest and farthest point of the box's bounding sphere: along the view for an orthographic camera.
Interval depth_range(const MarchScene& s) {
    const Geometry& g = s.voxels->geometry;
    const Double3 centre = (g.to_world(s.box.low) + g.to_world(s.box.high)) * 0.5;
    double radius = 0;
    for (int k = 0; k < 8; ++k) {
        Double3 corner;
        for (int a = 0; a < 3; ++a) corner[a] = k >> a & 1 ? s.box.high[a] : s.box.low[a];
        radius = std::max(radius, norm(g.to_world(corner) - centre));
    }
    const double distance = s.view.orthographic ? inner(centre - s.view.eye, s.view.forward) : norm(centre - s.view.eye);
    return {std::max(0.0, distance - radius), distance + radius};
}

} // namespace

Features march_features(const MarchScene& s, int x, int y) {
    const Geometry& g = s.voxels->geometry;
    const Interval range = depth_range(s);
    const double columns[4] = {0.125, 0.625, 0.375, 0.875};
    double weight = 0, depth = 0, depth2 = 0, half_sum = 0;
    Double3 color{0, 0, 0}, normal{0, 0, 0};
    for (int ray = 0; ray < s.rays; ++ray) {
        const double px = s.rays == 1 ? 0.5 : columns[ray], py = s.rays == 1 ? 0.5 : (ray + 0.5) / 4;
        const Double3 shift = s.view.right * ((x + px) / s.width * 2 - 1) + s.view.up * (1 - (y + py) / s.height * 2);
        const Double3 eye = s.view.orthographic ? s.view.eye + shift : s.view.eye;
        const Double3 dir = s.view.orthographic ? s.view.forward : unit(s.view.forward + shift);
        const Double3 origin = g.to_index(eye), dir_index = g.index_to_world().inverse() * dir;
        const Interval way = inside(s, origin, dir_index, eye, dir);
        double transmitted = 1, half = 1;
        for (int k = 0; transmitted >= 1e-4; ++k) {
            const double t = way.low + (k + (ray + 0.5) / s.rays) * s.step;
            if (t >= way.high) break;
            const Double3 p = origin + dir_index * t;
            const Classified c = classify(*s.table, interpolate(*s.voxels, p));
            const double w = transmitted * (1 - std::exp(-c.opacity * s.extinction * s.step));
            if (!(w > 0)) continue;
            const double d = (t - range.low) / (range.high - range.low);
            const Double3 gradient = gradient_world(*s.voxels, p);
            const double steepness = norm(gradient);
            if (steepness > 0) normal = normal + gradient * ((inner(gradient, dir) > 0 ? -w : w) / steepness);
            color = color + Double3{c.color[0], c.color[1], c.color[2]} * w;
            weight += w, depth += w * d, depth2 += w * d * d;
            transmitted -= w;
            if (half == 1 && transmitted <= 0.5) half = d;
        }
        half_sum += half;
    }
    Features f;
    f.opacity = weight / s.rays;
    if (f.opacity < 1.0 / 256) return f;
    f.albedo = color * (1 / weight);
    f.normal = normal * (1 / weight);
    f.depth = depth / weight;
    f.deviation = std::sqrt(std::max(0.0, depth2 / weight - f.depth * f.depth));
    f.half_depth = half_sum / s.rays;
    return f;
}

} // namespace clvr::reference

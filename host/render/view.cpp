#include "host/render/view.hpp"

#include <algorithm>
#include <limits>

namespace clvr {

namespace {

constexpr double margin = 0.94; // share of the picture that a framed volume fills

Double3 from_direction(double azimuth, double elevation) {
    const double a = azimuth * radian, e = elevation * radian;
    return {std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e)};
}

/// Unit right and up of a view along `forward`. Looking along `up`, the world's +y (or -y from below) is up in the picture.
void aim(const Double3& forward, Double3 up, Double3& right, Double3& upward) {
    if (norm(cross(forward, up)) < 1e-9) up = {0, forward[2] < 0 ? 1.0 : -1.0, 0};
    right = unit(cross(forward, up));
    upward = cross(right, forward);
}

/// Extremes of the outline along one picture axis, at the slope t of the view's border: greatest x/t - z and -x/t - z.
struct Slack {
    double above = -std::numeric_limits<double>::infinity(), below = above;
    void add(double x, double z, double t) {
        above = std::max(above, x / t - z);
        below = std::max(below, -x / t - z);
    }
    double distance() const { return (above + below) / 2; } // with the best shift
    double shift(double t) const { return t * (above - below) / 2; }
    double centred() const { return std::max(above, below); } // without shift
};

} // namespace

Double3 centre_of(const std::vector<Double3>& points) {
    Double3 low = points.front(), high = low;
    for (const auto& p : points)
        for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
    return (low + high) * 0.5;
}

std::vector<Double3> visible_outline(const Geometry& geometry, const MajorantGrid& grid, const std::vector<float>& cell_majorants,
                                     const IndexBox& visible, const IndexBox& clip) {
    IndexBox box = clip;
    if (!visible.empty())
        for (int a = 0; a < 3; ++a) box.low[a] = std::max(box.low[a], visible.low[a]), box.high[a] = std::min(box.high[a], visible.high[a]);
    if (visible.empty() || box.low[0] >= box.high[0] || box.low[1] >= box.high[1] || box.low[2] >= box.high[2]) box = clip;

    std::vector<Double3> points;
    const auto add_corners = [&](const Double3& low, const Double3& high) {
        for (int k = 0; k < 8; ++k)
            points.push_back(geometry.to_world({k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]}));
    };
    const double edge = 1 << grid.log2_edge;
    std::size_t cell = 0;
    for (int z = 0; z < grid.cells[2]; ++z)
        for (int y = 0; y < grid.cells[1]; ++y)
            for (int x = 0; x < grid.cells[0]; ++x, ++cell) {
                if (!(cell_majorants[cell] > 0)) continue;
                const Int3 c{x, y, z};
                Double3 low, high;
                bool any = true;
                for (int a = 0; a < 3; ++a) {
                    low[a] = std::max(box.low[a], c[a] == 0 ? -0.5 : c[a] * edge);
                    high[a] = std::min(box.high[a], c[a] == grid.cells[a] - 1 ? box.high[a] : (c[a] + 1) * edge);
                    any &= low[a] < high[a];
                }
                if (any) add_corners(low, high);
            }
    if (points.empty()) add_corners(box.low, box.high);
    return points;
}

View resolve_view(const Scene& scene, const std::vector<Double3>& outline, bool steady) {
    const Camera& camera = scene.camera;
    const double aspect = static_cast<double>(scene.width) / scene.height;
    const double tan_y = std::tan(camera.fov / 2 * radian), tan_x = tan_y * aspect;
    View view;
    view.orthographic = camera.orthographic;
    Double3 right, up;
    double half_height = tan_y;

    if (camera.eye && camera.target) {
        view.eye = *camera.eye;
        view.forward = unit(*camera.target - *camera.eye);
        aim(view.forward, camera.up, right, up);
        if (camera.orthographic) half_height = camera.height > 0 ? camera.height / 2 : tan_y * norm(*camera.target - *camera.eye);
    } else {
        view.forward = from_direction(camera.azimuth, camera.elevation) * -1.0;
        aim(view.forward, camera.up, right, up);
        const Double3 centre = centre_of(outline);
        double reach = 0;
        for (const auto& p : outline) reach = std::max(reach, norm(p - centre));
        const double tx = tan_x * margin, ty = tan_y * margin;
        if (camera.orthographic) {
            Slack x, y;
            for (const auto& p : outline) x.add(inner(p - centre, right), 0, 1), y.add(inner(p - centre, up), 0, 1);
            half_height = steady ? reach / margin / std::min(1.0, aspect) : std::max(x.distance() / aspect, y.distance()) / margin;
            const Double3 target = steady ? centre : centre + right * x.shift(1) + up * y.shift(1);
            view.eye = target - view.forward * (2 * reach);
        } else if (steady) {
            double distance = 0;
            for (int azimuth = 0; azimuth < 360; azimuth += 5) {
                const Double3 f = from_direction(azimuth, camera.elevation) * -1.0;
                Double3 r, u;
                aim(f, camera.up, r, u);
                Slack x, y;
                for (const auto& p : outline)
                    x.add(inner(p - centre, r), inner(p - centre, f), tx), y.add(inner(p - centre, u), inner(p - centre, f), ty);
                distance = std::max({distance, x.centred(), y.centred()});
            }
            view.eye = centre - view.forward * distance;
        } else {
            Slack x, y;
            for (const auto& p : outline) {
                const double z = inner(p - centre, view.forward);
                x.add(inner(p - centre, right), z, tx), y.add(inner(p - centre, up), z, ty);
            }
            view.eye = centre + right * x.shift(tx) + up * y.shift(ty) - view.forward * std::max(x.distance(), y.distance());
        }
    }
    view.right = right * (half_height * aspect / camera.zoom);
    view.up = up * (half_height / camera.zoom);
    return view;
}

double view_azimuth(const View& view, double fallback) {
    if (std::abs(view.forward[0]) < 1e-9 && std::abs(view.forward[1]) < 1e-9) return fallback;
    return std::atan2(-view.forward[0], view.forward[1]) / radian;
}

} // namespace clvr

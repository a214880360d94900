#include "tests/reference/single_scatter.hpp"

#include <algorithm>
#include <limits>

namespace clvr::reference {

double way_out(const UniformBox& box, const Double3& from, const Double3& dir) {
    double t = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a)
        if (dir[a] != 0) t = std::min(t, ((dir[a] > 0 ? box.high[a] : box.low[a]) - from[a]) / dir[a]);
    return std::max(t, 0.0);
}

double single_scatter(const UniformBox& box, const Double3& origin, const Double3& dir, const std::vector<Scattered>& lights,
                      const Quadrature& rule) {
    double enters = 0;
    for (int a = 0; a < 3; ++a)
        if (dir[a] != 0) enters = std::max(enters, ((dir[a] > 0 ? box.low[a] : box.high[a]) - origin[a]) / dir[a]);
    const Double3 entry = origin + dir * enters;
    const double length = way_out(box, entry, dir);
    double sum = 0;
    for (const Node& node : rule) {
        const double t = node.at * length;
        const Double3 at = entry + dir * t;
        for (const Scattered& light : lights)
            sum += node.weight * light.radiance * std::exp(-box.extinction * (t + way_out(box, at, light.towards)));
    }
    return box.albedo * box.extinction * length * sum;
}

} // namespace clvr::reference

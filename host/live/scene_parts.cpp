#include "host/live/scene_parts.hpp"

#include <algorithm>
#include <tuple>

namespace clvr {
namespace {

bool same_points(const std::optional<TransferFunction>& a, const std::optional<TransferFunction>& b) {
    if (!a || !b) return !a && !b;
    return a->normalized == b->normalized &&
           std::equal(a->points.begin(), a->points.end(), b->points.begin(), b->points.end(), [](const auto& p, const auto& q) {
               return std::tie(p.value, p.color, p.opacity) == std::tie(q.value, q.color, q.opacity);
           });
}

bool same_plane(const std::optional<ClipPlane>& a, const std::optional<ClipPlane>& b) {
    if (!a || !b) return !a && !b;
    return std::tie(a->normal, a->offset) == std::tie(b->normal, b->offset);
}

auto all_of(const Camera& c) { return std::tie(c.orthographic, c.fov, c.azimuth, c.elevation, c.zoom, c.eye, c.target, c.up, c.height); }

auto all_of(const Light& l) {
    return std::tie(l.environment, l.level, l.image, l.image_rotation, l.key, l.key_azimuth, l.key_elevation, l.key_angle, l.headlight);
}

} // namespace

bool same(const Appearance& a, const Appearance& b) {
    return same_points(a.transfer, b.transfer) && same_plane(a.clip_plane, b.clip_plane) &&
           std::tie(a.shading, a.phase_g, a.extinction, a.clip_box) == std::tie(b.shading, b.phase_g, b.extinction, b.clip_box);
}

bool same(const Viewpoint& a, const Viewpoint& b) {
    return all_of(a.camera) == all_of(b.camera) && std::tie(a.bounces, a.seed, a.view) == std::tie(b.bounces, b.seed, b.view);
}

bool same(const Light& a, const Light& b) { return all_of(a) == all_of(b); }

bool same_size(const Scene& a, const Scene& b) { return a.width == b.width && a.height == b.height; }

bool same_environment(const Light& a, const Light& b) {
    if (a.environment != Light::Environment::image) return b.environment != Light::Environment::image;
    return std::tie(a.environment, a.image, a.level) == std::tie(b.environment, b.image, b.level);
}

bool same_samples(const Scene& a, const Scene& b) {
    if (a.mode != b.mode || (a.mode != Mode::path && a.feature_samples != b.feature_samples)) return false;
    return same_size(a, b) && same(static_cast<const Appearance&>(a), b) && same(static_cast<const Viewpoint&>(a), b) &&
           same(a.light, b.light);
}

} // namespace clvr

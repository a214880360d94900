// The framing of the camera.
#include "host/render/view.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace clvr {
namespace {

/// Corners of an oblique box, off the origin.
std::vector<Double3> corners() {
    Geometry g;
    g.origin = {30, -80, 12};
    g.spacing = {0.8, 1.7, 2.5};
    g.direction.row = {{{0.36, 0.48, -0.8}, {-0.8, 0.6, 0}, {0.48, 0.64, 0.6}}};
    std::vector<Double3> points;
    for (int k = 0; k < 8; ++k) points.push_back(g.to_world({k & 1 ? 90.0 : 0, k & 2 ? 60.0 : 0, k & 4 ? 30.0 : 0}));
    return points;
}

/// Picture coordinates, -1..1 from edge to edge; z: distance along the view.
Double3 projected(const View& v, const Double3& p) {
    const Double3 d = p - v.eye;
    const double z = v.orthographic ? 1 : inner(d, v.forward);
    return {inner(d, v.right) / inner(v.right, v.right) / z, inner(d, v.up) / inner(v.up, v.up) / z, inner(d, v.forward)};
}

struct Extent {
    double x = 0, y = 0, nearest = 1e30;
};
Extent extent(const View& v, const std::vector<Double3>& points) {
    Extent e;
    for (const Double3& p : points) {
        const Double3 at = projected(v, p);
        e = {std::max(e.x, std::abs(at[0])), std::max(e.y, std::abs(at[1])), std::min(e.nearest, at[2])};
    }
    return e;
}

Scene scene_from(double azimuth, double elevation, double fov, bool orthographic, int width, int height) {
    Scene s;
    s.width = width, s.height = height;
    s.camera.azimuth = azimuth, s.camera.elevation = elevation, s.camera.fov = fov, s.camera.orthographic = orthographic;
    return s;
}

TEST(View, FramesTheOutlineAsTightlyAsItsMarginAllows) {
    for (bool orthographic : {false, true})
        for (double azimuth : {0.0, 37.0, -120.0})
            for (double elevation : {-90.0, -30.0, 0.0, 55.0, 90.0})
                for (const auto& [width, height] : {std::pair(640, 640), {1000, 300}, {200, 900}}) {
                    const View v = resolve_view(scene_from(azimuth, elevation, 40, orthographic, width, height), corners(), false);
                    EXPECT_NEAR(norm(v.forward), 1, 1e-12);
                    EXPECT_NEAR(inner(v.right, v.up), 0, 1e-9 * norm(v.right) * norm(v.up));
                    EXPECT_NEAR(inner(v.right, v.forward), 0, 1e-9 * norm(v.right));
                    EXPECT_NEAR(norm(v.right) / norm(v.up), static_cast<double>(width) / height, 1e-9);
                    EXPECT_LT(inner(cross(v.right, v.up), v.forward), 0) << "right, up and the way back are right-handed";
                    const Extent e = extent(v, corners());
                    EXPECT_NEAR(std::max(e.x, e.y), 0.94, 1e-9) << azimuth << ", " << elevation;
                    EXPECT_GT(e.nearest, 0);
                }
}

TEST(View, ComesFromAzimuthAndElevation) {
    const auto forward = [](double azimuth, double elevation) {
        return resolve_view(scene_from(azimuth, elevation, 30, false, 64, 64), corners(), false).forward;
    };
    EXPECT_NEAR(norm(forward(0, 0) - Double3{0, 1, 0}), 0, 1e-12) << "a patient's face";
    EXPECT_NEAR(norm(forward(90, 0) - Double3{-1, 0, 0}), 0, 1e-12) << "from the patient's left";
    EXPECT_NEAR(norm(forward(0, 90) - Double3{0, 0, -1}), 0, 1e-12) << "from above";
    const View above = resolve_view(scene_from(0, 90, 30, false, 64, 64), corners(), false);
    EXPECT_NEAR(norm(unit(above.up) - Double3{0, 1, 0}), 0, 1e-6) << "the patient's back is up in a view from above";
    for (double azimuth : {-150.0, -20.0, 0.0, 75.0})
        EXPECT_NEAR(view_azimuth(resolve_view(scene_from(azimuth, 20, 30, false, 64, 64), corners(), false), 0), azimuth, 1e-9);
    EXPECT_EQ(view_azimuth(above, 12), 12);
}

TEST(View, SteadyOnesNeitherSwayNorBreathe) {
    for (bool orthographic : {false, true}) {
        double distance = 0, height = 0, widest = 0;
        Double3 axis{};
        for (int azimuth = 0; azimuth < 360; azimuth += 15) {
            const View v = resolve_view(scene_from(azimuth, 20, 40, orthographic, 320, 240), corners(), true);
            Double3 centre{0, 0, 0};
            Double3 low = corners()[0], high = low;
            for (const Double3& p : corners())
                for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
            centre = (low + high) * 0.5;
            const Double3 at = projected(v, centre);
            EXPECT_NEAR(at[0], 0, 1e-9);
            EXPECT_NEAR(at[1], 0, 1e-9);
            if (azimuth == 0) distance = at[2], height = norm(v.up), axis = centre;
            EXPECT_NEAR(at[2], distance, 1e-6);
            EXPECT_NEAR(norm(v.up), height, 1e-9);
            const Extent e = extent(v, corners());
            EXPECT_LE(std::max(e.x, e.y), 0.9401);
            widest = std::max({widest, e.x, e.y});
        }
        EXPECT_GT(widest, orthographic ? 0.5 : 0.9);
    }
}

TEST(View, ZoomEnlargesFromTheSamePlace) {
    Scene s = scene_from(30, 10, 40, false, 100, 100);
    const View whole = resolve_view(s, corners(), false);
    s.camera.zoom = 4;
    const View close = resolve_view(s, corners(), false);
    EXPECT_EQ(close.eye, whole.eye);
    EXPECT_NEAR(norm(close.up) * 4, norm(whole.up), 1e-12);
}

TEST(View, EyeAndTargetAreTaken) {
    Scene s = scene_from(0, 0, 60, false, 300, 100);
    s.camera.eye = Double3{1, 2, 3};
    s.camera.target = Double3{1, 2, 13};
    s.camera.up = {0, 1, 0};
    const View v = resolve_view(s, corners(), false);
    EXPECT_EQ(v.eye, *s.camera.eye);
    EXPECT_NEAR(norm(v.forward - Double3{0, 0, 1}), 0, 1e-12);
    EXPECT_NEAR(norm(v.up - Double3{0, std::tan(30 * radian), 0}), 0, 1e-12);
    EXPECT_NEAR(norm(v.right - Double3{-3 * std::tan(30 * radian), 0, 0}), 0, 1e-12);
    s.camera.orthographic = true;
    s.camera.height = 8;
    EXPECT_NEAR(norm(resolve_view(s, corners(), false).up - Double3{0, 4, 0}), 0, 1e-12);
}

TEST(Outline, IsMadeOfTheVisibleCells) {
    Geometry g;
    MajorantGrid grid;
    grid.cells = {3, 2, 1};
    std::vector<float> majorants(6, 0.0f);
    majorants[1] = 0.5f; // the middle cell of the lower row: x 16..32, y -0.5..16
    const IndexBox clip{{-0.5, -0.5, -0.5}, {47.5, 31.5, 15.5}}, visible{{10, 2, -0.5}, {40, 31.5, 15.5}};
    const auto span = [&](const std::vector<Double3>& points) {
        Double3 low = points.at(0), high = low;
        for (const Double3& p : points)
            for (int a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
        return std::pair(low, high);
    };
    EXPECT_EQ(span(visible_outline(g, grid, majorants, visible, clip)), std::pair(Double3{16, 2, -0.5}, Double3{32, 16, 15.5}));
    // Cut away, or invisible: what is left of the volume.
    const IndexBox corner{{40, 20, 0}, {47.5, 31.5, 15.5}};
    EXPECT_EQ(span(visible_outline(g, grid, majorants, visible, corner)), std::pair(corner.low, corner.high));
    EXPECT_EQ(span(visible_outline(g, grid, std::vector<float>(6, 0.0f), IndexBox{}, clip)), std::pair(clip.low, clip.high));
}

} // namespace
} // namespace clvr

// Scenes whose radiance or transmittance is known, and what it is.
#pragma once
#include "tests/reference/single_scatter.hpp"
#include "tests/render/scenes.hpp"

namespace clvr::testing {

/// A white furnace: whatever scatters, the picture is 1 everywhere.
inline void expect_furnace(const Voxels& v, const Scene& s, const EnvironmentTables& environment = {}) {
    const Frame f = render(v, s, environment);
    for (const char* c : {"R", "G", "B"}) expect_mean(f, c, 1);
    EXPECT_EQ(f.shown_alpha(), nullptr);
}

/// Box of 12 mm, white but for 0.8 in red, seen orthographically from `eye` towards its centre; one scattering.
struct BoxScene {
    static constexpr int side = 12;
    Voxels volume = constant_volume({side, side, side});
    Scene scene;
    EnvironmentTables environment;

    BoxScene(double optical_depth, double g, int spp, const Double3& from = {0, -1, 0}) {
        scene = plain_scene(24, spp);
        scene.transfer = uniform_transfer({0.8, 1, 1});
        scene.bounces = 1;
        scene.extinction = optical_depth / side;
        scene.phase_g = g;
        scene.camera.orthographic = true;
        scene.camera.target = centre();
        scene.camera.eye = centre() + from * 50.0;
        scene.camera.up = from[2] != 0 ? Double3{0, 1, 0} : Double3{0, 0, 1};
        scene.camera.height = 8;
    }
    static Double3 centre() { return Double3{1, 1, 1} * ((side - 1) / 2.0); }

    Double3 forward() const { return unit(*scene.camera.target - *scene.camera.eye); }
    reference::Scattered scattered(const Double3& towards, double irradiance) const {
        return {towards, irradiance * reference::phase_density(scene.phase_g, inner(forward(), towards))};
    }
    template <class F>
    std::vector<reference::Scattered> scattered_everywhere(F&& radiance) const {
        return reference::scattered_everywhere(scene.phase_g, forward(), radiance);
    }

    /// Mean of red over the picture by quadrature.
    double expected(const std::vector<reference::Scattered>& lights) const {
        const double low = -0.5, high = side - 0.5;
        const reference::UniformBox box{{low, low, low}, {high, high, high}, scene.extinction, 0.8};
        const View view = resolve_view(scene, {}, false);
        const bool smooth = lights.size() > 100; // the shadow borders of few lights are kinks
        const reference::Quadrature across = smooth ? reference::gauss(6) : reference::midpoints(40);
        const reference::Quadrature along = smooth ? reference::gauss(16) : reference::midpoints(100);
        double sum = 0;
        for (const reference::Node& x : across)
            for (const reference::Node& y : across) {
                const Double3 origin = view.eye + view.right * (2 * x.at - 1) + view.up * (2 * y.at - 1);
                sum += x.weight * y.weight * reference::single_scatter(box, origin, view.forward, lights, along);
            }
        return sum;
    }
    void expect(const std::vector<reference::Scattered>& lights) const {
        expect_mean(render(volume, scene, environment), "R", expected(lights), 2e-4);
    }
};

} // namespace clvr::testing

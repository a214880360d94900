// What a live view's pictures must be: those of a session of their own.
#pragma once
#include "host/io/model/model_file.hpp"
#include "host/live/session_painter.hpp"
#include "host/render/params.hpp"
#include "tests/render/several_devices.hpp"

#include <memory>

namespace clvr::testing {

inline std::shared_ptr<const PreparedVolume> wavy() {
    static const auto volume = std::make_shared<const PreparedVolume>(wavy_volume());
    return volume;
}

inline const Model& default_model() {
    static const Model model = read_model("default");
    return model;
}

inline EnvironmentTables no_environment(const Scene&) { throw Error(ErrorKind::internal, "there is none"); }

inline SessionPainter painter_of(const std::vector<Device>& devices = {shared_device()},
                                 const std::optional<Model>& model = default_model()) {
    return SessionPainter(devices, wavy(), model, no_environment);
}

/// As `clvr render --denoise` brings the scene (spp samples of it, where given) to a picture: `take` does so of the session.
template <class Take>
auto rendered(const PreparedVolume& volume, Scene scene, int spp, const std::optional<Model>& model, bool all, const Take& take,
              const EnvironmentTables& environment = {}) {
    if (!scene.transfer) scene.transfer = automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels));
    scene.extinction = resolved_extinction(scene, volume.voxels);
    if (spp > 0) scene.spp = spp;
    RenderSession session({shared_device()}, volume, scene, environment);
    Scene wanted = scene;
    wanted.features &= all;
    RenderControl control;
    control.light = all;
    Pipeline(scene.mode == Mode::path ? model : std::nullopt).run(session, wanted, control);
    return take(session, scene);
}

/// One that does not read the light features.
inline const Model& unlit_model() {
    static const Model model = read_model("color");
    return model;
}

/// To a PNG's.
inline DisplayPixels rendered(const Scene& scene, int spp = 0, const PreparedVolume& volume = *wavy(),
                              const std::optional<Model>& model = default_model(), const EnvironmentTables& environment = {}) {
    return rendered(
        volume, scene, spp, model, false,
        [](RenderSession& session, const Scene& s) {
            return session.picture(s.background, {s.tonemap, s.exposure}, true);
        },
        environment);
}

inline void expect_same(const DisplayPixels& a, const DisplayPixels& b) {
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.height, b.height);
    EXPECT_EQ(a.components, b.components);
    EXPECT_EQ(a.values, b.values);
}

inline const std::atomic<bool> never{false};

inline Painter::Drawn drawn(Painter& painter, const Painter::Draw& wanted) {
    std::optional<Painter::Drawn> got = painter.draw(wanted, never);
    if (!got) throw Error(ErrorKind::internal, "nothing was drawn");
    return *got;
}
inline Painter::Drawn in_full_size(Painter& painter, const Scene& scene, int samples) {
    return drawn(painter, {scene.width, scene.height, samples, false});
}
inline Painter::Drawn in_motion(Painter& painter, int width, int height) { return drawn(painter, {width, height, 1, true}); }

} // namespace clvr::testing

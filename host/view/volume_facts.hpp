// What a page is told of the volume and the camera.
#pragma once
#include "host/render/classified.hpp"
#include "host/render/scene.hpp"

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace clvr::view {

/// "volume" and "automatic" of messages: size, geometry, range and histogram, the transfer function of no choice. Of names only `name`: a
/// file's own texts may say who the patient is.
nlohmann::ordered_json volume_json(const PreparedVolume& volume, const std::string& name, int time_steps, int time_step);

/// A camera that stands somewhere.
struct PlacedCamera {
    Double3 eye, target, up;
    double fov, height; ///< height: of the view at the target [mm], before zoom
};
/// The scene's own, or as the volume is framed; that looks through the volume, and may take a while.
PlacedCamera placed_camera(const Scene& scene, const PreparedVolume& volume);
/// The scene with that camera in place of angles: as the page sends it.
Scene with_camera(Scene scene, const PlacedCamera& camera);
/// Turned by an angle [degrees] as azimuths grow: around the vertical (z) through its target.
PlacedCamera turned(PlacedCamera camera, double degrees);

} // namespace clvr::view

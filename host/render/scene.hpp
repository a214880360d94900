// Everything that decides a picture, besides the voxels: what a scene JSON holds.
#pragma once
#include "host/appearance/transfer_function.hpp"
#include "host/frame/tonemap.hpp"
#include "host/volume/vec.hpp"
#include "host/volume/volume_read_options.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace clvr {

enum class Mode { path, dvr, mip };
enum class Shading { automatic, phase, gradient };

/// Where the camera stands. Without eye/target it is framed to the visible part of the volume from azimuth and elevation.
struct Camera {
    bool orthographic = false;
    double fov = 30;                    ///< vertical field of view [degrees]; the framing distance follows from it
    double azimuth = 30;                ///< [degrees] around +z; 0 looks along +y (a patient's face), 90 from the patient's left (from +x)
    double elevation = 12;              ///< [degrees] above the horizontal plane, -90..90
    double zoom = 1;                    ///< > 1 enlarges (a narrower view from the same place)
    std::optional<Double3> eye, target; ///< world [mm]; both or neither
    Double3 up{0, 0, 1};
    double height = 0; ///< orthographic with eye/target: height of the view [mm]
};

struct Light {
    enum class Environment { constant, sky, image };
    Environment environment = Environment::sky;
    double level = 1;                             ///< radiance of the constant environment; factor for sky and image
    std::string image;                            ///< HDR latitude-longitude file (.hdr or .exr)
    double image_rotation = 0;                    ///< [degrees] around +z
    double key = 1;                               ///< strength of the soft key light relative to the default (0: none)
    double key_azimuth = -40, key_elevation = 45; ///< [degrees], azimuth relative to the camera's
    double key_angle = 10;                        ///< diameter of the key's disc [degrees]; 0: a directional light
    double headlight = 0;                         ///< irradiance of a directional light from the camera's direction
};

struct Background {
    enum class Kind { transparent, environment, color } kind = Kind::transparent;
    std::array<double, 3> color{0, 0, 0}; ///< linear RGB
};

/// Plane in world space: what lies on its positive side, inner(normal, x) > offset, is cut away.
struct ClipPlane {
    Double3 normal{0, 0, 1};
    double offset = 0; ///< [mm]
};

/// How values look: decides which bricks are needed and where light scatters.
struct Appearance {
    std::optional<TransferFunction> transfer; ///< absent: automatic
    Shading shading = Shading::automatic;
    double phase_g = 0;                            ///< Henyey-Greenstein asymmetry, -1 < g < 1
    double extinction = 0;                         ///< at opacity 1 [1/mm]; 0: automatic, 512 / diagonal of the volume
    std::optional<std::array<double, 6>> clip_box; ///< low xyz, high xyz as shares 0..1 of the volume along its index axes
    std::optional<ClipPlane> clip_plane;
};

/// From where the volume is seen, and by which random paths.
struct Viewpoint {
    Camera camera;
    int bounces = 8; ///< greatest number of scattering events; 0: unlimited
    std::uint64_t seed = 0;
    int view = 0; ///< turntable frame or view number: part of the random key
};

/// A scene is its parts: each may be handed alone to what takes only that part (RenderSession's setters).
struct Scene : Appearance, Viewpoint {
    std::string volume;        ///< file, folder or "demo:head"
    std::string volume_sha256; ///< of dims, type and decoded voxels; checked when a saved scene is rendered again (empty: unchecked)
    VolumeReadOptions reading; ///< how the volume's file is read
    Mode mode = Mode::path;
    int width = 640, height = 640; ///< [pixels]
    int spp = 64;                  ///< samples per pixel
    int feature_samples = 4;       ///< 1 or 4 feature rays per pixel
    bool features = true;          ///< march the noise-free features
    Light light;
    Background background;
    double exposure = 0;            ///< PNG only [stops]
    std::string tonemap = "filmic"; ///< PNG only: one of tonemap_names
};

/// The greatest width and height, and number of samples per pixel.
constexpr int largest_frame_side = 16384, largest_spp = 1 << 20;

/// Throws Error{usage} naming the first value out of its range (sizes, spp, g, fov, ...) as the option that sets it.
void validate(const Scene& scene);

} // namespace clvr

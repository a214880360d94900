// What draws a live view's pictures.
#pragma once
#include "host/frame/display_pixels.hpp"
#include "host/frame/frame.hpp"
#include "host/render/scene.hpp"
#include "host/render/session.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// Not for several threads at once: once a Loop has it, its render thread alone (Loop::run).
class Painter {
public:
    virtual ~Painter() = default;

    /// Touches only what differs from the scene before. False when the samples so far are of the new scene, too: it differs from the former
    /// in spp, exposure, tone curve and background at most. Throws Error for a scene that cannot be drawn; the former scene then stays.
    virtual bool set_scene(const Scene& scene) = 0;

    struct Draw {
        int width = 0, height = 0;
        int samples = 1;     ///< to reach, counted from 0; more are shown where more are there and the scene's spp allows them
        bool moving = false; ///< one feature ray a pixel, and a draft of the light
    };
    struct Drawn {
        DisplayPixels pixels;
        int samples = 0;
        double paths_ms = 0, rest_ms = 0; ///< features and samples; denoiser and the way to 8 bits
    };
    /// The scene's picture of that size. Absent when cancelled: the next call goes on with the samples of whole passes. Throws Error.
    virtual std::optional<Drawn> draw(const Draw& wanted, const std::atomic<bool>& cancelled) = 0;

    /// World position that the picture shows at shares 0..1 of its width and height (row 0 on top): where half of the light is gone. Absent
    /// where it shows the background.
    virtual std::optional<Double3> position_at(double x, double y) = 0;

    /// The picture of any scene of this volume as `clvr render` writes it to a PNG, denoised; goes on with the samples that are there where
    /// they are that scene's. set_scene's scene stays. Throws Error, {interrupted} when cancelled.
    virtual DisplayPixels still(const Scene& scene, const RenderControl& control) = 0;
    /// The same as it is written to an EXR file, with all channels but without attributes of its making. display_pixels() makes of it what
    /// is written to other files.
    virtual Frame frame(const Scene& scene, const RenderControl& control) = 0;

    /// The devices in use, for people.
    virtual std::string device() const = 0;
    /// What there is to say since the last call: nothing is visible, a device was lost.
    virtual std::vector<std::string> take_warnings() = 0;
};

} // namespace clvr

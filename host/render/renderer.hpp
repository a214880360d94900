// A scene and a volume to a frame, on one device or several: the same bits either way.
#pragma once
#include "host/frame/frame.hpp"
#include "host/render/environment.hpp"
#include "host/render/scene.hpp"
#include "host/render/sky_split.hpp"
#include "host/volume/bricks.hpp"
#include "runtime/dealer.hpp"
#include "runtime/device.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace clvr {

/// Where a rendering stands: share of the work done (0..1), samples per pixel reached.
struct RenderProgress {
    double done = 0;
    int samples = 0;
};

struct RenderControl {
    bool light = true;                                   ///< features have light.* channels (the others' bits do not depend on it)
    double seconds = 0;                                  ///< stop adding passes when they would end later than this; 0: no limit
    const std::atomic<bool>* cancelled = nullptr;        ///< set by Ctrl-C: the passes finished so far are the result
    std::function<void(const RenderProgress&)> progress; ///< called from the calling thread or a worker, now and then
};

/// The volume's part that no scene changes, computed once: majorant ranges.
struct PreparedVolume {
    Voxels voxels;
    MajorantGrid grid;
    explicit PreparedVolume(Voxels v) : voxels(std::move(v)), grid(majorant_grid(voxels)) {}
};

struct PixelSums;

class Renderer {
public:
    /// Classifies the volume, frames the camera, uploads to every device. A device that fails, now or while it renders, is left out with a
    /// warning, and the others do its work; the last one's failure is thrown. `volume` outlives the renderer. `environment` holds the
    /// tables of the scene's image (empty without one). `steady` frames for a turntable (resolve_view). Adds to `warnings()` when nothing
    /// is visible. Throws Error.
    Renderer(std::vector<Device> devices, const PreparedVolume& volume, const Scene& scene, const EnvironmentTables& environment = {},
             bool steady = false);
    ~Renderer();

    /// Turns to another camera and view number (part of the random key); volume and classification stay on the devices.
    void aim(const Camera& camera, int view);
    /// Turns to another frame of the scene: takes over camera, view number, seed, samples per pixel and whether features are marched,
    /// nothing else. The same bits as a renderer made for that scene.
    void turn_to(const Scene& scene);

    /// Renders the scene. `frame.attributes` gets "clvr.spp" (samples reached). Throws Error{interrupted} when cancelled before one pass
    /// was done.
    Frame render(const RenderControl& control = {});

    const std::vector<std::string>& warnings() const { return warnings_; }

    /// The devices that have not failed.
    std::vector<Device> devices() const;

private:
    struct Worker;
    Dealer dealer_;
    std::vector<std::unique_ptr<Worker>> workers_; // by device; null for one that failed at once
    std::mutex progress_;
    Scene scene_;
    const PreparedVolume& volume_;
    EnvironmentTables environment_;
    std::optional<SkySplit> sky_; // of the environment, once features were marched
    shared::RenderParams params_;
    bool steady_;
    std::vector<Double3> outline_; // of what is visible, world space
    std::uint32_t numbers_;        // pixel numbers, in 4x4 blocks
    std::vector<std::string> warnings_;

    void compare_devices();
    bool trace_pass(int first_sample, int samples, const PixelSums& before, PixelSums& after, const RenderControl& control);
    void trace(Frame& frame, const RenderControl& control);
    std::vector<Dealer::Portion> march_portions() const;
    void light_features();
    void march(Frame& frame, bool features, const RenderControl& control);
    void lay_background(Frame& frame);
};

} // namespace clvr

// A volume on one device or several, ready to be seen: what changes is set alone, samples are added where they stopped, and the picture
// stays on the device until somebody wants its pixels.
#pragma once
#include "host/appearance/environment.hpp"
#include "host/appearance/sky_split.hpp"
#include "host/frame/film.hpp"
#include "host/frame/frame.hpp"
#include "host/render/classified.hpp"
#include "host/render/display.hpp"
#include "host/render/marcher.hpp"
#include "host/render/path_tracer.hpp"
#include "host/render/scene.hpp"
#include "runtime/opencl/device.hpp"
#include "runtime/schedule/scheduler.hpp"

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
    bool draft = false;                                  ///< sky light that must be found anew may be coarse: for a picture in motion
    bool go_on = false;                                  ///< take() adds to the samples that are there
    double seconds = 0;                                  ///< stop adding passes when they would end later than this; 0: no limit
    const std::atomic<bool>* cancelled = nullptr;        ///< set by Ctrl-C: the passes finished so far are the result
    std::function<void(const RenderProgress&)> progress; ///< called from the calling thread or a worker, now and then
};

/// The same bits however samples are split into calls, whatever was set in between, on one device or several. A device that fails is left
/// out with a warning, and the others do its work; the last one's failure is thrown. Not for several threads at once.
class RenderSession {
public:
    explicit RenderSession(const std::vector<Device>& devices);
    /// With set_scene.
    RenderSession(const std::vector<Device>& devices, const PreparedVolume& volume, const Scene& scene,
                  const EnvironmentTables& environment = {}, bool steady = false);
    ~RenderSession();

    /// The setters, in this order the first time. Later each may be called alone: it writes only its own part to the devices, and the
    /// picture starts anew. They throw Error.
    /// The volume outlives the session.
    void set_volume(const PreparedVolume& volume);
    /// Uploads transfer table, majorants and those bricks that become visible.
    void set_appearance(const Appearance& appearance);
    /// `environment`: the tables of the light's image, empty without one.
    void set_lights(const Light& light, const EnvironmentTables& environment = {});
    void set_size(int width, int height);
    /// Writes less than 4 KiB. `steady` frames for a turntable (resolve_view).
    void set_view(const Viewpoint& view, bool steady = false);
    /// All of them. Throws Error{usage} for a scene that validate() refuses.
    void set_scene(const PreparedVolume& volume, const Scene& scene, const EnvironmentTables& environment = {}, bool steady = false);

    /// Drops the samples and the features.
    void restart();
    /// Adds so many samples to each pixel; returns how many there are: fewer than asked when cancelled or out of time, never part of a
    /// pass.
    int accumulate(int samples, const RenderControl& control = {});
    /// Marches the features (with light: and direct light) of the view, `rays` (1 or 4) a pixel, unless they are there. False when
    /// cancelled.
    bool march_features(int rays, const RenderControl& control = {});
    /// Marches R G B A, for Mode dvr or mip, in place of samples. False when cancelled.
    bool march_picture(Mode mode, int rays, const RenderControl& control = {});

    /// Samples (or rays of a march) per pixel of the picture.
    int samples() const { return samples_; }
    /// The picture on its device, with what was asked for so far; valid until the next call. It is the samples' mean again where a filter
    /// ran. Null where it is kept on the host: on several devices, or when it takes more than half of what the device has left.
    Film* film();
    /// Where film() is null: what a filter made of frame(), for frame() and picture() until the samples change.
    void set_filtered(Frame filtered);
    /// The picture on the host: one download; what a filter made of the film where one ran. Over `background`, with background.R/G/B,
    /// unless that is transparent. `beauty_alone`: without features, variances and the noisy picture.
    Frame frame(const Background& background = {}, bool beauty_alone = false);

    /// The same picture over the background as a display shows it. From the device come 4 bytes a pixel, where the picture is kept there.
    /// With `alpha` as for display_pixels.
    DisplayPixels picture(const Background& background, const Tonemap& tonemap, bool alpha);

    /// World position that the picture shows at shares 0..1 of its width and height (row 0 on top): where half of the light is gone, behind
    /// thin matter its mean depth. Absent where there is next to nothing, and before features were marched.
    std::optional<Double3> position_at(double x, double y);

    /// Composites R G B of this picture, and noisy.R G B beside it, over the background: C + (1 - A) B, with B in background.R/G/B.
    void lay_background(Frame& frame, const Background& background);

    /// What the last set_appearance has to say: that nothing is visible.
    const std::vector<std::string>& warnings() const { return warnings_; }
    /// The devices that have not failed.
    std::vector<Device> devices() const;

private:
    struct Marching;
    struct Worker;
    struct HostSums;
    Scheduler scheduler_;
    std::vector<std::unique_ptr<Worker>> workers_; // by device
    std::mutex progress_;
    const PreparedVolume* volume_ = nullptr;
    Scene scene_; // as set; of it no more than the parts that setters take
    Classified classified_;
    std::vector<Double3> outline_; // of what is visible, world space
    EnvironmentTables environment_;
    std::optional<SkySplit> sky_; // of the environment, once features were marched
    bool steady_ = false;
    std::vector<std::string> warnings_;

    shared::RenderParams params_; // of the view
    bool view_set_ = false;       // whether params_ are what was set, on every device
    std::uint32_t numbers_ = 0;   // pixel numbers, in 4x4 blocks

    int samples_ = 0, resolved_ = 0;       // of the picture; of those, in the planes
    bool traced_ = false;                  // the samples are paths, not a march's rays
    std::vector<std::string> marched_;     // features that are there
    int rays_ = 0;                         // a pixel, of the features
    bool draft_ = false;                   // the features' sky light is a draft
    std::unique_ptr<Film> film_;           // where the picture is kept on the device,
    std::optional<PixelSums> sums_, next_; // with the sums of whole passes, and of the pass that runs
    std::unique_ptr<HostSums> host_;       // else where it is kept on the host
    std::optional<Display> display_;       // of the film
    Buffer behind_;                        // the environment as the view shows it, for the display
    bool behind_set_ = false;

    void prepare_view();
    void prepare_light(bool draft);
    void prepare_picture();
    void compare_devices();
    bool trace_pass(int samples, int wanted, const RenderControl& control);
    bool march(March kind, int rays, bool lit, const RenderControl& control);
    std::vector<Scheduler::ChunkSize> march_chunk_sizes() const;
    void resolve();
    void drop_filtered();
    void see_environment(Worker& w, std::uint32_t first, std::uint32_t count, Buffer& out);
};

/// Brings a session to a scene of which it has set all but spp, mode and features: features when wanted, then samples (anew, or more of
/// them: RenderControl::go_on) or a march. Throws Error{interrupted} when cancelled before one pass was done.
void take(RenderSession& session, const Scene& scene, const RenderControl& control = {});
/// The same, and the frame over the scene's background. `frame.attributes` gets "clvr.spp" (samples reached).
Frame render(RenderSession& session, const Scene& scene, const RenderControl& control = {});
/// A session's whole life for one picture.
Frame render(const std::vector<Device>& devices, const PreparedVolume& volume, const Scene& scene,
             const EnvironmentTables& environment = {}, const RenderControl& control = {});

} // namespace clvr

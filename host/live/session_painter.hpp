// The painter of a live view: a RenderSession with its Pipeline.
#pragma once
#include "host/live/painter.hpp"
#include "host/render/pipeline.hpp"

#include <functional>
#include <memory>

namespace clvr {

/// What draw() shows of a scene at its full size and N samples, not `moving`, and still() with spp N, has the bits that
/// `clvr render --denoise --spp N` writes to a PNG, whatever was drawn before. One session draws it all: a picture of another scene or size
/// costs the samples that are there.
class SessionPainter final : public Painter {
public:
    using ReadEnvironment = std::function<EnvironmentTables(const Scene&)>;
    /// Without a model pictures are not denoised. `read_environment`: called for scenes with an environment image; may throw Error.
    SessionPainter(std::vector<Device> devices, std::shared_ptr<const PreparedVolume> volume, std::optional<Model> model,
                   ReadEnvironment read_environment);

    /// Another one in its place, such as the next time step. The scene is to be set again: its samples are gone.
    void set_volume(std::shared_ptr<const PreparedVolume> volume);

    bool set_scene(const Scene& scene) override;
    std::optional<Drawn> draw(const Draw& wanted, const std::atomic<bool>& cancelled) override;
    std::optional<Double3> position_at(double x, double y) override;
    DisplayPixels still(const Scene& scene, const RenderControl& control) override;
    Frame frame(const Scene& scene, const RenderControl& control) override;
    std::string device() const override;
    std::vector<std::string> take_warnings() override;

private:
    /// How the session's picture was made of its samples.
    struct Made {
        int samples, rays;
        bool features, lit, draft;
    };

    std::vector<Device> devices_; // those that have not failed
    std::shared_ptr<const PreparedVolume> volume_;
    std::optional<Model> model_;
    ReadEnvironment read_environment_;
    std::optional<TransferFunction> automatic_; // of the volume, once it was needed

    std::optional<Scene> asked_, scene_; // as set; the same, resolved
    bool anew_ = false;                  // whatever the next scene is: another volume
    int width_ = 0, height_ = 0;         // as drawn last

    std::unique_ptr<RenderSession> session_; // none before the first scene, and after a failure
    std::optional<Pipeline> pipeline_;       // always there
    std::optional<Scene> there_;             // what the session was given
    std::optional<Made> made_;               // none: there are but samples
    std::optional<Light> environment_of_;
    EnvironmentTables environment_;
    std::vector<std::string> warnings_, said_; // to be taken; by the session, of its appearance

    Scene resolved(const Scene& scene);
    void read_environment(const Scene& scene);
    template <class F>
    auto guarded(const Scene& scene, F&& f) -> decltype(f());
    void drop_session();
    void note_losses();
    void note_warnings();
    void bring(const Scene& scene);
    bool is_made(const Scene& scene, int most, const RenderControl& control) const;
    bool take(Scene scene, int most, RenderControl control);
    bool filter(const Scene& scene, int most, const RenderControl& control);
    void make(const Scene& scene, const RenderControl& control);
};

} // namespace clvr

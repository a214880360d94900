// A live view with its clients: who sees it, who controls it, what is saved of it.
#pragma once
#include "host/live/loop.hpp"
#include "host/view/jobs.hpp"
#include "host/view/picture_message.hpp"
#include "host/view/replies.hpp"
#include "host/view/saver.hpp"
#include "host/view/scene_form.hpp"
#include "host/view/server.hpp"
#include "host/view/worker.hpp"
#include "runtime/system/temporary.hpp"

#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>

namespace clvr::view {

using VolumePointer = std::shared_ptr<const PreparedVolume>;

struct ViewerSettings {
    Scene scene; ///< to begin with
    VolumePointer volume;
    std::string name; ///< of the volume, for people; names of saves begin with it
    std::string version;
    std::string output_dir; ///< saves are written there, too
    LoopSettings loop;
    int time_steps = 1;
    /// Reads another time step. Called by a thread of its own; may throw Error.
    std::function<VolumePointer(int step)> read_step;
    /// Gives it to the painter; on the render thread.
    std::function<void(Painter&, VolumePointer)> show_volume;
    std::function<void(Frame&, const Scene&)> provenance = [](Frame&, const Scene&) {};
};

/// Clients come and go; the scene, its pictures and the saves stay.
class Viewer final : public Handler {
public:
    /// All outlive the viewer. Throws Error: no temporary folder, a scene that cannot be framed.
    Viewer(const ViewerSettings& settings, Painter& painter, Clock& clock, Clients& clients);
    /// Cancels what runs.
    ~Viewer() override;

    void joined(ClientId client, Role wanted) override;
    void said(ClientId client, const ClientMessage& message) override;
    void left(ClientId client) override;
    std::optional<SavedFile> saved(const std::string& job, const std::string& name) override;
    std::string place_for_upload() override;
    void uploaded(const std::string& path, const std::string& name, std::function<void(Answer)> answer) override;
    void upload_failed(const std::string& path) override;

    /// For files that are gone with the viewer.
    const std::string& folder() const { return folder_.path(); }
    /// How long there has been no client and nothing to save [s].
    double idle_seconds() const;

private:
    struct Seat {
        bool paused = false;
    };
    /// A picture's full size, from this generation on.
    struct Size {
        std::uint64_t generation;
        int width, height;
    };

    const ViewerSettings settings_;
    Clients& clients_;
    const Greeting greeting_;
    Temporary folder_; // uploads and saves

    mutable std::mutex mutex_; // of what follows
    std::condition_variable shown_changed_;
    SceneForm form_;
    Scene scene_;
    PlacedCamera camera_;
    std::uint64_t generation_ = 1, shown_ = 0;
    std::vector<Size> sizes_;
    VolumePointer volume_;
    nlohmann::ordered_json volume_facts_;
    int step_ = 0;
    std::string device_;
    std::map<ClientId, Seat> seats_;
    std::optional<ClientId> controller_;
    std::shared_ptr<const EncodedPicture> last_picture_;
    int picks_ = 0, uploads_ = 0;
    bool uploading_ = false, ending_ = false;
    std::chrono::steady_clock::time_point last_seen_ = std::chrono::steady_clock::now();

    Jobs jobs_;
    NewestWorker<std::shared_ptr<const LivePicture>> encoder_;
    NewestWorker<int> reader_; // of time steps
    Worker worker_;
    std::unique_ptr<Loop> loop_;
    std::unique_ptr<Saver> saver_;

    void take(ClientId client, const SceneChange& message);
    void take(ClientId client, const Pause& message);
    void take(ClientId client, const TakeControl& message);
    void take(ClientId client, const Pick& message);
    void take(ClientId client, const TransferText& message);
    void take(ClientId client, const SceneText& message);
    void take(ClientId client, const TimeStep& message);
    void take(ClientId client, const Save& message);
    void take(ClientId client, const Cancel& message);
    void take(ClientId, const Hello&) {}
    void take(ClientId, const Ack&) {}

    template <class F>
    void refusing(ClientId client, std::uint64_t id, F&& f);
    bool controls(ClientId client) const;
    void require_control(ClientId client) const;
    void update_pause();
    SceneNews news() const;
    void tell_others(ClientId client, const std::string& text, const std::string& key);
    bool accept(ClientId client, const Scene& scene, const PlacedCamera& camera, std::optional<std::uint64_t> generation,
                std::optional<std::uint64_t> id);
    void place_and_accept(ClientId client, const Scene& scene, std::optional<std::uint64_t> generation, std::optional<std::uint64_t> id);
    void encode_and_show(const LivePicture& picture);
    void pictured(std::shared_ptr<const LivePicture> picture);
    void check_upload(const std::string& path, const std::string& name, const std::function<void(Answer)>& answer);
    void read_step(int step);
    void show_step(int step, const VolumePointer& volume);
    void save(const Job& job, const Save& message);
    Scene resolved(Scene scene) const;
    void keep_image(Scene& scene, const std::string& folder) const;
    void let_live_picture_go_on();
    void job_changed(const Job& job);
};

} // namespace clvr::view

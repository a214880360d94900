#include "host/pairs/rendering.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/io/scene/scene_file.hpp"
#include "host/io/settled_folder.hpp"
#include "host/pairs/folder.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <optional>

namespace clvr {

namespace fs = std::filesystem;

namespace {

/// The scene's frame; nothing when interrupted before it was complete.
std::optional<Frame> frame_of(RenderSession& session, const Scene& scene, const std::atomic<bool>& interrupted) {
    RenderControl control;
    control.cancelled = &interrupted;
    try {
        Frame frame = render(session, scene, control);
        if (std::stoi(frame.attributes.at(attribute::spp)) < scene.spp) return std::nullopt;
        frame.attributes[attribute::scene] = provenance_json(scene);
        frame.attributes[attribute::seed] = std::to_string(scene.seed);
        frame.attributes[attribute::volume_sha256] = scene.volume_sha256;
        return frame;
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::interrupted) return std::nullopt;
        throw;
    }
}

} // namespace

void begin_pairs_folder(const std::string& folder, const PairsPlan& plan) {
    begin_settled_folder(folder, "pairs.json", to_json(plan),
                         "holds pairs made with other settings; name another folder, or remove this one");
}

bool pairs_complete(const std::string& folder) {
    try {
        read_pairs(folder);
        return true;
    } catch (const Error&) {
        return false;
    }
}

int render_pairs(std::vector<Device>& devices, const PreparedVolume& volume, const EnvironmentTables& environment, const PairsPlan& plan,
                 const std::string& folder, const std::atomic<bool>& interrupted, const std::function<void(int)>& progress) {
    const int count = static_cast<int>(plan.views.size()), kinds = static_cast<int>(plan.scenes.size());
    int done = 0;
    for (int kind = 0; kind < kinds; ++kind) {
        std::optional<RenderSession> session; // one upload of the volume for all frames of a transfer function
        for (int v = kind; v < count; v += kinds) {
            for (int role = plan.reference_spp > 0 ? 0 : 1; role <= plan.noisy_frames; ++role) {
                const std::string path = (fs::path(folder) / (role == 0 ? reference_name(v) : noisy_name(v, role - 1))).string();
                if (fs::exists(path)) continue;
                if (interrupted) return done;
                const Scene scene = frame_scene(plan, v, role);
                if (session)
                    session->set_view(scene);
                else
                    session.emplace(devices, volume, scene, environment);
                progress(done);
                const std::optional<Frame> frame = frame_of(*session, scene, interrupted);
                if (!frame) return done;
                write_exr(*frame, path);
            }
            ++done;
        }
        if (session) devices = session->devices(); // without one that failed
    }
    return done;
}

} // namespace clvr

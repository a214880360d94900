// What a viewer does with each message.
#include "host/io/scene/scene_file.hpp"
#include "host/io/volume/volume_file.hpp"
#include "host/render/params.hpp"
#include "host/view/limits.hpp"
#include "host/view/viewer.hpp"
#include "runtime/system/atomic_file.hpp"

#include <cstring>
#include <filesystem>
#include <fmt/format.h>

namespace clvr::view {

namespace {

namespace fs = std::filesystem;

/// "bonsai" of "bonsai.nii.gz", "head" of "demo:head"; letters, digits and some signs that every file system takes.
std::string stem_of(const std::string& volume) {
    std::string stem = volume.substr(volume.find(':') == volume.npos ? 0 : volume.find(':') + 1);
    stem = stem.substr(0, stem.find('.', 1));
    for (char& c : stem)
        if (static_cast<unsigned char>(c) <= ' ' || std::strchr("/\\:*?\"<>|\x7f", c)) c = '_';
    return stem.empty() ? "volume" : stem;
}

std::string name_of_save(const std::string& volume, const Save& save) {
    switch (save.what) {
    case Product::still:
        return stem_of(volume) + "." + save.format;
    case Product::turntable:
        return stem_of(volume) + "_turntable.zip";
    case Product::scene:
        return stem_of(volume) + "_scene.json";
    case Product::transfer:
        return stem_of(volume) + "_transfer.json";
    }
    return {};
}

} // namespace

/// f(); an Error is the answer to that request.
template <class F>
void Viewer::refusing(ClientId client, std::uint64_t id, F&& f) {
    try {
        f();
    } catch (const Error& e) {
        clients_.send(client, refused_reply(id, e.line()));
    }
}

void Viewer::require_control(ClientId client) const {
    const std::lock_guard lock(mutex_);
    if (!controls(client)) throw Error(ErrorKind::usage, "Somebody else controls the view; take control first.");
}

void Viewer::take(ClientId client, const SceneChange& message) {
    try {
        require_control(client);
        Scene scene;
        VolumePointer volume;
        {
            const std::lock_guard lock(mutex_);
            scene = form_.from_page(message.scene), volume = volume_;
        }
        if (!scene.camera.eye) return place_and_accept(client, scene, message.generation, {});
        if (!accept(client, scene, placed_camera(scene, *volume), message.generation, {}))
            throw Error(ErrorKind::usage, "The scene is older than the one that is shown.");
    } catch (const Error& e) {
        clients_.send(client, refused_scene_reply(message.generation, e.line()));
    }
}

void Viewer::take(ClientId client, const Pause& message) {
    const std::lock_guard lock(mutex_);
    seats_[client].paused = message.paused;
    update_pause();
}

void Viewer::take(ClientId client, const TakeControl&) {
    const std::lock_guard lock(mutex_);
    if (controller_ && !controls(client)) clients_.send(*controller_, role_reply(Role::watch), "role");
    controller_ = client;
    clients_.send(client, role_reply(Role::control), "role");
}

void Viewer::take(ClientId client, const Pick& message) {
    constexpr int most_picks = 8; // that wait: each stops the picture for a while
    refusing(client, message.id, [&] {
        require_control(client);
        const std::lock_guard lock(mutex_);
        if (picks_ >= most_picks) throw Error(ErrorKind::usage, "Too many places are asked for at once.");
        ++picks_;
        loop_->run([=](Painter& painter) {
            {
                const std::lock_guard begun(mutex_);
                --picks_;
            }
            refusing(client, message.id,
                     [&] { clients_.send(client, picked_reply(message.id, painter.position_at(message.x, message.y))); });
        });
    });
}

void Viewer::take(ClientId client, const TransferText& message) {
    refusing(client, message.id, [&] {
        clients_.send(client, transfer_reply(message.id, to_json(parse_transfer_function(message.text, "transfer function"))));
    });
}

void Viewer::take(ClientId client, const SceneText& message) {
    refusing(client, message.id, [&] {
        require_control(client);
        std::vector<std::string> notes;
        Scene scene;
        {
            const std::lock_guard lock(mutex_);
            scene = form_.from_file(message.text, notes);
        }
        for (const std::string& note : notes) clients_.send(client, notice_reply("warning", note));
        place_and_accept(client, scene, {}, message.id);
    });
}

void Viewer::take(ClientId client, const TimeStep& message) {
    try {
        require_control(client);
        if (message.step < 0 || message.step >= settings_.time_steps)
            throw Error(ErrorKind::usage, fmt::format("There is no time step {}; the file has {}.", message.step, settings_.time_steps));
        reader_.put(message.step);
    } catch (const Error& e) {
        clients_.send(client, notice_reply("error", e.line()));
    }
}

void Viewer::take(ClientId client, const Cancel& message) {
    try {
        require_control(client);
        jobs_.cancel(message.job);
    } catch (const Error& e) {
        clients_.send(client, notice_reply("error", e.line()));
    }
}

// --- saves

void Viewer::take(ClientId client, const Save& message) {
    refusing(client, message.id, [&] {
        require_control(client);
        const Job job = jobs_.begin(message.what, name_of_save(settings_.name, message));
        clients_.send(client, job_reply(job, message.id));
        {
            const std::lock_guard lock(mutex_);
            tell_others(client, job_reply(job), "job " + job.id);
        }
        save(job, message);
    });
}

void Viewer::save(const Job& job, const Save& message) {
    Scene scene;
    PlacedCamera camera{};
    {
        const std::lock_guard lock(mutex_);
        scene = scene_, camera = camera_;
    }
    scene.width = message.width.value_or(scene.width), scene.height = message.height.value_or(scene.height);
    scene.spp = message.samples.value_or(scene.spp);
    switch (message.what) {
    case Product::still:
        return saver_->still(job, scene, message.format);
    case Product::turntable:
        return saver_->turntable(job, scene, camera, message.views);
    case Product::scene: {
        const auto made = std::make_shared<Scene>(scene);
        const auto write = [this, made](const std::string& path) {
            *made = resolved(std::move(*made));
            const std::lock_guard lock(mutex_);
            write_atomically(path, form_.to_file(*made));
        };
        return saver_->file(job, write, [this, made](const std::string& path) {
            keep_image(*made, fs::path(path).parent_path().string());
            write_scene(*made, path);
        });
    }
    case Product::transfer:
        return saver_->file(
            job, [this, scene](const std::string& path) { write_atomically(path, to_json(*resolved(scene).transfer) + "\n"); }, {});
    }
}

/// So that it does not depend on later defaults, and with the checksum of its voxels, as `clvr render --save-scene` writes it.
Scene Viewer::resolved(Scene scene) const {
    VolumePointer volume;
    {
        const std::lock_guard lock(mutex_);
        volume = volume_;
    }
    if (!scene.transfer) scene.transfer = automatic_transfer_function(volume->voxels, stored_histogram(volume->voxels));
    scene.extinction = resolved_extinction(scene, volume->voxels);
    if (scene.volume_sha256.empty()) scene.volume_sha256 = volume_sha256(volume->voxels);
    return scene;
}

/// An uploaded image goes into the folder, too: where it is now it does not stay.
void Viewer::keep_image(Scene& scene, const std::string& folder) const {
    if (fs::path(scene.light.image).parent_path() != folder_.path()) return;
    std::string kept;
    {
        const std::lock_guard lock(mutex_);
        kept = free_name(folder, form_.image_name(scene));
    }
    write_atomically(kept, read_text(scene.light.image, largest_upload));
    scene.light.image = kept;
}

} // namespace clvr::view

#include "host/view/viewer.hpp"
#include "host/io/picture/frame_file.hpp"
#include "host/live/caught.hpp"
#include "host/view/limits.hpp"
#include "host/view/net_text.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>

namespace clvr::view {

namespace {

Temporary temporary_folder() {
    const std::string parent = std::filesystem::temp_directory_path().string();
    remove_stale_folders(parent, "view");
    Temporary folder = Temporary::folder_in(parent, "view");
    if (folder.path().empty())
        throw Error(ErrorKind::input, fmt::format("no temporary folder can be made: {}", std::strerror(errno)), parent);
    return folder;
}

/// The last part of a path of any system, as one short line.
std::string clean_name(const std::string& name) {
    std::string clean = name.substr(std::min(name.find_last_of("/\\") + 1, name.size()));
    clean.erase(std::remove_if(clean.begin(), clean.end(), [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }),
                clean.end());
    return clean.empty() ? "image" : cut_utf8(clean, 100);
}

} // namespace

Viewer::Viewer(const ViewerSettings& settings, Painter& painter, Clock& clock, Clients& clients)
    : settings_(settings), clients_(clients), greeting_(settings.version), folder_(temporary_folder()), form_(settings.scene),
      scene_(settings.scene), camera_(placed_camera(scene_, *settings.volume)), sizes_{{generation_, scene_.width, scene_.height}},
      volume_(settings.volume), step_(scene_.reading.frame), device_(painter.device()), jobs_([this](const Job& job) { job_changed(job); }),
      encoder_([this](const std::shared_ptr<const LivePicture>& picture) { encode_and_show(*picture); }),
      reader_([this](int step) { read_step(step); }) {
    volume_facts_ = volume_json(*volume_, settings_.name, settings_.time_steps, step_);
    LoopSinks sinks;
    sinks.picture = [this](std::shared_ptr<const LivePicture> picture) { pictured(std::move(picture)); };
    sinks.failed = [this](std::uint64_t generation, const Error& error) {
        clients_.send_all(refused_scene_reply(generation, error.line()));
    };
    sinks.warned = [this, &painter](const std::string& warning) {
        const std::string device = painter.device();
        clients_.send_all(notice_reply("warning", warning));
        const std::lock_guard lock(mutex_);
        device_ = device;
    };
    loop_ = std::make_unique<Loop>(painter, clock, settings_.loop, std::move(sinks));
    loop_->pause(true); // until somebody looks
    loop_->post(scene_, generation_);
    saver_ = std::make_unique<Saver>(
        *loop_, worker_, jobs_,
        SaverSettings{folder_.path(), settings_.output_dir, settings_.provenance, [this] { let_live_picture_go_on(); }});
}

Viewer::~Viewer() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
        shown_changed_.notify_all();
    }
    jobs_.cancel_all();
    worker_.stop();
    reader_.stop();
    loop_.reset();
    encoder_.stop();
}

// --- clients

void Viewer::joined(ClientId client, Role wanted) {
    const std::lock_guard lock(mutex_);
    seats_[client] = {};
    if (wanted == Role::control && !controller_) controller_ = client;
    clients_.send(client, greeting_.hello(controls(client) ? Role::control : Role::watch, device_, news(), volume_facts_, jobs_.all()));
    clients_.send_all(clients_reply(seats_.size()), "clients");
    if (last_picture_) clients_.show(client, last_picture_);
    update_pause();
}

void Viewer::left(ClientId client) {
    const std::lock_guard lock(mutex_);
    seats_.erase(client);
    if (controls(client)) controller_.reset();
    last_seen_ = std::chrono::steady_clock::now();
    clients_.send_all(clients_reply(seats_.size()), "clients");
    update_pause();
}

void Viewer::said(ClientId client, const ClientMessage& message) {
    std::visit([&](const auto& m) { take(client, m); }, message);
}

bool Viewer::controls(ClientId client) const { return controller_ == client; }

/// Nobody looks while every page is hidden.
void Viewer::update_pause() {
    loop_->pause(std::all_of(seats_.begin(), seats_.end(), [](const auto& seat) { return seat.second.paused; }));
    shown_changed_.notify_all();
}

double Viewer::idle_seconds() const {
    const std::lock_guard lock(mutex_);
    if (!seats_.empty() || jobs_.busy()) return 0;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - last_seen_).count();
}

void Viewer::tell_others(ClientId client, const std::string& text, const std::string& key) {
    for (const auto& [other, seat] : seats_)
        if (other != client) clients_.send(other, text, key);
}

// --- scenes

SceneNews Viewer::news() const { return {generation_, form_.to_page(scene_), camera_}; }

/// Shows the scene; others hear of it, and the client too where it has an `id`. Without a generation it gets the next one. False, and
/// nothing happens, when it is older than the scene that is shown.
bool Viewer::accept(ClientId client, const Scene& scene, const PlacedCamera& camera, std::optional<std::uint64_t> generation,
                    std::optional<std::uint64_t> id) {
    const std::lock_guard lock(mutex_);
    if (generation && *generation < generation_) return false;
    generation_ = generation.value_or(generation_ + 1);
    scene_ = scene, camera_ = camera;
    if (sizes_.back().width != scene.width || sizes_.back().height != scene.height)
        sizes_.push_back({generation_, scene.width, scene.height});
    loop_->post(scene_, generation_);
    if (id) clients_.send(client, scene_reply(news(), id));
    if (seats_.size() > seats_.count(client)) tell_others(client, scene_reply(news()), "scene");
    return true;
}

/// The same of a scene whose camera has to be found, which may take a while.
void Viewer::place_and_accept(ClientId client, const Scene& scene, std::optional<std::uint64_t> generation,
                              std::optional<std::uint64_t> id) {
    worker_.add([=] {
        VolumePointer volume;
        {
            const std::lock_guard lock(mutex_);
            volume = volume_;
        }
        try {
            accept(client, scene, placed_camera(scene, *volume), generation, id);
        } catch (...) {
            const std::string words = caught_error().line();
            clients_.send(client, id ? refused_reply(*id, words) : refused_scene_reply(*generation, words));
        }
    });
}

// --- pictures

/// From the render thread.
void Viewer::pictured(std::shared_ptr<const LivePicture> picture) {
    {
        const std::lock_guard lock(mutex_);
        shown_ = picture->generation;
        shown_changed_.notify_all();
    }
    encoder_.put(std::move(picture));
}

/// From the encoder's thread: once for all clients.
void Viewer::encode_and_show(const LivePicture& picture) try {
    Size size{};
    {
        const std::lock_guard lock(mutex_);
        while (sizes_.size() > 1 && sizes_[1].generation <= picture.generation) sizes_.erase(sizes_.begin());
        size = sizes_.front();
    }
    const auto encoded = std::make_shared<const EncodedPicture>(encode(picture, size.width, size.height));
    const std::lock_guard lock(mutex_);
    last_picture_ = encoded;
    clients_.show_all(encoded);
} catch (...) {
    clients_.send_all(notice_reply("error", "A picture cannot be sent: " + caught_error().line()));
}

void Viewer::let_live_picture_go_on() {
    std::unique_lock lock(mutex_);
    shown_changed_.wait_for(lock, std::chrono::seconds(1), [&] {
        const bool seen = std::any_of(seats_.begin(), seats_.end(), [](const auto& seat) { return !seat.second.paused; });
        return ending_ || !seen || shown_ >= generation_;
    });
}

// --- files

std::optional<SavedFile> Viewer::saved(const std::string& job, const std::string& name) {
    const std::string path = jobs_.file(job, name);
    return path.empty() ? std::nullopt : std::optional(SavedFile{path, name});
}

std::string Viewer::place_for_upload() {
    const std::lock_guard lock(mutex_);
    if (!controller_ || std::exchange(uploading_, true)) return {};
    return folder_.path() + "/image-" + std::to_string(++uploads_);
}

void Viewer::upload_failed(const std::string& path) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    const std::lock_guard lock(mutex_);
    uploading_ = false;
}

void Viewer::uploaded(const std::string& path, const std::string& name, std::function<void(Answer)> answer) {
    worker_.add([=] { check_upload(path, clean_name(name), answer); });
}

void Viewer::check_upload(const std::string& path, const std::string& name, const std::function<void(Answer)>& answer) {
    try {
        read_environment_image(path);
    } catch (const Error& e) {
        upload_failed(path);
        return answer({415, name + " " + e.what()}); // without the path that it has here
    } catch (...) {
        upload_failed(path);
        return answer({415, name + ": " + caught_error().line()});
    }
    std::string handle;
    {
        const std::lock_guard lock(mutex_);
        handle = form_.add_image(path, name);
        std::error_code ignored;
        for (const std::string& old : form_.drop_images(most_uploads, scene_)) std::filesystem::remove(old, ignored);
        uploading_ = false;
    }
    answer({200, nlohmann::json{{"environment", handle}, {"name", name}}.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)});
}

void Viewer::job_changed(const Job& job) {
    clients_.send_all(job_reply(job), "job " + job.id);
    const std::lock_guard lock(mutex_);
    last_seen_ = std::chrono::steady_clock::now();
}

// --- time steps

/// From the reader's thread.
void Viewer::read_step(int step) {
    try {
        show_step(step, settings_.read_step(step));
    } catch (...) {
        clients_.send_all(notice_reply("error", "Time step " + std::to_string(step) + ": " + caught_error().line()));
    }
}

void Viewer::show_step(int step, const VolumePointer& volume) {
    nlohmann::ordered_json facts = volume_json(*volume, settings_.name, settings_.time_steps, step);
    const std::lock_guard lock(mutex_);
    if (ending_) return;
    loop_->run([this, volume](Painter& painter) { settings_.show_volume(painter, volume); });
    volume_ = volume, volume_facts_ = std::move(facts), step_ = step;
    form_.set_frame(step);
    scene_.reading.frame = step;
    scene_.volume_sha256.clear(); // it was another step's
    loop_->post(scene_, ++generation_);
    clients_.send_all(volume_reply(volume_facts_), "volume");
    clients_.send_all(scene_reply(news()), "scene");
}

} // namespace clvr::view

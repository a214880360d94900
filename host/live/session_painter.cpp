#include "host/live/session_painter.hpp"
#include "host/denoise/channels.hpp"
#include "host/live/scene_parts.hpp"
#include "host/render/params.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace clvr {
namespace {

using Steady = std::chrono::steady_clock;

double ms_between(Steady::time_point from, Steady::time_point to) { return std::chrono::duration<double, std::milli>(to - from).count(); }

/// Calls f(). False when it was cancelled.
template <class F>
bool unless_interrupted(const F& f) {
    try {
        f();
        return true;
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::interrupted) throw;
        return false;
    }
}

Tonemap tonemap_of(const Scene& scene) { return {scene.tonemap, scene.exposure}; }

} // namespace

SessionPainter::SessionPainter(std::vector<Device> devices, std::shared_ptr<const PreparedVolume> volume, std::optional<Model> model,
                               ReadEnvironment read_environment)
    : devices_(std::move(devices)), volume_(std::move(volume)), model_(std::move(model)), read_environment_(std::move(read_environment)),
      pipeline_(model_) {}

/// A scene that does not depend on defaults, as `clvr render` makes it.
Scene SessionPainter::resolved(const Scene& scene) {
    validate(scene);
    const ToneCurve known(tonemap_of(scene)); // or it throws
    Scene s = scene;
    if (!s.transfer) {
        if (!automatic_) automatic_ = automatic_transfer_function(volume_->voxels, stored_histogram(volume_->voxels));
        s.transfer = automatic_;
    }
    s.extinction = resolved_extinction(s, volume_->voxels);
    return s;
}

void SessionPainter::read_environment(const Scene& scene) {
    if (environment_of_ && same_environment(*environment_of_, scene.light)) return;
    environment_of_.reset();
    environment_ = scene.light.environment == Light::Environment::image ? read_environment_(scene) : EnvironmentTables{};
    environment_of_ = scene.light;
}

/// f(), with the scene's environment at hand. What fails leaves a session in pieces: the next picture begins with a new one.
template <class F>
auto SessionPainter::guarded(const Scene& scene, F&& f) -> decltype(f()) {
    read_environment(scene);
    try {
        return f();
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::interrupted) drop_session();
        throw;
    } catch (...) {
        drop_session();
        throw;
    }
}

void SessionPainter::drop_session() {
    note_losses();
    session_.reset(), there_.reset(), made_.reset();
    pipeline_.emplace(model_);
}

void SessionPainter::note_losses() {
    if (!session_) return;
    std::vector<Device> left;
    try {
        left = session_->devices();
    } catch (const Error&) { // none is left: that was thrown, and the next picture tries them again
        return;
    }
    for (const Device& device : devices_)
        if (std::none_of(left.begin(), left.end(), [&](const Device& other) { return is_same(device, other); }))
            warnings_.push_back(display_name(device.facts()) + " failed and is left out");
    devices_ = std::move(left);
}

/// What the session says of an appearance is said once, until it is something else.
void SessionPainter::note_warnings() {
    const std::vector<std::string>& now = session_->warnings();
    if (now != said_) warnings_.insert(warnings_.end(), now.begin(), now.end());
    said_ = now;
}

void SessionPainter::set_volume(std::shared_ptr<const PreparedVolume> volume) {
    note_losses();
    session_.reset(), there_.reset(), made_.reset();
    volume_ = std::move(volume);
    automatic_.reset();
    if (asked_) scene_ = resolved(*asked_);
    anew_ = true;
}

bool SessionPainter::set_scene(const Scene& scene) {
    const Scene next = resolved(scene);
    const bool kept = !anew_ && scene_ && same_samples(*scene_, next);
    if (!kept) {
        Scene sized = next; // the size is the next picture's own
        if (there_) sized.width = there_->width, sized.height = there_->height;
        guarded(next, [&] { bring(sized); });
    }
    scene_ = next, asked_ = scene, anew_ = false;
    return !kept;
}

/// Gives the session what differs of the scene, alone.
void SessionPainter::bring(const Scene& scene) {
    if (!session_) {
        session_ = std::make_unique<RenderSession>(devices_, *volume_, scene, environment_);
        note_warnings();
    } else if (!same_samples(*there_, scene)) {
        made_.reset();
        session_->restart(); // also where it is the mode alone
        if (!same_size(*there_, scene)) session_->set_size(scene.width, scene.height);
        if (!same(static_cast<const Appearance&>(*there_), scene)) {
            session_->set_appearance(scene);
            note_warnings();
        }
        if (!same(there_->light, scene.light)) session_->set_lights(scene.light, environment_);
        if (!same(static_cast<const Viewpoint&>(*there_), scene)) session_->set_view(scene);
    }
    there_ = scene;
}

/// Whether the session's picture is the scene's as it stands. `most`: samples that it may have.
bool SessionPainter::is_made(const Scene& scene, int most, const RenderControl& control) const {
    if (!made_ || made_->samples != session_->samples()) return false;
    if (scene.mode == Mode::path && (made_->samples < scene.spp || made_->samples > most)) return false;
    if (made_->rays != scene.feature_samples || (made_->draft && !control.draft)) return false;
    return (made_->features || !scene.features) && (made_->lit || !control.light);
}

/// Adds to what the session has of the scene what its picture is made of. False when cancelled.
bool SessionPainter::take(Scene scene, int most, RenderControl control) {
    if (is_made(scene, most, control)) return true;
    made_.reset();
    const bool path = scene.mode == Mode::path;
    if (path && session_->samples() > most) session_->restart();
    scene.spp = std::max(0, scene.spp - session_->samples());
    control.go_on = true;
    const bool done = unless_interrupted([&] {
        if (path)
            pipeline_->take(*session_, scene, control);
        else
            clvr::take(*session_, scene, control);
    });
    return done && !(control.cancelled && *control.cancelled);
}

/// Makes the picture of it. False when cancelled.
bool SessionPainter::filter(const Scene& scene, int most, const RenderControl& control) {
    if (is_made(scene, most, control)) return true;
    if (scene.mode == Mode::path && !unless_interrupted([&] { pipeline_->filter(*session_, control.cancelled); })) return false;
    made_ = Made{session_->samples(), scene.feature_samples, scene.features, control.light, control.draft};
    return true;
}

std::optional<Painter::Drawn> SessionPainter::draw(const Draw& wanted, const std::atomic<bool>& cancelled) {
    if (!scene_) throw Error(ErrorKind::internal, "there is no scene yet", "SessionPainter::draw");
    Scene scene = *scene_;
    scene.width = width_ = wanted.width, scene.height = height_ = wanted.height;
    scene.spp = wanted.samples;
    scene.features = false; // but where the model reads them
    if (wanted.moving) scene.feature_samples = 1;
    const int most = std::max(wanted.samples, scene_->spp);
    RenderControl control;
    control.light = false; // as for the features
    control.draft = wanted.moving;
    control.cancelled = &cancelled;
    return guarded(scene, [&]() -> std::optional<Drawn> {
        const auto start = Steady::now();
        bring(scene);
        if (!take(scene, most, control)) return std::nullopt;
        const auto taken = Steady::now();
        if (!filter(scene, most, control)) return std::nullopt;
        Drawn drawn{session_->picture(scene.background, tonemap_of(scene), true), session_->samples(), ms_between(start, taken), 0};
        drawn.rest_ms = ms_between(taken, Steady::now());
        return drawn;
    });
}

std::optional<Double3> SessionPainter::position_at(double x, double y) {
    if (!scene_) return std::nullopt;
    Scene scene = *scene_;
    if (width_ > 0) scene.width = width_, scene.height = height_;
    return guarded(scene, [&] {
        if (there_ && same_samples(*there_, scene)) scene = *there_; // with its rays
        bring(scene);
        const bool read = model_ && scene.mode == Mode::path; // by the model: those of the picture
        RenderControl control;
        control.light = read && reads_light(*model_);
        control.draft = true;
        session_->march_features(read ? scene.feature_samples : 1, control);
        return session_->position_at(x, y);
    });
}

/// The picture of a scene that is resolved, at its size.
void SessionPainter::make(const Scene& scene, const RenderControl& control) {
    bring(scene);
    if (!take(scene, scene.spp, control) || !filter(scene, scene.spp, control))
        throw Error(ErrorKind::interrupted, "the picture was cancelled");
}

DisplayPixels SessionPainter::still(const Scene& wanted, const RenderControl& given) {
    Scene scene = resolved(wanted);
    scene.features = false; // but where the model reads them
    RenderControl control = given;
    control.light = control.draft = false;
    return guarded(scene, [&] {
        make(scene, control);
        return session_->picture(scene.background, tonemap_of(scene), true);
    });
}

Frame SessionPainter::frame(const Scene& wanted, const RenderControl& given) {
    const Scene scene = resolved(wanted);
    RenderControl control = given;
    control.light = true, control.draft = false;
    return guarded(scene, [&] {
        const bool read = model_ && scene.mode == Mode::path;                         // features, by the model: the frame has them anyway
        if (session_ && !scene.features && !read) session_->restart(), made_.reset(); // or it had those of a position_at()
        make(scene, control);
        return session_->frame(scene.background);
    });
}

std::string SessionPainter::device() const {
    std::string names;
    for (const Device& device : devices_) names += (names.empty() ? "" : " + ") + device.facts().name;
    return names;
}

std::vector<std::string> SessionPainter::take_warnings() {
    note_losses();
    return std::exchange(warnings_, {});
}

} // namespace clvr

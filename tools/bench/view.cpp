#include "tools/bench/view.hpp"
#include "host/live/session_painter.hpp"
#include "host/view/token.hpp"
#include "host/view/viewer.hpp"
#include "host/view/volume_facts.hpp"
#include "tools/bench/statistics.hpp"
#include "tools/bench/view_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <mutex>
#include <thread>
#include <unistd.h>

namespace clvr::bench {
namespace {

/// A picture's times [s], as steady_seconds().
struct Made {
    double begin = 0, end = 0, session = 0; ///< session: scene and picture
};

/// Passes everything on and notes when pictures are made. The loop numbers what draw() returns from 1.
class TimedPainter final : public Painter {
public:
    explicit TimedPainter(Painter& painter) : painter_(painter) {}

    bool set_scene(const Scene& scene) override {
        const double start = steady_seconds();
        const bool kept = painter_.set_scene(scene);
        scene_s_ += steady_seconds() - start;
        return kept;
    }
    std::optional<Drawn> draw(const Draw& wanted, const std::atomic<bool>& cancelled) override {
        const double begin = steady_seconds();
        std::optional<Drawn> drawn = painter_.draw(wanted, cancelled);
        if (!drawn) return drawn;
        const std::lock_guard lock(mutex_);
        const double end = steady_seconds();
        made_[++pictures_] = {begin, end, end - begin + std::exchange(scene_s_, 0)};
        if (made_.size() > 1000) made_.erase(made_.begin());
        return drawn;
    }
    std::optional<Double3> position_at(double x, double y) override { return painter_.position_at(x, y); }
    DisplayPixels still(const Scene& scene, const RenderControl& control) override { return painter_.still(scene, control); }
    Frame frame(const Scene& scene, const RenderControl& control) override { return painter_.frame(scene, control); }
    std::string device() const override { return painter_.device(); }
    std::vector<std::string> take_warnings() override { return painter_.take_warnings(); }

    Made made(std::uint32_t number) const {
        const std::lock_guard lock(mutex_);
        return made_.at(number);
    }

private:
    Painter& painter_;
    mutable std::mutex mutex_;
    std::map<std::uint32_t, Made> made_;
    std::uint32_t pictures_ = 0;
    double scene_s_ = 0; // since the last picture
};

double resident_mb() {
    double all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// What the user does: each step is a scene sent.
class Hand {
public:
    Hand(ViewClient& client, const Scene& scene, const PreparedVolume& volume)
        : client_(client), scene_(scene), form_(scene), camera_(view::placed_camera(scene, volume)) {
        if (!scene_.transfer) scene_.transfer = automatic_transfer_function(volume.voxels, stored_histogram(volume.voxels));
    }
    void set_size(int width, int height) { scene_.width = width, scene_.height = height; }
    std::uint64_t turn() {
        camera_ = view::turned(camera_, 3);
        return send();
    }
    std::uint64_t edit() {
        scene_.transfer->points.back().color[0] = ++edits_ % 2 ? 0.8 : 0.9;
        return send();
    }
    /// The first picture of that scene or a later one.
    ViewPicture picture_of(std::uint64_t generation) {
        for (;;)
            if (const ViewPicture p = client_.next_picture(); p.generation >= generation) return p;
    }

private:
    ViewClient& client_;
    Scene scene_;
    view::SceneForm form_;
    view::PlacedCamera camera_;
    int edits_ = 0;

    std::uint64_t send() { return client_.send_scene(form_.to_page(view::with_camera(scene_, camera_))); }
};

double ms_since(double start, double end) { return 1000 * (end - start); }

/// Two scenes are on their way at any time, so that drawing and delivery overlap as they do under a moving mouse. The first pictures, until
/// the divider is found, do not count.
ViewRow turn_window(Hand& hand, const TimedPainter& painter, int width, int height, double seconds) {
    hand.set_size(width, height);
    std::uint64_t sent = hand.turn(), seen = 0;
    std::vector<double> session, frame, delivery, bytes;
    ViewRow row{width, height};
    constexpr int warming_up = 8;
    double begin = 0, last = 0;
    for (int k = 0; k < warming_up + 3 || last - begin < seconds; ++k) {
        const ViewPicture p = hand.picture_of(seen + 1);
        seen = p.generation;
        while (sent < seen + 2) sent = hand.turn();
        if (k == warming_up) begin = p.at;
        if (k > warming_up) {
            const Made made = painter.made(p.number);
            session.push_back(1000 * made.session), frame.push_back(ms_since(last, p.at));
            delivery.push_back(ms_since(made.end, p.at)), bytes.push_back(static_cast<double>(p.bytes));
            row.divider = p.divider;
        }
        last = p.at;
    }
    row.pictures = static_cast<int>(frame.size());
    row.per_second = row.pictures / (last - begin);
    row.session_ms = median(session), row.frame_ms = median(frame), row.delivery_ms = median(delivery), row.bytes = median(bytes);
    hand.picture_of(sent);
    return row;
}

/// From letting go to the first picture in full size.
double release(Hand& hand) {
    for (int k = 0; k < 3; ++k) hand.picture_of(hand.turn());
    const double start = steady_seconds();
    const std::uint64_t last = hand.turn();
    for (;;)
        if (const ViewPicture p = hand.picture_of(last); p.width == p.full_width) return ms_since(start, p.at);
}

/// From a scene that comes while a picture settles to the next picture, and to the moment when that is begun. `share`: 0..1, how far into
/// 400 ms after the first picture in full size the scene comes.
std::pair<double, double> interrupt(Hand& hand, const TimedPainter& painter, double share) {
    release(hand);
    std::this_thread::sleep_for(std::chrono::duration<double>(0.4 * share));
    const double start = steady_seconds();
    const ViewPicture p = hand.picture_of(hand.turn());
    return {ms_since(start, p.at), ms_since(start, painter.made(p.number).begin)};
}

void soak(Hand& hand, double seconds, ViewTimes& to) {
    const double begin = steady_seconds(), settled_in = std::min(300.0, seconds / 10);
    for (double now = begin; now - begin < seconds; now = steady_seconds()) {
        hand.picture_of(++to.soak_pictures % 4 ? hand.turn() : hand.edit());
        if (to.rss_first_mb == 0 && now - begin >= settled_in) to.rss_first_mb = resident_mb();
    }
    to.soak_s = steady_seconds() - begin, to.rss_last_mb = resident_mb();
    if (to.rss_first_mb == 0) to.rss_first_mb = to.rss_last_mb; // one picture took all the time
}

ViewReport measure(Hand& hand, const TimedPainter& painter, double seconds, int rounds, double soak_seconds, int divider) {
    ViewReport report;
    for (const auto& [width, height] : {std::pair{240, 168}, {320, 320}, {640, 640}})
        report.rows.push_back(turn_window(hand, painter, width / divider, height / divider, seconds));
    ViewTimes& times = report.times;
    std::vector<double> full, edits, turns, interrupts, cancels;
    for (int k = 0; k < rounds; ++k) full.push_back(release(hand));
    for (int k = 0; k < 2 * rounds; ++k) {
        const auto [picture, begun] = interrupt(hand, painter, (k + 0.5) / (2 * rounds));
        interrupts.push_back(picture), cancels.push_back(begun);
    }
    hand.set_size(320 / divider, 320 / divider);
    for (int k = 0; k < 8; ++k) hand.picture_of(hand.turn());
    for (int k = 0; k < 4 * rounds; ++k) { // in turn: the machine's load is the same for both
        double start = steady_seconds();
        turns.push_back(ms_since(start, hand.picture_of(hand.turn()).at));
        start = steady_seconds();
        edits.push_back(ms_since(start, hand.picture_of(hand.edit()).at));
    }
    times.first_full_ms = median(full), times.edit_ms = median(edits), times.moving_ms = median(turns);
    times.interrupt_ms = median(interrupts), times.greatest_interrupt = *std::max_element(interrupts.begin(), interrupts.end());
    times.cancel_ms = median(cancels), times.greatest_cancel = *std::max_element(cancels.begin(), cancels.end());
    if (soak_seconds > 0) soak(hand, soak_seconds, times);
    return report;
}

} // namespace

ViewReport measure_view(Device& device, std::shared_ptr<const PreparedVolume> volume, const Scene& first, const Model& model,
                        double seconds, int rounds, double soak_seconds, int divider) {
    view::ServerSettings settings;
    settings.token = view::new_token();
    view::Server server(settings);
    SessionPainter session({device}, volume, model, [](const Scene&) { return EnvironmentTables(); });
    TimedPainter painter(session);
    SteadyClock clock;
    view::ViewerSettings viewer_settings;
    viewer_settings.scene = first, viewer_settings.volume = volume, viewer_settings.name = "benchmark";
    if (device.facts().type == DeviceType::gpu) viewer_settings.loop.moving_budget_s = 1.0 / 30;
    view::Viewer viewer(viewer_settings, painter, clock, server);
    server.start(viewer);
    ViewReport report;
    {
        ViewClient client(server.port(), settings.token);
        Hand hand(client, first, *volume);
        report = measure(hand, painter, seconds, rounds, soak_seconds, divider);
    }
    server.stop(view::bye_reply("The benchmark has ended."));
    return report;
}

std::string view_table(const ViewReport& report) {
    std::string text = fmt::format("{:<10} {:>8} {:>11} {:>11} {:>9} {:>7} {:>12} {:>8}\n", "window", "divider", "pictures/s", "session ms",
                                   "frame ms", "added", "delivery ms", "bytes");
    for (const ViewRow& r : report.rows)
        text +=
            fmt::format("{:<10} {:>8} {:>11.2f} {:>11.1f} {:>9.1f} {:>6.1f}% {:>12.1f} {:>8.0f}\n", fmt::format("{}x{}", r.width, r.height),
                        r.divider, r.per_second, r.session_ms, r.frame_ms, 100 * (r.frame_ms / r.session_ms - 1), r.delivery_ms, r.bytes);
    const ViewTimes& t = report.times;
    text += fmt::format("last scene to full size: {:.0f} ms\n", t.first_full_ms);
    text += fmt::format("transfer function: {:.1f} ms to its picture, a turn {:.1f} ms: {:+.1f} ms\n", t.edit_ms, t.moving_ms,
                        t.edit_ms - t.moving_ms);
    text += fmt::format("interrupting: next picture after {:.0f} ms (greatest {:.0f}), begun after {:.0f} ms (greatest {:.0f})\n",
                        t.interrupt_ms, t.greatest_interrupt, t.cancel_ms, t.greatest_cancel);
    if (t.soak_s > 0)
        text += fmt::format("soak: {:.0f} s, {} pictures, memory {:.1f} MB, at the end {:.1f} MB ({:+.1f}%)\n", t.soak_s, t.soak_pictures,
                            t.rss_first_mb, t.rss_last_mb, 100 * (t.rss_last_mb / t.rss_first_mb - 1));
    return text;
}

} // namespace clvr::bench

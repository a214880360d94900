#include "host/live/loop.hpp"
#include "host/live/caught.hpp"
#include "host/live/moving_size.hpp"

#include <algorithm>
#include <atomic>
#include <deque>
#include <optional>
#include <thread>
#include <utility>

namespace clvr {
namespace {

enum class Pass { none, moving, still };

/// Which pictures a scene still needs: the render thread's own.
struct Shown {
    Scene scene;
    std::uint64_t generation = 0;
    bool moving_due = false; // a moving picture
    bool changed = false;    // and nothing was drawn since: its time is worth measuring
    bool moving = false;     // not settled since
    bool show_due = false;   // the samples that there are, again
    bool failed = false;     // to be drawn: it is left alone
    int samples = 0;         // of the picture in full size; 0: there is none
    int divider = 0;         // of the last moving picture

    /// A march has all that it ever gets at once.
    int wanted() const { return scene.mode == Mode::path ? scene.spp : 1; }
    bool complete() const { return samples > 0 && (scene.mode != Mode::path || samples == scene.spp); }

    /// Whether the first picture in full size is drawn as in motion, to be there soon: four feature rays take most of its time. Not where
    /// it was there in motion.
    bool first_is_quick() const { return samples == 0 && wanted() > 1 && divider > 1; }

    /// To reach by the next pass: 1, 2, 4, 8 ... and at last what is wanted.
    int next_samples() const {
        if (samples >= wanted()) return wanted();
        if (show_due && samples > 0) return samples;
        int next = 1;
        while (next <= samples) next *= 2;
        return std::min(next, wanted());
    }

    /// Another scene; `kept`: the samples are of it, too.
    void take(const Scene& other, std::uint64_t its_generation, bool kept) {
        scene = other, generation = its_generation, failed = false;
        if (kept && samples > 0 && !moving) {
            show_due = true;
            return;
        }
        moving = moving_due = true;
        changed = !kept;
        samples = 0;
    }
};

} // namespace

class Loop::Thread {
public:
    Thread(Painter& painter, Clock& clock, const LoopSettings& settings, LoopSinks sinks)
        : painter_(painter), clock_(clock), settings_(settings), sinks_(std::move(sinks)),
          size_(settings.moving_budget_s, settings.tolerance, settings.least_side), thread_([this] { work(); }) {}

    ~Thread() {
        change([&] { stop_ = true, cancel(Pass::moving); });
        thread_.join();
    }

    void post(const Scene& scene, std::uint64_t generation) {
        change([&] { posted_ = Post{scene, generation}, last_post_ = clock_.now(), cancel(Pass::still); });
    }

    void pause(bool paused) {
        change([&] {
            paused_ = paused;
            if (paused) cancel(Pass::moving);
        });
    }

    void run(std::function<void(Painter&)> job) {
        change([&] { jobs_.push_back(std::move(job)), cancel(Pass::moving); });
    }

private:
    struct Post {
        Scene scene;
        std::uint64_t generation;
    };

    Painter& painter_;
    Clock& clock_;
    const LoopSettings settings_;
    const LoopSinks sinks_;

    std::mutex mutex_; // of what follows
    std::condition_variable changed_;
    bool stop_ = false, paused_ = false;
    std::optional<Post> posted_; // the newest, until it is taken
    Clock::Time last_post_;
    std::deque<std::function<void(Painter&)>> jobs_;
    Pass running_ = Pass::none;
    std::atomic<bool> cancelled_{false}; // the pass that runs

    // The render thread's own.
    std::optional<Shown> view_;
    MovingSize size_;
    std::uint64_t pictures_ = 0;
    std::thread thread_; // uses all of the above

    template <class Change>
    void change(const Change& change) {
        const std::lock_guard lock(mutex_);
        change();
        changed_.notify_one();
    }

    /// The pass that runs, if it is of that kind or cancelled more easily.
    void cancel(Pass kind) {
        if (running_ != Pass::none && running_ >= kind) cancelled_ = true;
    }

    void work() {
        std::unique_lock lock(mutex_);
        while (!stop_) {
            if (!jobs_.empty()) {
                const auto job = std::move(jobs_.front());
                jobs_.pop_front();
                unlocked(lock, [&] { job(painter_); });
            } else if (paused_) {
                clock_.wait(changed_, lock, Clock::Time::max());
            } else if (posted_ && !(view_ && view_->changed)) { // a scene that was taken is drawn, however quickly the next one comes
                const Post post = *std::exchange(posted_, std::nullopt);
                unlocked(lock, [&] { take(post); });
            } else {
                draw_or_wait(lock);
            }
        }
    }

    void draw_or_wait(std::unique_lock<std::mutex>& lock) {
        if (!view_ || view_->failed) return clock_.wait(changed_, lock, Clock::Time::max());
        Shown& v = *view_;
        if (v.moving && !v.moving_due) {
            const auto settled =
                last_post_ + std::chrono::duration_cast<Clock::Time::duration>(std::chrono::duration<double>(settings_.settle_s));
            if (clock_.now() < settled) return clock_.wait(changed_, lock, settled);
            v.moving = false;
        }
        if (!v.moving && !v.show_due && v.complete()) return clock_.wait(changed_, lock, Clock::Time::max());
        running_ = v.moving ? Pass::moving : Pass::still;
        cancelled_ = false;
        unlocked(lock, [&] { draw(v); });
        running_ = Pass::none;
    }

    /// Calls f(), which may throw, without the lock.
    template <class F>
    void unlocked(std::unique_lock<std::mutex>& lock, const F& f) {
        lock.unlock();
        try {
            f();
        } catch (...) {
            const Error error = caught_error();
            sinks_.failed(view_ ? view_->generation : 0, error);
        }
        for (std::string& warning : painter_.take_warnings()) sinks_.warned(std::move(warning));
        lock.lock();
    }

    void take(const Post& post) {
        try {
            const bool changed = painter_.set_scene(post.scene);
            if (!view_) view_.emplace();
            view_->take(post.scene, post.generation, !changed);
        } catch (...) {
            const Error error = caught_error();
            sinks_.failed(post.generation, error);
        }
    }

    void draw(Shown& v) {
        const bool moving = v.moving;
        const int divider = moving ? size_.divider(v.scene.width, v.scene.height) : 1;
        const Painter::Draw wanted{divided(v.scene.width, divider), divided(v.scene.height, divider), moving ? 1 : v.next_samples(),
                                   moving || v.first_is_quick()};
        const bool changed = std::exchange(v.changed, false);
        v.failed = true; // if it throws
        std::optional<Painter::Drawn> drawn = painter_.draw(wanted, cancelled_);
        v.failed = false;
        if (!drawn) return;
        const double elapsed_ms = drawn->paths_ms + drawn->rest_ms;
        if (moving)
            v.moving_due = false, v.divider = divider;
        else
            v.show_due = false, v.samples = drawn->samples;
        if (moving && changed) size_.measured(wanted.width, wanted.height, elapsed_ms);
        const Phase phase = wanted.moving ? Phase::moving : v.complete() ? Phase::settled : Phase::accumulating;
        sinks_.picture(std::make_shared<const LivePicture>(
            LivePicture{++pictures_, v.generation, phase, divider, drawn->samples, std::move(drawn->pixels), elapsed_ms}));
    }
};

Loop::Loop(Painter& painter, Clock& clock, const LoopSettings& settings, LoopSinks sinks)
    : thread_(std::make_unique<Thread>(painter, clock, settings, std::move(sinks))) {}

Loop::~Loop() = default;

void Loop::post(const Scene& scene, std::uint64_t generation) { thread_->post(scene, generation); }
void Loop::pause(bool paused) { thread_->pause(paused); }
void Loop::run(std::function<void(Painter&)> job) { thread_->run(std::move(job)); }

} // namespace clvr

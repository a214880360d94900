// A Loop with a clock and a painter that do what a test says.
#pragma once
#include "host/live/loop.hpp"
#include "host/live/scene_parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace clvr::testing {

/// Whether it becomes true within some seconds.
template <class Condition>
bool eventually(const Condition& condition) {
    for (int k = 0; k < 10000; ++k) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

/// Long enough for a loop that should be quiet to show that it is not.
inline void linger() { std::this_thread::sleep_for(std::chrono::milliseconds(30)); }

/// Stands still but for advance().
class FakeClock final : public Clock {
public:
    Time now() const override { return Time(std::chrono::microseconds(now_us_)); }
    void wait(std::condition_variable& changed, std::unique_lock<std::mutex>& lock, Time until) override {
        until_ = until;
        ++waits_;
        if (now() < until) changed.wait_for(lock, std::chrono::milliseconds(1));
    }
    void advance(double seconds) { now_us_ += std::llround(seconds * 1e6); }
    /// Whether the loop has begun to wait since, for that time or with no limit.
    bool waits(Time until = Time::max()) {
        const long had = waits_;
        return eventually([&] { return waits_ > had + 1 && until_.load() == until; });
    }

private:
    std::atomic<long> now_us_{1000000}, waits_{0};
    std::atomic<Time> until_{Time{}};
};

/// Its pictures are one pixel. Holds each where the test says so, until it is let go or cancelled.
class FakePainter final : public Painter {
public:
    std::atomic<bool> hold{false};
    std::atomic<int> held{0}, cancelled{0};
    std::atomic<double> us_per_pixel{0.1};
    std::atomic<bool> fails{false};

    bool set_scene(const Scene& scene) override {
        if (scene.seed == bad_seed) throw Error(ErrorKind::usage, "is bad", "--seed");
        const std::lock_guard lock(mutex_);
        const bool changed = !scene_ || !same_samples(*scene_, scene);
        if (changed) samples_ = 0;
        scene_ = scene;
        return changed;
    }
    std::optional<Drawn> draw(const Draw& wanted, const std::atomic<bool>& stop) override {
        {
            const std::lock_guard lock(mutex_);
            draws_.push_back(wanted);
        }
        ++held;
        while (hold && !stop) std::this_thread::sleep_for(std::chrono::microseconds(100));
        --held;
        if (stop) return ++cancelled, std::nullopt;
        if (fails.exchange(false)) throw Error(ErrorKind::device, "broke", "device 0");
        const std::lock_guard lock(mutex_);
        if (!wanted.moving && (samples_ < wanted.samples || samples_ > scene_->spp)) samples_ = wanted.samples;
        Drawn drawn{{1, 1, 3, {1, 2, 3}}, wanted.moving ? 1 : samples_, us_per_pixel * wanted.width * wanted.height * 1e-3, 0};
        return drawn;
    }
    std::optional<Double3> position_at(double x, double y) override { return Double3{x, y, 0}; }
    DisplayPixels still(const Scene&, const RenderControl&) override { return {}; }
    Frame frame(const Scene&, const RenderControl&) override { return {}; }
    std::string device() const override { return "none"; }
    std::vector<std::string> take_warnings() override {
        const std::lock_guard lock(mutex_);
        return std::exchange(warnings_, {});
    }

    static constexpr std::uint64_t bad_seed = 13;
    void warn(const std::string& warning) {
        const std::lock_guard lock(mutex_);
        warnings_.push_back(warning);
    }
    /// So far.
    std::vector<Draw> draws() {
        const std::lock_guard lock(mutex_);
        return draws_;
    }

private:
    std::mutex mutex_;
    std::optional<Scene> scene_;
    int samples_ = 0;
    std::vector<Draw> draws_;
    std::vector<std::string> warnings_;
};

inline Scene scene_at(double azimuth, int spp = 8) {
    Scene scene;
    scene.camera.azimuth = azimuth;
    scene.spp = spp;
    return scene;
}

/// The loop, and what came out of it.
struct FakeLoop {
    FakeClock clock;
    FakePainter painter;

    LoopSinks sinks() {
        return {[this](std::shared_ptr<const LivePicture> picture) {
                    const std::lock_guard lock(mutex);
                    pictures.push_back(std::move(picture));
                },
                [this](std::uint64_t generation, const Error& error) {
                    const std::lock_guard lock(mutex);
                    failures.push_back(std::to_string(generation) + " " + error.line());
                },
                [this](std::string warning) {
                    const std::lock_guard lock(mutex);
                    warnings.push_back(std::move(warning));
                }};
    }

    std::mutex mutex;
    std::vector<std::shared_ptr<const LivePicture>> pictures;
    std::vector<std::string> failures, warnings;

    /// Pictures as "generation phase samples", phase m, a or s.
    std::vector<std::string> seen() {
        const std::lock_guard lock(mutex);
        std::vector<std::string> all;
        for (const auto& p : pictures)
            all.push_back(std::to_string(p->generation) + " " + "mas"[static_cast<int>(p->phase)] + " " + std::to_string(p->samples));
        return all;
    }
    /// Whether these come, and for the time being no others.
    void expect(const std::vector<std::string>& wanted) {
        EXPECT_TRUE(eventually([&] { return seen().size() >= wanted.size(); }));
        linger();
        EXPECT_EQ(seen(), wanted);
    }
    std::vector<std::string> said(std::vector<std::string>& all) {
        const std::lock_guard lock(mutex);
        return all;
    }
    bool draws() {
        return eventually([&] { return painter.held == 1; });
    }
    /// Lets a scene come to rest.
    void settle() { clock.advance(0.15); }

    LoopSettings settings;
    std::optional<Loop> running{std::in_place, painter, clock, settings, sinks()}; // ends before the others
    Loop& loop = *running;
};

} // namespace clvr::testing

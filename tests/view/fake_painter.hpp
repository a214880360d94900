// A painter whose pictures say what they are of, and that waits where a test says so.
#pragma once
#include "host/live/painter.hpp"
#include "runtime/error.hpp"

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace clvr::view {

class FakePainter final : public Painter {
public:
    std::atomic<bool> hold{false}; ///< stills wait, until they are let go or cancelled
    std::atomic<int> draws{0}, stills{0};

    bool set_scene(const Scene& scene) override {
        if (scene.seed == bad_seed) throw Error(ErrorKind::device_memory, "is too small", "device 0");
        scene_ = scene;
        return true;
    }
    std::optional<Drawn> draw(const Draw& wanted, const std::atomic<bool>& cancelled) override {
        ++draws;
        if (cancelled) return {};
        return Drawn{pixels(wanted.width, wanted.height), wanted.samples, 1, 1};
    }
    std::optional<Double3> position_at(double x, double y) override { return x == 0 ? std::nullopt : std::optional(Double3{x, y, 7}); }
    DisplayPixels still(const Scene& scene, const RenderControl& control) override {
        ++stills;
        if (control.progress) control.progress({0.5, scene.spp / 2});
        while (hold && !*control.cancelled) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (*control.cancelled) throw Error(ErrorKind::interrupted, "the picture was cancelled");
        if (scene.seed == bad_seed) throw Error(ErrorKind::device, "broke", "device 0");
        const std::lock_guard lock(mutex_);
        drawn_.push_back(scene);
        return pixels(scene.width, scene.height);
    }
    Frame frame(const Scene& scene, const RenderControl& control) override {
        still(scene, control);
        return frame_of(pixels(scene.width, scene.height));
    }
    std::string device() const override { return "a fake"; }
    std::vector<std::string> take_warnings() override { return {}; }

    /// The scenes of stills, so far.
    std::vector<Scene> drawn() const {
        const std::lock_guard lock(mutex_);
        return drawn_;
    }
    static DisplayPixels pixels(int width, int height) {
        return {width, height, 3, std::vector<unsigned char>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 99)};
    }
    static constexpr std::uint64_t bad_seed = 13;

private:
    Scene scene_;
    mutable std::mutex mutex_;
    std::vector<Scene> drawn_;
};

} // namespace clvr::view

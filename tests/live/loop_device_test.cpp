// The loop with its real painter and clock: what it settles on is what a render writes.
#include "host/live/loop.hpp"
#include "tests/live/painted.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace clvr::testing {
namespace {

TEST(LiveView, SettlesOnTheBitsOfARenderWhateverCameBefore) {
    SessionPainter painter = painter_of();
    SteadyClock clock;
    std::mutex mutex;
    std::condition_variable changed;
    std::shared_ptr<const LivePicture> last;
    std::uint64_t moving = 0;
    LoopSinks sinks;
    sinks.picture = [&](std::shared_ptr<const LivePicture> picture) {
        const std::lock_guard lock(mutex);
        moving += picture->phase == Phase::moving;
        last = std::move(picture);
        changed.notify_one();
    };
    sinks.failed = [](std::uint64_t, const Error& error) { ADD_FAILURE() << error.line(); };
    sinks.warned = [](const std::string& warning) { ADD_FAILURE() << warning; };
    LoopSettings settings;
    settings.least_side = 16;
    settings.settle_s = 0.05;
    Loop loop(painter, clock, settings, sinks);
    Scene scene = wavy_scene();
    std::uint64_t generation = 0;
    for (int round = 0; round < 3; ++round) {
        for (int k = 0; k < 20; ++k) { // a drag, with a pause in it in which pictures in full size begin
            scene.camera.azimuth += 5;
            if (k % 3 == 0) scene.transfer->points[1].color[0] = 0.04 * k;
            if (k % 7 == 0) scene.light.key_azimuth += 11;
            loop.post(scene, ++generation);
            if (k == 9) loop.run([&](Painter& p) { p.position_at(0.5, 0.5); });
            std::this_thread::sleep_for(std::chrono::milliseconds(k == 12 ? 90 : 8));
        }
        std::unique_lock lock(mutex);
        ASSERT_TRUE(changed.wait_for(lock, std::chrono::seconds(100),
                                     [&] { return last && last->phase == Phase::settled && last->generation == generation; }));
        EXPECT_EQ(last->samples, scene.spp);
        expect_same(last->pixels, rendered(scene));
    }
    EXPECT_GT(moving, 3u);
}

} // namespace
} // namespace clvr::testing

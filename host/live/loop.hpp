// A live view without any network: scenes come in, pictures go out.
#pragma once
#include "host/live/clock.hpp"
#include "host/live/painter.hpp"
#include "host/live/picture.hpp"
#include "runtime/error.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace clvr {

struct LoopSettings {
    double moving_budget_s = 1.0 / 12; ///< for a moving picture; 1/30 on a GPU
    double tolerance = 1.4;            ///< a moving picture may take so many budgets before it becomes smaller
    int least_side = 128;              ///< [pixels] of a moving picture's shorter side, unless the scene's is shorter
    double settle_s = 0.15;            ///< without a new scene, until the picture is drawn in full size
};

/// Called from the render thread; must not block. None may be empty.
struct LoopSinks {
    std::function<void(std::shared_ptr<const LivePicture>)> picture;
    /// The scene of that generation cannot be drawn: the former one's picture stays. Or a job threw, while that generation was shown.
    std::function<void(std::uint64_t generation, const Error& error)> failed;
    std::function<void(std::string)> warned;
};

/// Draws the newest scene: while scenes come, moving pictures of a size that keeps the budget; then in full size with 1, 2, 4, 8 ...
/// samples, until Scene::spp are reached. Then, and while paused, it takes no time at all. Owns the render thread. May be called from any
/// thread, also from sinks and jobs.
class Loop {
public:
    /// Painter and clock outlive the loop.
    Loop(Painter& painter, Clock& clock, const LoopSettings& settings, LoopSinks sinks);
    /// Cancels the picture that is drawn, drops jobs that have not begun, and waits for one that has.
    ~Loop();
    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    /// The newest scene wins. A picture in full size is cancelled, a moving one is finished (or nothing would be seen while scenes come
    /// quickly). Width and height: those of the full size.
    void post(const Scene& scene, std::uint64_t generation);
    /// Nobody looks: no pictures are drawn; jobs are run.
    void pause(bool paused);
    /// On the render thread, alone, in order, between pictures; the one that is drawn is cancelled, and goes on afterwards from where it
    /// was. Who changes what the painter draws by other ways than its scene posts the scene again.
    void run(std::function<void(Painter&)> job);

private:
    class Thread;
    std::unique_ptr<Thread> thread_;
};

} // namespace clvr

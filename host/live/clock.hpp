// The time that a Loop goes by; tests have their own.
#pragma once
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace clvr {

class Clock {
public:
    using Time = std::chrono::steady_clock::time_point;
    virtual ~Clock() = default;
    virtual Time now() const = 0;
    /// Until `changed` is notified or that time has come; may return early. Time::max(): no limit.
    virtual void wait(std::condition_variable& changed, std::unique_lock<std::mutex>& lock, Time until) = 0;
};

class SteadyClock final : public Clock {
public:
    Time now() const override { return std::chrono::steady_clock::now(); }
    void wait(std::condition_variable& changed, std::unique_lock<std::mutex>& lock, Time until) override {
        if (until == Time::max())
            changed.wait(lock);
        else
            changed.wait_until(lock, until);
    }
};

} // namespace clvr

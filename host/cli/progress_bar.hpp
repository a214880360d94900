// A progress line on a terminal's stderr: share done, rate, time left. Nothing elsewhere.
#pragma once
#include <chrono>
#include <mutex>
#include <string>

namespace clvr {

class ProgressBar {
public:
    /// `quiet` or a stderr that is no terminal: shows nothing.
    ProgressBar(std::string label, bool quiet);
    ~ProgressBar();
    /// `done` 0..1, `note` for instance "12 samples, 3.1 Mpaths/s". Redraws at most ten times a second; any thread.
    void update(double done, const std::string& note);
    double seconds() const;

private:
    std::string label_;
    bool shown_, drawn_ = false;
    std::mutex mutex_;
    std::chrono::steady_clock::time_point begin_, last_{};
};

/// "45 s", "3:07 min", "1:02:33 h".
std::string duration_text(double seconds);

} // namespace clvr

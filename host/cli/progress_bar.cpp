#include "host/cli/progress_bar.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <unistd.h>

namespace clvr {

std::string duration_text(double seconds) {
    const long s = static_cast<long>(seconds + 0.5);
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{}:{:02} min", s / 60, s % 60);
    return fmt::format("{}:{:02}:{:02} h", s / 3600, s / 60 % 60, s % 60);
}

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), shown_(!quiet && isatty(STDERR_FILENO)), begin_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
    if (drawn_) std::fputs("\r\033[K", stderr);
}

double ProgressBar::seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

void ProgressBar::update(double done, const std::string& note) {
    if (!shown_) return;
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (drawn_ && now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    drawn_ = true;
    constexpr int width = 28;
    const int full = static_cast<int>(done * width);
    std::string bar;
    for (int k = 0; k < width; ++k) bar += k < full ? "█" : "░";
    const std::string left = done > 0.01 ? duration_text(seconds() * (1 - done) / done) + " left" : "";
    std::fputs(fmt::format("\r\033[K{} {} {:3.0f} %  {}  {}", label_, bar, 100 * done, note, left).c_str(), stderr);
    std::fflush(stderr);
}

} // namespace clvr

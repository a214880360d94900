#include "host/live/moving_size.hpp"

#include <algorithm>

namespace clvr {

int MovingSize::divider(int width, int height) {
    const int greatest = std::max(1, std::min(width, height) / least_side_);
    if (us_per_pixel_ <= 0) return divider_ = greatest;
    const auto cost_us = [&](int by) { return us_per_pixel_ * divided(width, by) * divided(height, by); };
    int fitting = 1;
    while (fitting < greatest && cost_us(fitting) > budget_us_) ++fitting;
    divider_ = std::clamp(divider_, 1, greatest);
    if (fitting < divider_ || cost_us(divider_) > tolerance_ * budget_us_) divider_ = fitting;
    return divider_;
}

void MovingSize::measured(int width, int height, double ms) {
    const double now = ms * 1e3 / (static_cast<double>(width) * height);
    // One slow picture may be an accident (a driver that compiles, other work on the machine); a quick one never is.
    us_per_pixel_ = us_per_pixel_ > 0 ? std::min(now, (us_per_pixel_ + now) / 2) : now;
}

} // namespace clvr

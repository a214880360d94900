// How small a moving picture must be to come in time.
#pragma once

namespace clvr {

/// A picture's cost is taken to grow with its pixels. That of a launch does not, so that small pictures look dearer than they are, and the
/// divider falls step by step, each time by a new measurement.
class MovingSize {
public:
    /// `budget_s`: for a picture. One may take `tolerance` budgets before the next is smaller, and none is larger unless it fits one
    /// budget: between the two the size stays. `least_side` [pixels]: of the shorter side, where the full picture's is not shorter.
    MovingSize(double budget_s, double tolerance, int least_side)
        : budget_us_(budget_s * 1e6), tolerance_(tolerance), least_side_(least_side) {}

    /// Of width and height of the next picture, whose full size this is. The greatest one while nothing is measured.
    int divider(int width, int height);
    /// What a picture of that size took.
    void measured(int width, int height, double ms);

private:
    double budget_us_, tolerance_;
    int least_side_;
    double us_per_pixel_ = 0; // 0: not known
    int divider_ = 0;         // of the last picture; 0: there is none
};

/// A side of the picture with that divider.
constexpr int divided(int side, int divider) { return side > divider ? side / divider : 1; }

} // namespace clvr

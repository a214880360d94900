// The size of moving pictures by what earlier ones took.
#include "host/live/moving_size.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

/// A budget of 100 ms at 1 microsecond a pixel: 100 000 pixels.
struct Sizes {
    MovingSize size{0.1, 1.4, 128};
    double us = 1;
    int next(int width, int height) {
        const int divider = size.divider(width, height);
        measure(width, height, divider);
        return divider;
    }
    void measure(int width, int height, int divider) {
        const int w = divided(width, divider), h = divided(height, divider);
        size.measured(w, h, us * w * h * 1e-3);
    }
};

TEST(MovingSize, BeginsSmallAndThenFitsTheBudget) {
    Sizes sizes;
    EXPECT_EQ(sizes.next(1280, 720), 5); // 144 pixels high
    EXPECT_EQ(sizes.next(1280, 720), 4); // 320x180 = 57 600
    EXPECT_EQ(sizes.next(300, 300), 1);  // 90 000
    EXPECT_EQ(sizes.next(2000, 2000), 7);
}

TEST(MovingSize, IsNeverUnderTheLeastSide) {
    Sizes sizes;
    sizes.us = 1000;
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(sizes.next(640, 400), 3);
        EXPECT_EQ(sizes.next(255, 4000), 1);
        EXPECT_EQ(sizes.next(256, 4000), 2);
        EXPECT_EQ(sizes.next(100, 60), 1);
    }
}

TEST(MovingSize, StaysBetweenOneBudgetAndItsTolerance) {
    Sizes sizes;
    sizes.next(300, 300);
    ASSERT_EQ(sizes.next(300, 300), 1); // 90 ms
    for (const double us : {1.2, 1.5, 1.2, 1.5}) {
        sizes.us = us;
        EXPECT_EQ(sizes.next(300, 300), 1) << us;
    }
    sizes.us = 1.7; // 153 ms
    for (int k = 0; k < 4; ++k) sizes.next(300, 300);
    EXPECT_EQ(sizes.next(300, 300), 2);
    sizes.us = 1.2; // 108 ms
    for (int k = 0; k < 4; ++k) EXPECT_EQ(sizes.next(300, 300), 2) << "larger ones do not fit";
    sizes.us = 1.1;
    sizes.next(300, 300);
    EXPECT_EQ(sizes.next(300, 300), 1);
}

TEST(MovingSize, OneSlowPictureIsForgottenByTheNext) {
    Sizes sizes;
    sizes.us = 300; // a driver that compiles
    EXPECT_EQ(sizes.next(640, 640), 5);
    sizes.us = 0.2; // 82 ms
    EXPECT_EQ(sizes.next(640, 640), 5);
    EXPECT_EQ(sizes.next(640, 640), 1);
    sizes.us = 0.2 * 1.6; // other work on the machine
    EXPECT_EQ(sizes.next(640, 640), 1);
    sizes.us = 0.2;
    EXPECT_EQ(sizes.next(640, 640), 1) << "its mean with the former one is within the tolerance";
}

TEST(MovingSize, SidesAreAtLeastAPixel) {
    EXPECT_EQ(divided(640, 3), 213);
    EXPECT_EQ(divided(2, 3), 1);
    EXPECT_EQ(divided(3, 3), 1);
}

} // namespace
} // namespace clvr

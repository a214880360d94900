// How many times a file has, as its reader says it.
#include "host/io/volume/reading_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clvr {
namespace {

TEST(TimeSteps, AreAsManyAsTheReaderSaid) {
    Voxels v;
    EXPECT_EQ(v.frames, 1);
    v.frames = say_frame(0, 1, "t", v.decisions);
    EXPECT_EQ(v.frames, 1);
    EXPECT_THAT(v.decisions, testing::IsEmpty());
    v.frames = say_frame(2, 5, "axis 4 (time)", v.decisions);
    EXPECT_EQ(v.frames, 5);
    EXPECT_THAT(v.decisions, testing::ElementsAre("frame 2 of 0 to 4 along axis 4 (time)"));
}

} // namespace
} // namespace clvr

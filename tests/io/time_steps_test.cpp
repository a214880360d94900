// How many times a file has, as its reader says it.
#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/volume_file.hpp"

#include <gtest/gtest.h>

namespace clvr {
namespace {

TEST(TimeSteps, AreAsManyAsTheReaderSaid) {
    Voxels v;
    v.decisions = {"frame the spacing is that of --spacing"};
    EXPECT_EQ(time_steps(v), 1);
    say_frame(0, 1, "t", v.decisions);
    EXPECT_EQ(time_steps(v), 1);
    say_frame(2, 5, "axis 4 (time)", v.decisions);
    EXPECT_EQ(time_steps(v), 5);
}

} // namespace
} // namespace clvr

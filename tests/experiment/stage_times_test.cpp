#include "host/experiment/stage_times.hpp"
#include "runtime/error.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace clvr {
namespace {

TEST(StageTimes, AddUpOverRunsAndKeepWhatIsFinished) {
    const TemporaryFolder folder;
    const std::string path = (folder.path() / "stages.json").string();
    const auto nap = [] { std::this_thread::sleep_for(std::chrono::milliseconds(5)); };
    double first = 0;
    {
        StageTimes times(path);
        EXPECT_EQ(times.time("render", [&] { return nap(), 7; }), 7);
        first = times.seconds("render");
        EXPECT_GE(first, 0.005);
        EXPECT_THROW(times.time("train", [&]() -> int { throw Error(ErrorKind::interrupted, "interrupted"); }), Error);
        times.finish("render");
    }
    StageTimes again(path);
    EXPECT_EQ(again.seconds("render"), first);
    EXPECT_EQ(again.seconds("measure"), 0);
    EXPECT_TRUE(again.finished("render"));
    EXPECT_FALSE(again.finished("train"));
    again.time("render", nap);
    EXPECT_GE(again.seconds("render"), first + 0.005);
    ASSERT_EQ(again.all().size(), 2u); // the interrupted one counts
    EXPECT_EQ(again.all()[1].first, "train");
}

TEST(StageTimes, RefusesADamagedFile) {
    const TemporaryFolder folder;
    folder.write("stages.json", "{\"seconds\": [");
    EXPECT_THROW(StageTimes((folder.path() / "stages.json").string()), Error);
}

} // namespace
} // namespace clvr

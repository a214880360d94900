// Programs that are built before they are needed, without a device.
#include "runtime/opencl/programs.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <stdexcept>
#include <vector>

namespace clvr {
namespace {

Programs::Key stage_key(const std::string& stage) { return {stage, {}}; }

TEST(ProgramsTest, EachIsBuiltOnceWhoeverAsksFirst) {
    std::atomic<int> builds{0};
    Programs programs([&](const Programs::Key&) {
        ++builds;
        return cl::Program();
    });
    for (const char* stage : {"a", "b", "a"}) programs.prepare(stage_key(stage));
    std::vector<std::future<cl::Program>> asking;
    for (const char* stage : {"a", "b", "c", "c", "a"})
        asking.push_back(std::async(std::launch::async, [&programs, stage] { return programs.get(stage_key(stage)); }));
    for (auto& asked : asking) asked.get();
    EXPECT_EQ(builds, 3);
    programs.get({"a", {{"X", "1"}}});
    EXPECT_EQ(builds, 4) << "other definitions are another program";
}

TEST(ProgramsTest, AFailureReachesWhoAsksForTheProgram) {
    bool broken = true;
    Programs programs([&](const Programs::Key& k) -> cl::Program {
        if (broken && k.first == "bad") throw std::runtime_error("does not build");
        return {};
    });
    programs.prepare(stage_key("bad"));
    programs.get(stage_key("good"));
    EXPECT_THROW(programs.get(stage_key("bad")), std::runtime_error);
    EXPECT_THROW(programs.get(stage_key("bad")), std::runtime_error);
    broken = false;
    EXPECT_NO_THROW(programs.get(stage_key("bad")));
}

TEST(ProgramsTest, TheEndWaitsForTheBuildThatRunsAndLeavesOutTheOthers) {
    std::atomic<int> builds{0};
    std::promise<void> begun, ending;
    const auto ended = ending.get_future().share();
    std::future<void> end;
    {
        auto programs = std::make_unique<Programs>([&](const Programs::Key&) {
            if (++builds == 1) begun.set_value();
            ended.wait();
            return cl::Program();
        });
        for (const char* stage : {"a", "b", "c"}) programs->prepare(stage_key(stage));
        begun.get_future().wait();
        end = std::async(std::launch::async, [&programs] { programs.reset(); });
        EXPECT_EQ(end.wait_for(std::chrono::milliseconds(50)), std::future_status::timeout);
        ending.set_value();
        end.wait();
    }
    EXPECT_EQ(builds, 1);
}

} // namespace
} // namespace clvr

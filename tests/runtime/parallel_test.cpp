// Work on all cores: everything is done once, whatever the count.
#include "runtime/system/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

namespace clvr {
namespace {

TEST(ParallelTest, EachIndexIsVisitedOnce) {
    for (const std::size_t count : {0, 1, 2, 1000}) {
        std::vector<std::atomic<int>> seen(count);
        for_each_index(count, [&](std::size_t i) { ++seen[i]; });
        for (const auto& n : seen) EXPECT_EQ(n, 1);
    }
}

TEST(ParallelTest, PartsCoverTheRangeInOrder) {
    for (const std::size_t count : {0, 1, 3, 17, 1000}) {
        std::vector<std::pair<std::size_t, std::size_t>> parts(part_count(count));
        for_parts(count, [&](std::size_t part, std::size_t first, std::size_t last) { parts.at(part) = {first, last}; });
        std::size_t at = 0;
        for (const auto& [first, last] : parts) {
            EXPECT_EQ(first, at);
            EXPECT_GT(last, first);
            at = last;
        }
        EXPECT_EQ(at, count);
    }
}

TEST(ParallelTest, AnExceptionReachesTheCaller) {
    for (const std::size_t count : {1, 100})
        EXPECT_THROW(for_each_index(count, [](std::size_t) { throw std::runtime_error("no"); }), std::runtime_error);
}

TEST(ParallelTest, WorkMayCallItAgain) {
    std::atomic<int> calls{0};
    for_each_index(8, [&](std::size_t) { for_each_index(8, [&](std::size_t) { ++calls; }); });
    EXPECT_EQ(calls, 64);
}

} // namespace
} // namespace clvr

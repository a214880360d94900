// Sharing work among workers that are no devices: every number once, by speed, also when some fail.
#include "runtime/schedule/scheduler.hpp"
#include "tests/runtime/warnings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

namespace clvr {
namespace {

using namespace std::chrono_literals;

/// How often each number was done, and how many each worker did.
struct Tally {
    explicit Tally(std::uint32_t total, std::size_t devices = 3) : times(total), by(devices) {}
    void note(std::size_t device, std::uint32_t first, std::uint32_t count) {
        const std::lock_guard lock(mutex);
        for (std::uint32_t i = first; i < first + count; ++i) ++times.at(i);
        by.at(device) += count;
    }
    std::mutex mutex;
    std::vector<int> times;
    std::vector<std::uint32_t> by;
};

const std::vector<std::string> three{"a", "b", "c"};

TEST(Scheduler, DoesEveryNumberOnceWithinTheChunkSizes) {
    for (const std::uint32_t total : {0u, 1u, 15u, 16u, 1000u, 4097u}) {
        Scheduler scheduler(three);
        Tally tally(total);
        const std::vector<Scheduler::ChunkSize> chunk_sizes{{16, 64}, {16, 16}, {32, 512}};
        for (int repeat = 0; repeat < 2; ++repeat)
            scheduler.run("work", total, 1, chunk_sizes, [&](std::size_t device, std::uint32_t first, std::uint32_t count) {
                EXPECT_LE(count, chunk_sizes[device].most);
                EXPECT_TRUE(count % chunk_sizes[device].least == 0 || first + count == total) << device << " " << count;
                tally.note(device, first, count);
            });
        EXPECT_EQ(tally.times, std::vector<int>(total, 2));
    }
}

TEST(Scheduler, OneAloneTakesAllItCan) {
    Scheduler scheduler(std::vector<std::string>{"a"});
    std::vector<std::uint32_t> counts;
    scheduler.run("work", 1000, 1, {{16, 400}}, [&](std::size_t, std::uint32_t, std::uint32_t count) { counts.push_back(count); });
    EXPECT_EQ(counts, (std::vector<std::uint32_t>{400, 400, 200}));
}

TEST(Scheduler, FasterOnesTakeMoreAndTheEndDoesNotWaitForASlowOne) {
    // a takes 20 us a number, b 400 us: b's least run of 64 takes 25.6 ms, all numbers by a alone 82 ms.
    Scheduler scheduler(std::vector<std::string>{"a", "b"});
    const std::vector<Scheduler::ChunkSize> chunk_sizes(2, {64, 2048});
    Tally tally(4096, 2);
    std::vector<std::uint32_t> last(2);
    const auto work = [&](std::size_t device, std::uint32_t first, std::uint32_t count) {
        std::this_thread::sleep_for(count * (device == 0 ? 20us : 400us));
        tally.note(device, first, count);
        last[device] = count;
    };
    for (int repeat = 0; repeat < 3; ++repeat) scheduler.run("work", 4096, 2, chunk_sizes, work); // until the speeds are known
    EXPECT_GT(scheduler.speed("work", 0), 4 * scheduler.speed("work", 1));
    EXPECT_EQ(scheduler.speed("other work", 0), 0);
    tally.by = {0, 0};
    scheduler.run("work", 4096, 2, chunk_sizes, work);
    EXPECT_EQ(tally.times, std::vector<int>(4096, 4));
    EXPECT_GT(tally.by[0], 5 * tally.by[1]);
    EXPECT_LT(last[0], 2048u) << "runs get shorter towards the end";
    // Now less is left than a does while b does its least: b takes nothing.
    tally.by = {0, 0};
    scheduler.run("work", 640, 2, chunk_sizes, work);
    EXPECT_EQ(tally.by[1], 0u);
}

TEST(Scheduler, AnotherDoesTheChunkOfOneThatFails) {
    const Warnings warnings;
    Scheduler scheduler(three);
    Tally tally(1000);
    std::atomic<bool> failed{false};
    const auto work = [&](std::size_t device, std::uint32_t first, std::uint32_t count) {
        if (device == 1) {
            failed = true;
            throw Error(ErrorKind::device, "is lost\nwith its log", "b");
        }
        while (!failed) std::this_thread::sleep_for(1ms); // so that b has its turn
        tally.note(device, first, count);
    };
    scheduler.run("work", 1000, 1, {3, {8, 32}}, work);
    EXPECT_EQ(tally.times, std::vector<int>(1000, 1));
    EXPECT_EQ(scheduler.left(), (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(warnings.text(), "b failed and is left out, the other devices do its work: b: is lost\n");
    scheduler.run("work", 1000, 1, {3, {8, 32}}, work); // and is not asked again
    EXPECT_EQ(tally.times, std::vector<int>(1000, 2));
}

TEST(Scheduler, FailsWithTheLastOne) {
    const Warnings warnings;
    Scheduler scheduler(three);
    const auto fail = [&](std::size_t, std::uint32_t, std::uint32_t) { throw Error(ErrorKind::device_memory, "is full"); };
    try {
        scheduler.run("work", 1000, 1, {3, {8, 32}}, fail);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::device_memory);
    }
    EXPECT_THROW(scheduler.left(), Error);
    EXPECT_THROW(scheduler.run("work", 10, 1, {3, {8, 32}}, fail), Error);
}

TEST(Scheduler, OtherExceptionsEndTheWorkAndDropNobody) {
    Scheduler scheduler(three);
    EXPECT_THROW(scheduler.run("work", 1000, 1, {3, {8, 32}},
                               [](std::size_t, std::uint32_t, std::uint32_t) { throw Error(ErrorKind::input, "is wrong"); }),
                 Error);
    EXPECT_THROW(
        scheduler.run("work", 1000, 1, {3, {8, 32}}, [](std::size_t, std::uint32_t, std::uint32_t) { throw std::runtime_error("wrong"); }),
        std::runtime_error);
    const auto full = [](std::size_t, std::uint32_t, std::uint32_t) { throw Error(ErrorKind::host_memory, "this machine is full"); };
    EXPECT_THROW(scheduler.run("work", 1000, 1, {3, {8, 32}}, full), Error);
    const auto starved = [](std::size_t, std::uint32_t, std::uint32_t) { throw std::bad_alloc(); };
    EXPECT_THROW(scheduler.run("work", 1000, 1, {3, {8, 32}}, starved), std::bad_alloc);
    EXPECT_THROW(scheduler.each([](std::size_t device) {
        if (device == 1) throw Error(ErrorKind::host_memory, "this machine is full");
    }),
                 Error);
    EXPECT_EQ(scheduler.left().size(), 3u);
}

TEST(Scheduler, EachLeavesOutThoseThatFail) {
    const Warnings warnings;
    Scheduler scheduler(three);
    std::vector<std::size_t> done;
    scheduler.each([&](std::size_t device) {
        if (device == 0) throw Error(ErrorKind::device_memory, "is full");
        done.push_back(device);
    });
    EXPECT_EQ(done, (std::vector<std::size_t>{1, 2}));
    EXPECT_EQ(scheduler.left(), done);
    EXPECT_THAT(warnings.text(), testing::HasSubstr("a failed and is left out"));
}

TEST(Scheduler, WhatNoDeviceCanDoIsNoDevicesFailure) {
    const Warnings warnings;
    Scheduler scheduler(three);
    try {
        scheduler.each([](std::size_t) { throw Error(ErrorKind::device_memory, "the volume is too large"); });
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::device_memory);
    }
    EXPECT_EQ(warnings.text(), "");
}

TEST(Scheduler, ComparesAndLeavesOutTheOddOne) {
    const Warnings warnings;
    Scheduler scheduler(three);
    scheduler.compare("sums", [](std::size_t) { return "same"; });
    EXPECT_EQ(scheduler.left().size(), 3u);
    scheduler.compare("sums", [](std::size_t device) { return device == 1 ? "other" : "same"; });
    EXPECT_EQ(scheduler.left(), (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(warnings.text(), "b failed and is left out, the other devices do its work: b: computes other sums than the other devices\n");
    try {
        scheduler.compare("sums", [](std::size_t device) { return std::to_string(device); });
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::device);
        EXPECT_THAT(e.line(), testing::HasSubstr("a, c: compute different sums"));
    }
}

} // namespace
} // namespace clvr

// Sharing work among workers that are no devices: every number once, by speed, also when some fail.
#include "runtime/schedule/dealer.hpp"
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

TEST(Dealer, DoesEveryNumberOnceWithinThePortions) {
    for (const std::uint32_t total : {0u, 1u, 15u, 16u, 1000u, 4097u}) {
        Dealer dealer(three);
        Tally tally(total);
        const std::vector<Dealer::Portion> portions{{16, 64}, {16, 16}, {32, 512}};
        for (int repeat = 0; repeat < 2; ++repeat)
            dealer.deal("work", total, 1, portions, [&](std::size_t device, std::uint32_t first, std::uint32_t count) {
                EXPECT_LE(count, portions[device].most);
                EXPECT_TRUE(count % portions[device].least == 0 || first + count == total) << device << " " << count;
                tally.note(device, first, count);
            });
        EXPECT_EQ(tally.times, std::vector<int>(total, 2));
    }
}

TEST(Dealer, OneAloneTakesAllItCan) {
    Dealer dealer(std::vector<std::string>{"a"});
    std::vector<std::uint32_t> counts;
    dealer.deal("work", 1000, 1, {{16, 400}}, [&](std::size_t, std::uint32_t, std::uint32_t count) { counts.push_back(count); });
    EXPECT_EQ(counts, (std::vector<std::uint32_t>{400, 400, 200}));
}

TEST(Dealer, FasterOnesTakeMoreAndTheEndDoesNotWaitForASlowOne) {
    // a takes 20 us a number, b 400 us: b's least run of 64 takes 25.6 ms, all numbers by a alone 82 ms.
    Dealer dealer(std::vector<std::string>{"a", "b"});
    const std::vector<Dealer::Portion> portions(2, {64, 2048});
    Tally tally(4096, 2);
    std::vector<std::uint32_t> last(2);
    const auto work = [&](std::size_t device, std::uint32_t first, std::uint32_t count) {
        std::this_thread::sleep_for(count * (device == 0 ? 20us : 400us));
        tally.note(device, first, count);
        last[device] = count;
    };
    for (int repeat = 0; repeat < 3; ++repeat) dealer.deal("work", 4096, 2, portions, work); // until the speeds are known
    EXPECT_GT(dealer.speed("work", 0), 4 * dealer.speed("work", 1));
    EXPECT_EQ(dealer.speed("other work", 0), 0);
    tally.by = {0, 0};
    dealer.deal("work", 4096, 2, portions, work);
    EXPECT_EQ(tally.times, std::vector<int>(4096, 4));
    EXPECT_GT(tally.by[0], 5 * tally.by[1]);
    EXPECT_LT(last[0], 2048u) << "runs get shorter towards the end";
    // Now less is left than a does while b does its least: b takes nothing.
    tally.by = {0, 0};
    dealer.deal("work", 640, 2, portions, work);
    EXPECT_EQ(tally.by[1], 0u);
}

TEST(Dealer, AnotherDoesTheRunOfOneThatFails) {
    const Warnings warnings;
    Dealer dealer(three);
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
    dealer.deal("work", 1000, 1, {3, {8, 32}}, work);
    EXPECT_EQ(tally.times, std::vector<int>(1000, 1));
    EXPECT_EQ(dealer.left(), (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(warnings.text(), "b failed and is left out, the other devices do its work: b: is lost\n");
    dealer.deal("work", 1000, 1, {3, {8, 32}}, work); // and is not asked again
    EXPECT_EQ(tally.times, std::vector<int>(1000, 2));
}

TEST(Dealer, FailsWithTheLastOne) {
    const Warnings warnings;
    Dealer dealer(three);
    const auto fail = [&](std::size_t, std::uint32_t, std::uint32_t) { throw Error(ErrorKind::memory, "is full"); };
    try {
        dealer.deal("work", 1000, 1, {3, {8, 32}}, fail);
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::memory);
    }
    EXPECT_THROW(dealer.left(), Error);
    EXPECT_THROW(dealer.deal("work", 10, 1, {3, {8, 32}}, fail), Error);
}

TEST(Dealer, OtherExceptionsEndTheDealAndDropNobody) {
    Dealer dealer(three);
    EXPECT_THROW(dealer.deal("work", 1000, 1, {3, {8, 32}},
                             [](std::size_t, std::uint32_t, std::uint32_t) { throw Error(ErrorKind::input, "is wrong"); }),
                 Error);
    EXPECT_THROW(
        dealer.deal("work", 1000, 1, {3, {8, 32}}, [](std::size_t, std::uint32_t, std::uint32_t) { throw std::runtime_error("wrong"); }),
        std::runtime_error);
    EXPECT_EQ(dealer.left().size(), 3u);
}

TEST(Dealer, EachLeavesOutThoseThatFail) {
    const Warnings warnings;
    Dealer dealer(three);
    std::vector<std::size_t> done;
    dealer.each([&](std::size_t device) {
        if (device == 0) throw Error(ErrorKind::memory, "is full");
        done.push_back(device);
    });
    EXPECT_EQ(done, (std::vector<std::size_t>{1, 2}));
    EXPECT_EQ(dealer.left(), done);
    EXPECT_THAT(warnings.text(), testing::HasSubstr("a failed and is left out"));
}

TEST(Dealer, WhatNoDeviceCanDoIsNoDevicesFailure) {
    const Warnings warnings;
    Dealer dealer(three);
    try {
        dealer.each([](std::size_t) { throw Error(ErrorKind::memory, "the volume is too large"); });
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::memory);
    }
    EXPECT_EQ(warnings.text(), "");
}

TEST(Dealer, ComparesAndLeavesOutTheOddOne) {
    const Warnings warnings;
    Dealer dealer(three);
    dealer.compare("sums", [](std::size_t) { return "same"; });
    EXPECT_EQ(dealer.left().size(), 3u);
    dealer.compare("sums", [](std::size_t device) { return device == 1 ? "other" : "same"; });
    EXPECT_EQ(dealer.left(), (std::vector<std::size_t>{0, 2}));
    EXPECT_EQ(warnings.text(), "b failed and is left out, the other devices do its work: b: computes other sums than the other devices\n");
    try {
        dealer.compare("sums", [](std::size_t device) { return std::to_string(device); });
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::device);
        EXPECT_THAT(e.line(), testing::HasSubstr("a, c: compute different sums"));
    }
}

} // namespace
} // namespace clvr

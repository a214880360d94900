// Medians, spreads and slow phases, on a clock that the test turns.
#include "tools/bench/statistics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace clvr::bench {
namespace {

/// A machine whose work takes `work_s` and whose pace loop takes `pace_s`, times `slowness` now.
struct Machine {
    double now = 100, work_s = 0.1, pace_s = 0.002, slowness = 1;
    int works = 0;
    std::function<void(int)> before_work; ///< gets the number of the run

    Clock clock() {
        return [this] { return now; };
    }
    std::function<void()> loop() {
        return [this] { now += pace_s * slowness; };
    }
    std::function<void()> work() {
        return [this] {
            if (before_work) before_work(works);
            ++works;
            now += work_s * slowness;
        };
    }
};

constexpr Plan plan{5, 0.01, 1000};

TEST(Median, OfOddEvenAndNone) {
    EXPECT_EQ(median({3, 1, 2}), 2);
    EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
    EXPECT_TRUE(std::isnan(median({})));
}

TEST(Spread, IsHalfTheInterquartileRangeOverTheMedian) {
    EXPECT_DOUBLE_EQ(spread({8, 9, 10, 11, 12}), 0.1);
    EXPECT_EQ(spread({5, 5, 5, 5}), 0);
    EXPECT_EQ(spread({5, 9}), 0) << "two say nothing";
    EXPECT_LT(spread({10, 10, 10, 10, 1000}), 0.01) << "one outlier does not count";
}

TEST(Measure, SteadyMachine) {
    Machine m;
    Pace pace(m.clock(), m.loop());
    const Timing t = measure(m.clock(), pace, m.work(), plan);
    EXPECT_NEAR(t.median_s, 0.1, 1e-9);
    EXPECT_EQ(t.batches, 5);
    EXPECT_EQ(t.repeated, 0);
    EXPECT_EQ(t.note, "");
    EXPECT_EQ(m.works, 3 + 5) << "a probe of 3, then a run a batch, as one lasts long enough";
    EXPECT_NEAR(t.pace_s, 0.002, 1e-9);
}

TEST(Measure, ShortWorkIsRepeatedWithinABatch) {
    Machine m;
    m.work_s = 0.001;
    Pace pace(m.clock(), m.loop());
    const Timing t = measure(m.clock(), pace, m.work(), plan);
    EXPECT_NEAR(t.median_s, 0.001, 1e-9);
    EXPECT_NEAR(m.works, 3 + 5 * 10, 5);
}

TEST(Measure, HalfSpeedPhasesAreFoundAndRepeated) {
    Machine m;
    Pace pace(m.clock(), m.loop());
    m.before_work = [&](int run) { m.slowness = run >= 5 && run < 9 ? 2 : 1; };
    const Timing t = measure(m.clock(), pace, m.work(), plan);
    EXPECT_NEAR(t.median_s, 0.1, 1e-9) << "no batch of the slow phase counts";
    EXPECT_EQ(t.spread, 0);
    EXPECT_EQ(t.batches, 5);
    EXPECT_GE(t.repeated, 4);
    EXPECT_EQ(t.note, "");
}

TEST(Measure, ASlowPhaseThatStaysIsSaid) {
    Machine m;
    Pace pace(m.clock(), m.loop());
    m.slowness = 2;
    const Timing t = measure(m.clock(), pace, m.work(), plan);
    EXPECT_NEAR(t.median_s, 0.2, 1e-9);
    EXPECT_THAT(t.note, testing::HasSubstr("slow"));
    EXPECT_NEAR(t.pace_s, 0.004, 1e-9);
}

TEST(Measure, TheBestPaceMayComeFromBefore) {
    Machine m;
    Pace pace(m.clock(), m.loop(), 0.001);
    EXPECT_EQ(pace.best(), 0.001);
    EXPECT_THAT(measure(m.clock(), pace, m.work(), plan).note, testing::HasSubstr("slow"));
}

TEST(Measure, AClockThatJumps) {
    for (const double jump : {-1000.0, 1e6, -0.1}) { // back, forth, and back by just what the work takes
        Machine m;
        Pace pace(m.clock(), m.loop());
        m.before_work = [&](int run) {
            if (run == 4 || run == 6) m.now += jump;
        };
        const Timing t = measure(m.clock(), pace, m.work(), {5, 0.01, 2});
        EXPECT_NEAR(t.median_s, 0.1, 1e-9) << jump;
        EXPECT_EQ(t.batches, 5) << jump;
        EXPECT_EQ(t.repeated, 2) << jump;
    }
}

TEST(Measure, AClockThatStandsStillIsNoResult) {
    Machine m;
    m.work_s = 0;
    Pace pace(m.clock());
    const Timing t = measure(m.clock(), pace, m.work(), plan);
    EXPECT_EQ(t.batches, 0);
    EXPECT_EQ(t.median_s, 0);
    EXPECT_THAT(t.note, testing::HasSubstr("clock"));
}

TEST(Measure, StopsAtItsLimitButNotBeforeThreeBatches) {
    Machine m;
    Pace pace(m.clock(), m.loop());
    EXPECT_EQ(measure(m.clock(), pace, m.work(), {100, 0.01, 0}).batches, 3);
    EXPECT_EQ(measure(m.clock(), pace, m.work(), {100, 0.01, 1.05}).batches, 11);
}

TEST(Measure, TheOtherSideRunsInTurn) {
    Machine m;
    Pace pace(m.clock(), m.loop());
    const Timing t = measure(m.clock(), pace, m.work(), plan, [&] { m.now += 0.08; });
    EXPECT_NEAR(t.beside_s, 0.08, 1e-9);
    EXPECT_NEAR(t.ratio, 0.8, 1e-9);
}

TEST(Compare, RatioHoldsThroughPhases) {
    Machine m;
    int rounds = 0;
    const auto side = [&](double seconds) { return [&m, &rounds, seconds] { m.now += seconds * (rounds++ / 2 % 2 ? 2 : 1); }; };
    const Comparison c = compare(m.clock(), side(0.2), side(0.1), 6);
    EXPECT_NEAR(c.speedup, 2, 1e-9);
    EXPECT_EQ(c.rounds, 6);
    EXPECT_FALSE(c.pruned);
}

TEST(Compare, EndsAtItsLimitButNotBeforeTwoRounds) {
    Machine m;
    const auto side = [&] { m.now += 0.5; };
    EXPECT_EQ(compare(m.clock(), side, side, 9, 0).rounds, 2);
    EXPECT_EQ(compare(m.clock(), side, side, 9, 3.5).rounds, 4);
}

TEST(Compare, HopelessCandidatesAreGivenUp) {
    Machine m;
    int runs = 0;
    const Comparison c = compare(
        m.clock(), [&] { m.now += 0.1; }, [&] { m.now += 0.15, ++runs; }, 9);
    EXPECT_TRUE(c.pruned);
    EXPECT_EQ(runs, 2);
    EXPECT_LT(c.speedup, 0.7);
    EXPECT_EQ(compare(
                  m.clock(), [] {}, [] {}, 3)
                  .speedup,
              0)
        << "a clock that stands still compares nothing";
}

} // namespace
} // namespace clvr::bench

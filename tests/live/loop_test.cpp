// The loop of a live view by a clock and a painter of the tests' own.
#include "tests/live/fake_loop.hpp"

namespace clvr::testing {
namespace {

using ::testing::ElementsAre;
using Seen = std::vector<std::string>;

TEST(Loop, ShowsASceneInMotionAndThenInFullSizeWithEverMoreSamples) {
    FakeLoop live;
    live.loop.post(scene_at(0, 20), 7);
    live.expect({"7 m 1"});
    live.clock.advance(0.149);
    live.expect({"7 m 1"});
    live.clock.advance(0.001);
    live.expect({"7 m 1", "7 m 1", "7 a 2", "7 a 4", "7 a 8", "7 a 16", "7 s 20"});
    EXPECT_TRUE(live.clock.waits()) << "with no limit: it takes no time";
    EXPECT_EQ(live.painter.draws().size(), 7u);
    for (std::size_t k = 0; k < live.pictures.size(); ++k) {
        const LivePicture& p = *live.pictures[k];
        const Painter::Draw draw = live.painter.draws()[k];
        EXPECT_EQ(p.number, k + 1);
        EXPECT_EQ(draw.moving, k < 2) << "the first one in full size is to be there soon";
        EXPECT_EQ(draw.width, 640 / p.divider);
        EXPECT_EQ(p.pixels.values.size(), 3u);
    }
    EXPECT_EQ(live.pictures.front()->divider, 5) << "nothing is measured yet";
    EXPECT_EQ(live.pictures.back()->divider, 1);
}

TEST(Loop, DoesNothingBeforeTheFirstScene) {
    FakeLoop live;
    EXPECT_TRUE(live.clock.waits());
    EXPECT_TRUE(live.painter.draws().empty());
}

TEST(Loop, OneSampleIsSettledAtOnce) {
    FakeLoop live;
    live.loop.post(scene_at(0, 1), 1);
    live.expect({"1 m 1"});
    live.settle();
    live.expect({"1 m 1", "1 s 1"});
}

TEST(Loop, AMarchIsSettledAtOnce) {
    FakeLoop live;
    Scene scene = scene_at(0, 64);
    scene.mode = Mode::mip;
    live.loop.post(scene, 1);
    live.expect({"1 m 1"});
    live.settle();
    live.expect({"1 m 1", "1 s 1"});
    EXPECT_TRUE(live.clock.waits());
}

TEST(Loop, FinishesAPictureInMotionAndThenShowsTheNewestScene) {
    FakeLoop live;
    live.painter.hold = true;
    live.loop.post(scene_at(0), 1);
    ASSERT_TRUE(live.draws());
    for (int k = 2; k <= 9; ++k) live.loop.post(scene_at(k), static_cast<std::uint64_t>(k));
    live.painter.hold = false;
    live.expect({"1 m 1", "9 m 1"});
    EXPECT_EQ(live.painter.cancelled, 0);
}

TEST(Loop, ANewSceneCancelsAPictureInFullSize) {
    FakeLoop live;
    live.loop.post(scene_at(0), 1);
    live.expect({"1 m 1"});
    live.painter.hold = true;
    live.settle();
    ASSERT_TRUE(live.draws());
    live.loop.post(scene_at(1), 2);
    EXPECT_TRUE(eventually([&] { return live.painter.cancelled == 1; }));
    live.painter.hold = false;
    live.expect({"1 m 1", "2 m 1"});
}

TEST(Loop, StaysInMotionWhileScenesCome) {
    FakeLoop live;
    Seen seen;
    for (int k = 1; k <= 10; ++k) {
        live.loop.post(scene_at(k), static_cast<std::uint64_t>(k));
        seen.push_back(std::to_string(k) + " m 1");
        live.expect(seen);
        live.clock.advance(0.149);
    }
    live.clock.advance(0.001);
    EXPECT_TRUE(eventually([&] { return live.seen().size() > seen.size(); }));
}

TEST(Loop, WhatOnlyShowsTheSamplesInAnotherWayKeepsThem) {
    FakeLoop live;
    Scene scene = scene_at(0, 4);
    live.loop.post(scene, 1);
    live.expect({"1 m 1"});
    scene.exposure = 1;
    live.loop.post(scene, 2);
    live.expect({"1 m 1", "2 m 1"});
    live.settle();
    live.expect({"1 m 1", "2 m 1", "2 a 1", "2 a 2", "2 s 4"});
    scene.tonemap = "reinhard";
    live.loop.post(scene, 3);
    live.expect({"1 m 1", "2 m 1", "2 a 1", "2 a 2", "2 s 4", "3 s 4"});
    EXPECT_EQ(live.painter.draws().back().samples, 4);
    EXPECT_TRUE(live.clock.waits());
}

TEST(Loop, MoreSamplesGoOnAndFewerAreTakenAnew) {
    FakeLoop live;
    live.loop.post(scene_at(0, 4), 1);
    live.expect({"1 m 1"});
    live.settle();
    Seen seen{"1 m 1", "1 m 1", "1 a 2", "1 s 4"};
    live.expect(seen);
    live.loop.post(scene_at(0, 12), 2);
    for (const char* next : {"2 a 4", "2 a 8", "2 s 12"}) seen.push_back(next);
    live.expect(seen);
    live.loop.post(scene_at(0, 3), 3);
    seen.push_back("3 s 3");
    live.expect(seen);
    EXPECT_TRUE(live.clock.waits());
}

TEST(Loop, WithNothingToSeeThereIsNoWork) {
    FakeLoop live;
    live.painter.hold = true;
    live.loop.post(scene_at(1), 1);
    ASSERT_TRUE(live.draws());
    live.loop.pause(true);
    EXPECT_TRUE(eventually([&] { return live.painter.cancelled == 1; })) << "also in motion";
    live.painter.hold = false;
    live.loop.post(scene_at(2, 2), 2);
    live.settle();
    EXPECT_TRUE(live.clock.waits());
    live.expect({});
    live.loop.pause(false);
    live.expect({"2 m 1", "2 m 1", "2 s 2"});
}

TEST(Loop, APauseLosesNoSamples) {
    FakeLoop live;
    live.loop.post(scene_at(0, 4), 1);
    live.expect({"1 m 1"});
    live.settle();
    live.expect({"1 m 1", "1 m 1", "1 a 2", "1 s 4"});
    live.painter.hold = true;
    live.loop.post(scene_at(0, 16), 2); // more of them
    ASSERT_TRUE(live.draws());
    live.loop.pause(true);
    EXPECT_TRUE(eventually([&] { return live.painter.cancelled == 1; }));
    live.painter.hold = false;
    live.expect({"1 m 1", "1 m 1", "1 a 2", "1 s 4"});
    live.loop.pause(false);
    live.expect({"1 m 1", "1 m 1", "1 a 2", "1 s 4", "2 a 4", "2 a 8", "2 s 16"});
}

TEST(Loop, RunsJobsInOrderBetweenPictures) {
    FakeLoop live;
    live.loop.post(scene_at(0, 2), 1);
    live.expect({"1 m 1"});
    live.painter.hold = true;
    live.settle();
    ASSERT_TRUE(live.draws());
    std::vector<int> order;
    for (int k = 0; k < 3; ++k)
        live.loop.run([&, k](Painter& painter) {
            EXPECT_EQ(&painter, &live.painter);
            EXPECT_EQ(live.painter.held, 0);
            order.push_back(k);
            if (k == 2) live.painter.hold = false;
        });
    live.expect({"1 m 1", "1 m 1", "1 s 2"});
    EXPECT_EQ(live.painter.cancelled, 1);
    EXPECT_THAT(order, ElementsAre(0, 1, 2));
}

TEST(Loop, RunsJobsWhileNobodyLooksAndBeforeThereIsAScene) {
    FakeLoop live;
    live.loop.pause(true);
    std::atomic<bool> done{false};
    live.loop.run([&](Painter&) { done = true; });
    EXPECT_TRUE(eventually([&] { return done.load(); }));
    EXPECT_TRUE(live.painter.draws().empty());
}

TEST(Loop, AJobMayPostAndRunMore) {
    FakeLoop live;
    live.loop.run([&](Painter&) { live.loop.run([&](Painter&) { live.loop.post(scene_at(3), 5); }); });
    live.expect({"5 m 1"});
}

TEST(Loop, AJobThatThrowsIsReported) {
    FakeLoop live;
    live.loop.post(scene_at(0), 4);
    live.expect({"4 m 1"});
    live.loop.run([](Painter&) { throw Error(ErrorKind::input, "cannot be written", "x.png"); });
    live.loop.run([](Painter&) { throw std::runtime_error("odd"); });
    EXPECT_TRUE(eventually([&] { return live.said(live.failures).size() == 2; }));
    EXPECT_THAT(live.said(live.failures), ElementsAre("4 x.png: cannot be written", "4 odd"));
    live.settle();
    live.expect({"4 m 1", "4 m 1", "4 a 2", "4 a 4", "4 s 8"});
}

TEST(Loop, ASceneThatCannotBeDrawnLeavesTheFormerOne) {
    FakeLoop live;
    live.loop.post(scene_at(0, 2), 1);
    live.expect({"1 m 1"});
    Scene bad = scene_at(1);
    bad.seed = FakePainter::bad_seed;
    live.loop.post(bad, 2);
    EXPECT_TRUE(eventually([&] { return live.said(live.failures).size() == 1; }));
    EXPECT_THAT(live.said(live.failures), ElementsAre("2 --seed: is bad"));
    live.settle();
    live.expect({"1 m 1", "1 m 1", "1 s 2"});
    live.loop.post(scene_at(1, 2), 3);
    live.expect({"1 m 1", "1 m 1", "1 s 2", "3 m 1"});
}

TEST(Loop, APictureThatFailsIsNotTriedAgainUntilTheSceneChanges) {
    FakeLoop live;
    live.painter.fails = true;
    live.loop.post(scene_at(0), 1);
    EXPECT_TRUE(eventually([&] { return live.said(live.failures).size() == 1; }));
    EXPECT_THAT(live.said(live.failures), ElementsAre("1 device 0: broke"));
    live.settle();
    EXPECT_TRUE(live.clock.waits());
    EXPECT_EQ(live.painter.draws().size(), 1u);
    live.loop.post(scene_at(0), 2); // the same once more
    live.expect({"2 m 1"});
}

TEST(Loop, PassesWarningsOn) {
    FakeLoop live;
    live.painter.warn("nothing is visible");
    live.loop.post(scene_at(0), 1);
    EXPECT_TRUE(eventually([&] { return live.said(live.warnings).size() == 1; }));
    EXPECT_THAT(live.said(live.warnings), ElementsAre("nothing is visible"));
}

TEST(Loop, EndsWhileItDraws) {
    FakeLoop live;
    live.painter.hold = true;
    live.loop.post(scene_at(0), 1);
    ASSERT_TRUE(live.draws());
    live.running.reset();
    EXPECT_EQ(live.painter.cancelled, 1);
    EXPECT_TRUE(live.seen().empty());
}

TEST(Loop, AtItsEndWaitsForTheJobThatRunsAndDropsTheRest) {
    FakeLoop live;
    std::atomic<int> begun{0}, done{0};
    live.loop.run([&](Painter&) {
        ++begun;
        linger();
        ++done;
    });
    ASSERT_TRUE(eventually([&] { return begun == 1; }));
    live.loop.run([&](Painter&) { ++begun; });
    live.running.reset();
    EXPECT_EQ(done, 1);
    EXPECT_EQ(begun, 1);
}

TEST(Loop, PicturesInMotionFitTheBudget) {
    FakeLoop live;
    live.painter.us_per_pixel = 0.1; // 640x640 in 41 ms
    live.loop.post(scene_at(0), 1);
    live.expect({"1 m 1"});
    live.loop.post(scene_at(1), 2);
    live.expect({"1 m 1", "2 m 1"});
    EXPECT_EQ(live.pictures.back()->divider, 1);
    live.painter.us_per_pixel = 1.5; // 614 ms
    live.loop.post(scene_at(2), 3);
    live.loop.post(scene_at(2.5), 3);
    EXPECT_TRUE(eventually([&] { return live.seen().back() == "3 m 1"; }));
    for (int k = 4; k < 9; ++k) {
        live.loop.post(scene_at(k), static_cast<std::uint64_t>(k));
        EXPECT_TRUE(eventually([&] { return live.seen().back() == std::to_string(k) + " m 1"; }));
    }
    const LivePicture& last = *live.pictures.back();
    EXPECT_EQ(last.divider, 3);
    EXPECT_NEAR(last.elapsed_ms, 213 * 213 * 1.5e-3, 1e-9);
}

TEST(Loop, APictureShownAgainSaysNothingOfTheCost) {
    FakeLoop live;
    live.painter.us_per_pixel = 1;
    live.loop.post(scene_at(0), 1);
    live.expect({"1 m 1"});
    live.painter.us_per_pixel = 0; // of what is there
    Scene brighter = scene_at(0);
    brighter.exposure = 1;
    live.loop.post(brighter, 2);
    live.expect({"1 m 1", "2 m 1"});
    live.painter.us_per_pixel = 1;
    live.loop.post(scene_at(1), 3);
    live.expect({"1 m 1", "2 m 1", "3 m 1"});
    EXPECT_EQ(live.pictures.back()->divider, 3);
}

TEST(Loop, ManyThreadsMayPostPauseAndRun) {
    FakeLoop live;
    std::atomic<int> jobs{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&, t] {
            for (int k = 0; k < 100; ++k) {
                live.loop.post(scene_at(t * 100 + k), static_cast<std::uint64_t>(k));
                live.loop.pause(k % 2 == 0);
                live.loop.run([&](Painter&) { ++jobs; });
            }
        });
    for (std::thread& thread : threads) thread.join();
    live.loop.pause(false);
    live.loop.post(scene_at(-1, 2), 1000);
    EXPECT_TRUE(eventually([&] { return jobs == 400; }));
    EXPECT_TRUE(eventually([&] { return !live.seen().empty() && live.seen().back() == "1000 m 1"; }));
    live.settle();
    EXPECT_TRUE(eventually([&] { return live.seen().back() == "1000 s 2"; }));
}

} // namespace
} // namespace clvr::testing

// The same bits: the hashes of small scenes do not change with tunables, tiles, pools of bricks, devices, runs, passes.
#include "runtime/trust/trust.hpp"
#include "tests/render/golden.hpp"

namespace clvr::testing {
namespace {

TEST(Golden, PicturesHaveTheirHashes) {
    for (const auto& [name, hash] : golden_hashes) {
        const std::string found = pixel_hash(render_golden(name, {shared_device()}));
        EXPECT_EQ(found, hash) << "the picture of \"" << name << "\" changed; now:\n{\"" << name << "\", \"" << found << "\"},";
    }
}

TEST(Golden, TilesAndWavesGiveTheSameBits) {
    for (int pixels : {16, 100, 1000}) expect_golden("automatic", {{"tile_pixels", pixels}});
    for (int paths : {64, 1000}) expect_golden("automatic", {{"wave_paths", paths}});
    expect_golden("phase", {{"wave_paths", 333}, {"tile_pixels", 50}});
}

TEST(Golden, BrickEdgesGiveTheSameBits) {
    for (int log2_edge : {3, 4, 5}) {
        expect_golden("automatic", {{"brick_log2", log2_edge}});
        expect_golden("gradient", {{"brick_log2", log2_edge}});
    }
}

TEST(Golden, TwoPoolsGiveTheSameBits) { expect_golden_in_pools("automatic", 2, "3M"); }

TEST(Golden, TwoSubDevicesGiveTheSameBits) {
    std::vector<Device> devices;
    try {
        for (const DeviceFacts& facts : select_devices("cpu/2").devices) devices.push_back(open_trusted(facts));
    } catch (const Error& e) {
        GTEST_SKIP() << e.line(); // one compute unit
    }
    ASSERT_EQ(devices.size(), 2u);
    for (Device& d : devices) d.set_tunable("tile_pixels", 64);
    for (const char* name : {"automatic", "gradient", "dvr"})
        EXPECT_EQ(pixel_hash(render_golden(name, devices)), golden_hashes.at(name)) << name;
}

TEST(Golden, RepeatsWithinOneSessionAndAfterTurning) {
    const Scene scene = golden_scene("automatic");
    RenderSession session({shared_device()}, golden_volume(), scene);
    EXPECT_EQ(pixel_hash(clvr::render(session, scene)), golden_hashes.at("automatic"));
    Scene from_there = scene;
    from_there.camera.azimuth += 90;
    from_there.view = 1;
    session.set_view(from_there);
    const Frame other = clvr::render(session, from_there);
    EXPECT_NE(pixel_hash(other), golden_hashes.at("automatic"));
    EXPECT_EQ(pixel_hash(clvr::render({shared_device()}, golden_volume(), from_there)), pixel_hash(other));
    session.set_view(scene);
    EXPECT_EQ(pixel_hash(clvr::render(session, scene)), golden_hashes.at("automatic"));
}

TEST(Golden, TurnsToOtherFrames) {
    const Scene scene = golden_scene("automatic");
    Scene other = scene;
    other.camera.elevation += 40;
    other.view = 3;
    other.seed += 7;
    other.spp = scene.spp + 2;
    other.features = false;
    RenderSession session({shared_device()}, golden_volume(), other);
    clvr::render(session, other);
    session.set_view(scene);
    EXPECT_EQ(pixel_hash(clvr::render(session, scene)), golden_hashes.at("automatic"));
    session.set_view(other);
    const Frame there = clvr::render(session, other);
    EXPECT_FALSE(there.has("albedo.R"));
    EXPECT_EQ(pixel_hash(there), pixel_hash(clvr::render({shared_device()}, golden_volume(), other)));
}

/// Passes of 1, 2, 4 ... samples: a rendering that stops early is the one that asked for no more.
TEST(Golden, AStoppedRenderingIsTheOneThatAskedForNoMore) {
    const PreparedVolume& volume = golden_volume();
    Scene scene = golden_scene("automatic");
    scene.spp = 1000;
    std::atomic<bool> cancelled{false};
    RenderControl control;
    control.cancelled = &cancelled;
    control.progress = [&](const RenderProgress& p) {
        if (p.samples >= 7) cancelled = true;
    };
    const Frame stopped = clvr::render({shared_device()}, volume, scene, {}, control);
    ASSERT_EQ(stopped.attributes.at("clvr.spp"), "7");
    scene.spp = 7;
    EXPECT_EQ(pixel_hash(clvr::render({shared_device()}, volume, scene)), pixel_hash(stopped));
}

TEST(Golden, ATimeLimitKeepsWholePasses) {
    const PreparedVolume& volume = golden_volume();
    Scene scene = golden_scene("phase");
    scene.spp = 1 << 20;
    RenderControl control;
    control.seconds = 0.5;
    const Frame limited = clvr::render({shared_device()}, volume, scene, {}, control);
    scene.spp = std::stoi(limited.attributes.at("clvr.spp"));
    ASSERT_GE(scene.spp, 1);
    ASSERT_LT(scene.spp, 1 << 20);
    EXPECT_EQ(pixel_hash(clvr::render({shared_device()}, volume, scene)), pixel_hash(limited));
}

TEST(Golden, SeedAndViewChangeTheNoiseOnly) {
    Scene scene = golden_scene("automatic");
    const auto picture = [&] { return clvr::render({shared_device()}, golden_volume(), scene); };
    const Frame first = picture();
    scene.seed += 1;
    const Frame reseeded = picture();
    scene.seed -= 1;
    scene.view = 1;
    const Frame other_view = picture();
    for (const Frame* f : {&reseeded, &other_view}) {
        EXPECT_NE(f->at("R"), first.at("R"));
        EXPECT_EQ(f->at("opacity.A"), first.at("opacity.A"));
    }
    EXPECT_NE(reseeded.at("R"), other_view.at("R"));
}

} // namespace
} // namespace clvr::testing

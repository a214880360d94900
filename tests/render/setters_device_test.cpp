// The rendering session's parts, changed one by one: the same bits as one made for it, and no more bytes to the device than the part has.
#include "tests/render/bytes_written.hpp"
#include "tests/render/several_devices.hpp"

namespace clvr::testing {
namespace {

/// Two samples and the features.
Frame seen(RenderSession& session) {
    session.march_features(1);
    session.accumulate(2);
    return session.frame();
}

TEST(Setters, WriteTheirOwnPartAlone) {
    Device device = open_device();
    const PreparedVolume volume(
        volume_of<std::uint8_t>({128, 96, 80}, [](int x, int y, int z) { return x > 96 ? 250 : (x * 11 + y * 7 + z * 5) % 200; }));
    Scene scene = wavy_scene();
    scene.transfer->points = {{0, {1, 1, 1}, 0}, {240, {1, 1, 1}, 0}, {250, {1, 1, 1}, 1}}; // the far quarter
    // Transfer table, mean opacity of cells of 2 voxels, and little things.
    constexpr double tables = 4096 * 20 + 4097 * 4 + 64 * 48 * 40 * 4 + (64 << 10);
    RenderSession session({device});
    const double voxels = 128.0 * 96 * 80, all = bytes_written(device, [&] {
                                               session.set_scene(volume, scene);
                                               seen(session);
                                           });
    EXPECT_LT(all, 0.6 * voxels + tables) << "bricks that nothing shows were uploaded";

    scene.camera.azimuth += 25;
    EXPECT_LT(bytes_written(device,
                            [&] {
                                session.set_view(scene);
                                seen(session);
                            }),
              4096);
    scene.transfer->points[2].color = {0.2, 0.3, 0.9}; // shows nothing more
    EXPECT_LT(bytes_written(device,
                            [&] {
                                session.set_appearance(scene);
                                seen(session);
                            }),
              tables);
    scene.transfer->points[0].opacity = scene.transfer->points[1].opacity = 0.5; // shows all
    const double more = bytes_written(device, [&] {
        session.set_appearance(scene);
        seen(session);
    });
    EXPECT_GT(more, 0.5 * voxels);
    EXPECT_LT(more, 1.1 * voxels + tables) << "bricks that were there were uploaded again";
    scene.light.key_azimuth += 90;
    EXPECT_LT(bytes_written(device,
                            [&] {
                                session.set_lights(scene.light);
                                seen(session);
                            }),
              8192);
    session.restart(); // seen() would go on
    expect_same(seen(session), [&] {
        RenderSession anew({device}, volume, scene);
        return seen(anew);
    }());
}

TEST(Setters, GiveTheBitsOfASessionMadeForIt) {
    const PreparedVolume volume = wavy_volume(), other(constant_volume({40, 30, 20}));
    Scene scene = wavy_scene();
    RenderSession session({shared_device()}, volume, scene);
    seen(session);
    const auto expect = [&](const char* what, const PreparedVolume& shown) {
        SCOPED_TRACE(what);
        RenderSession anew({shared_device()}, shown, scene);
        expect_same(seen(session), seen(anew));
        expect_same(seen(session), seen(anew)); // each goes on where it stopped
    };
    scene.clip_plane = ClipPlane{{1, 0.5, 0}, 12};
    scene.extinction = 0.4;
    session.set_appearance(scene);
    expect("appearance", volume);
    scene.light.environment = Light::Environment::constant;
    scene.light.headlight = 0.7; // one key light more
    session.set_lights(scene.light);
    expect("lights", volume);
    scene.width = 38, scene.height = 70;
    session.set_size(scene.width, scene.height);
    expect("size", volume);
    scene.seed = 9, scene.view = 4, scene.bounces = 2, scene.camera.elevation = 60;
    session.set_view(scene);
    expect("view", volume);
    session.set_volume(other); // alone: the appearance stays
    expect("volume", other);
}

TEST(Accumulating, GoesOnWhereItStopped) {
    const PreparedVolume volume = wavy_volume();
    Scene scene = wavy_scene();
    scene.spp = 23;
    scene.features = false;
    const Frame at_once = clvr::render({shared_device()}, volume, scene);
    RenderSession session({shared_device()}, volume, scene);
    for (const int more : {1, 5, 17}) session.accumulate(more);
    expect_same(session.frame(), at_once);
    session.march_features(4); // beside the samples
    EXPECT_EQ(session.accumulate(0), 23);
    EXPECT_EQ(session.frame().at("R"), at_once.at("R"));
    session.march_picture(Mode::dvr, 4); // in their place
    EXPECT_FALSE(session.frame().has("variance.R"));
    EXPECT_EQ(session.accumulate(23), 23);
    EXPECT_EQ(session.frame().at("R"), at_once.at("R"));
}

TEST(Accumulating, CancelledKeepsWholePassesAndGoesOn) {
    const PreparedVolume volume = wavy_volume();
    Scene scene = wavy_scene();
    scene.features = false;
    Device device = open_device();
    device.set_tunable("wave_paths", 1024); // several waves a pass
    RenderSession session({device}, volume, scene);
    std::atomic<bool> cancelled{false};
    RenderControl control;
    control.cancelled = &cancelled;
    control.progress = [&](const RenderProgress& p) { cancelled = p.samples == 1; }; // in the second pass, of 2 samples
    EXPECT_EQ(session.accumulate(scene.spp, control), 1);
    const Frame stopped = session.frame();
    EXPECT_EQ(session.accumulate(scene.spp - 1), scene.spp);
    expect_same(session.frame(), clvr::render({shared_device()}, volume, scene));
    scene.spp = 1;
    expect_same(stopped, clvr::render({shared_device()}, volume, scene));
}

TEST(Film, KeptOnTheHostGivesTheSameBits) {
    const PreparedVolume volume = wavy_volume();
    for (const Mode mode : {Mode::path, Mode::dvr}) {
        Scene scene = wavy_scene();
        scene.mode = mode;
        scene.width = 301, scene.height = 299;
        scene.spp = 3;
        scene.background.kind = Background::Kind::environment;
        RenderSession there({shared_device()}, volume, scene);
        const Frame expected = clvr::render(there, scene);
        ASSERT_NE(there.film(), nullptr);
        Device device = open_device();
        device.set_memory_limit(device.used_bytes() + (24 << 20));
        RenderSession here({device}, volume, scene);
        expect_same(clvr::render(here, scene), expected);
        EXPECT_EQ(here.film(), nullptr);
    }
}

TEST(Film, HoldsWhatTheFrameHas) {
    const PreparedVolume volume = wavy_volume();
    RenderSession session({shared_device()}, volume, wavy_scene());
    const Frame frame = seen(session);
    Film* const film = session.film();
    ASSERT_NE(film, nullptr);
    EXPECT_EQ(film->samples, 2);
    for (const auto& [name, values] : frame.channels) EXPECT_EQ(film->download(name), values) << name;
    EXPECT_EQ(film->find("no such plane"), -1);
    const std::vector<float> red = frame.at("R");
    film->require({"one.more", "and.another", "a.third", "a.fourth", "a.fifth", "a.sixth", "a.seventh", "an.eighth", "a.ninth"});
    EXPECT_EQ(film->download("R"), red) << "growing loses planes";
    EXPECT_EQ(film->require({"and.another"}), film->find("one.more") + 1);
    EXPECT_THROW(film->require({"and.another", "one.more"}), Error);
    EXPECT_THROW(film->require({"new", "one.more"}), Error);
}

} // namespace
} // namespace clvr::testing

// The painter of a live view: whatever was drawn before, its pictures have the bits of a session made for them.
#include "tests/live/painted.hpp"
#include "tests/render/bytes_written.hpp"
#include "tests/runtime/faulty_devices.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <functional>
#include <thread>

namespace clvr::testing {
namespace {

TEST(SessionPainter, ShowsAtEverySampleWhatARenderOfSoManyWrites) {
    SessionPainter painter = painter_of();
    const Scene scene = wavy_scene();
    EXPECT_TRUE(painter.set_scene(scene));
    for (const int samples : {1, 2, 4, 7}) {
        SCOPED_TRACE(samples);
        const Painter::Drawn picture = in_full_size(painter, scene, samples);
        EXPECT_EQ(picture.samples, samples);
        expect_same(picture.pixels, rendered(scene, samples));
        expect_same(in_full_size(painter, scene, samples).pixels, picture.pixels);
    }
    expect_same(painter.still(scene, {}), rendered(scene));
}

TEST(SessionPainter, PicturesInMotionLeaveNoTrace) {
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    for (const auto& [width, height] : {std::pair{30, 21}, {61, 43}, {20, 14}, {61, 43}}) {
        scene.camera.azimuth += 7;
        EXPECT_TRUE(painter.set_scene(scene));
        const Painter::Drawn moving = in_motion(painter, width, height);
        EXPECT_EQ(moving.samples, 1);
        EXPECT_EQ(moving.pixels.width, width);
        expect_same(in_full_size(painter, scene, 1).pixels, rendered(scene, 1)); // of the full size: its sample stays, its features do not
        expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, 2));
    }
}

TEST(SessionPainter, EditsGiveTheBitsOfASceneMadeSo) {
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    painter.set_scene(scene);
    in_full_size(painter, scene, 2);
    const auto expect = [&](const char* what, bool anew, const std::function<void(Scene&)>& edit) {
        SCOPED_TRACE(what);
        edit(scene);
        EXPECT_EQ(painter.set_scene(scene), anew);
        if (anew) in_motion(painter, 30, 21);
        expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, scene.mode == Mode::path ? 2 : 0));
    };
    expect("colour", true, [](Scene& s) { s.transfer->points[1].color = {0.2, 0.3, 0.9}; });
    expect("automatic transfer function", true, [](Scene& s) { s.transfer.reset(); });
    expect("extinction", true, [](Scene& s) { s.extinction = 0.4; });
    expect("clip", true, [](Scene& s) { s.clip_plane = ClipPlane{{1, 0.5, 0}, 12}; });
    expect("light", true, [](Scene& s) { s.light.key_azimuth = 70; });
    expect("camera", true, [](Scene& s) { s.camera.elevation = 60; });
    expect("seed", true, [](Scene& s) { s.seed = 5; });
    expect("exposure", false, [](Scene& s) { s.exposure = 1.5; });
    expect("tone curve", false, [](Scene& s) { s.tonemap = "aces"; });
    expect("feature rays", false, [](Scene& s) { s.feature_samples = 1; });
    expect("feature rays back", false, [](Scene& s) { s.feature_samples = 4; });
    expect("background", false, [](Scene& s) { s.background.kind = Background::Kind::environment; });
    expect("light over background", true, [](Scene& s) { s.light.level = 0.5; });
    expect("dvr", true, [](Scene& s) { s.mode = Mode::dvr; });
    expect("rays of dvr", true, [](Scene& s) { s.feature_samples = 1; });
    expect("mip", true, [](Scene& s) { s.mode = Mode::mip; });
    expect("path", true, [](Scene& s) { s.mode = Mode::path; });
    expect("size", true, [](Scene& s) { s.width = 48, s.height = 52; });
}

TEST(SessionPainter, GoesOnAfterACancelledPicture) {
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    scene.spp = 64;
    painter.set_scene(scene);
    const std::atomic<bool> at_once{true};
    EXPECT_FALSE(painter.draw({scene.width, scene.height, 1, false}, at_once));
    EXPECT_FALSE(painter.draw({30, 20, 1, true}, at_once));
    for (int delay_ms = 1; delay_ms < 40; delay_ms *= 2) {
        std::atomic<bool> cancelled{false};
        std::thread canceller([&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
            cancelled = true;
        });
        painter.draw({scene.width, scene.height, 64, false}, cancelled);
        canceller.join();
    }
    const Painter::Drawn picture = in_full_size(painter, scene, 1);
    expect_same(picture.pixels, rendered(scene, picture.samples));
    expect_same(in_full_size(painter, scene, 64).pixels, rendered(scene));
}

TEST(SessionPainter, FewerSamplesAreTakenAnewAndMoreGoOn) {
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    painter.set_scene(scene);
    in_full_size(painter, scene, 7);
    EXPECT_EQ(in_full_size(painter, scene, 4).samples, 7) << "they are there, and the scene wants them";
    scene.spp = 3;
    EXPECT_FALSE(painter.set_scene(scene));
    EXPECT_EQ(in_full_size(painter, scene, 3).samples, 3);
    expect_same(in_full_size(painter, scene, 3).pixels, rendered(scene));
    scene.spp = 9;
    EXPECT_FALSE(painter.set_scene(scene));
    expect_same(in_full_size(painter, scene, 9).pixels, rendered(scene));
}

TEST(SessionPainter, AStillIsTheSamplesThatAreThereAndThoseThatLack) {
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    painter.set_scene(scene);
    in_full_size(painter, scene, 4);
    int fewest = scene.spp;
    RenderControl control;
    control.progress = [&](const RenderProgress& p) { fewest = std::min(fewest, p.samples); };
    expect_same(painter.still(scene, control), rendered(scene));
    EXPECT_EQ(fewest, 4);
    control.progress = [&](const RenderProgress&) { ADD_FAILURE() << "nothing lacked"; };
    expect_same(painter.still(scene, control), rendered(scene));
    EXPECT_EQ(in_full_size(painter, scene, 4).samples, 7) << "the view has them, too";
}

TEST(SessionPainter, StillsOfOtherScenesLeaveTheViewAsItWas) {
    SessionPainter painter = painter_of();
    const Scene scene = wavy_scene();
    painter.set_scene(scene);
    in_full_size(painter, scene, 4);
    Scene other = scene;
    other.width = 70, other.height = 30, other.spp = 3;
    other.camera.azimuth = 200;
    other.transfer->points[1].color = {0.2, 0.3, 0.9};
    other.background = {Background::Kind::color, {0.1, 0.2, 0.3}};
    expect_same(painter.still(other, {}), rendered(other));
    EXPECT_FALSE(painter.set_scene(scene)) << "it is still the scene";
    expect_same(in_full_size(painter, scene, 4).pixels, rendered(scene, 4));

    const std::atomic<bool> at_once{true};
    RenderControl control;
    control.cancelled = &at_once;
    try {
        painter.still(other, control);
        FAIL() << "it was cancelled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    }
    expect_same(in_full_size(painter, scene, 7).pixels, rendered(scene));
}

TEST(SessionPainter, AFrameHasAllChannels) {
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    const auto expect = [&](const std::optional<Model>& model) {
        expect_same(painter.frame(scene, {}), rendered(*wavy(), scene, 0, model, true,
                                                       [](RenderSession& session, const Scene& s) { return session.frame(s.background); }));
    };
    painter.set_scene(scene);
    in_full_size(painter, scene, 4);
    painter.position_at(0.5, 0.5);
    expect(default_model());
    in_full_size(painter, scene, 7);
    scene.features = false;
    RenderControl control;
    control.progress = [&](const RenderProgress& p) { EXPECT_EQ(p.samples, 7) << "the samples were there"; };
    painter.frame(scene, control);
    expect(default_model());
    scene.mode = Mode::dvr;
    painter.set_scene(scene);
    painter.position_at(0.5, 0.5);
    expect({});
    scene.features = true;
    expect({});
}

TEST(SessionPainter, WithoutAModelShowsTheSamples) {
    SessionPainter painter = painter_of({shared_device()}, {});
    const Scene scene = wavy_scene();
    painter.set_scene(scene);
    expect_same(in_motion(painter, scene.width, scene.height).pixels, rendered(scene, 1, *wavy(), {}));
    expect_same(in_full_size(painter, scene, 7).pixels, rendered(scene, 7, *wavy(), {}));
}

TEST(SessionPainter, SeveralDevicesShowTheSameBits) {
    for (const int rays : {1, 4})
        for (const Model* model : {&default_model(), &unlit_model()}) {
            SessionPainter painter = painter_of(two_devices(), *model);
            Scene scene = wavy_scene();
            scene.feature_samples = rays;
            painter.set_scene(scene);
            for (const int samples : {1, 2, 7}) {
                in_motion(painter, scene.width, scene.height); // the features may go, the samples stay
                expect_same(in_full_size(painter, scene, samples).pixels, rendered(scene, samples, *wavy(), *model));
            }
            expect_same(painter.still(scene, {}), rendered(scene, 7, *wavy(), *model));
        }
}

TEST(SessionPainter, ADeviceThatIsLostIsLeftOutAndSaid) {
    if (faulty_devices("delay:1").empty()) GTEST_SKIP() << "the device has no parts";
    const Warnings quiet;
    SessionPainter painter = painter_of(faulty_devices("launch:60", 2, 2));
    const std::string both = painter.device();
    Scene scene = wavy_scene();
    scene.spp = 16;
    painter.set_scene(scene);
    expect_same(in_full_size(painter, scene, 16).pixels, rendered(scene));
    EXPECT_THAT(painter.take_warnings(), ::testing::ElementsAre(::testing::HasSubstr("failed and is left out")));
    EXPECT_LT(painter.device().size(), both.size());
    scene.camera.azimuth += 10;
    painter.set_scene(scene);
    expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, 2));
    EXPECT_TRUE(painter.take_warnings().empty());
}

TEST(SessionPainter, WhatCannotBeDrawnLeavesTheFormerScene) {
    SessionPainter painter = painter_of();
    const Scene scene = wavy_scene();
    painter.set_scene(scene);
    in_full_size(painter, scene, 2);
    const auto refuse = [&](const std::function<void(Scene&)>& edit) {
        Scene bad = scene;
        edit(bad);
        EXPECT_THROW(painter.set_scene(bad), Error);
        EXPECT_THROW(painter.still(bad, {}), Error);
        expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, 2));
    };
    refuse([](Scene& s) { s.spp = 0; });
    refuse([](Scene& s) { s.tonemap = "linear"; });
    refuse([](Scene& s) { s.transfer->points[1].value = -1; });
    refuse([](Scene& s) { s.light.environment = Light::Environment::image, s.light.image = "none.hdr"; });
    EXPECT_THROW(painter.draw({largest_frame_side * 64, largest_frame_side * 64, 1, false}, never), Error);
    expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, 2));
}

TEST(SessionPainter, SaysOnceThatNothingIsVisible) {
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    for (TransferFunction::Point& point : scene.transfer->points) point.opacity = 0;
    painter.set_scene(scene);
    EXPECT_THAT(painter.take_warnings(), ::testing::ElementsAre(::testing::HasSubstr("nothing is visible")));
    scene.transfer->points[0].color = {1, 0, 0};
    painter.set_scene(scene);
    EXPECT_TRUE(painter.take_warnings().empty());
    EXPECT_FALSE(painter.position_at(0.5, 0.5));
}

TEST(SessionPainter, ReadsAnEnvironmentOnceForEachImage) {
    int reads = 0;
    const EnvironmentTables tables = environment_tables(2, 2, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, 1);
    SessionPainter painter({shared_device()}, wavy(), default_model(), [&](const Scene& s) {
        ++reads;
        EXPECT_EQ(s.light.image, "a.hdr");
        return tables;
    });
    Scene scene = wavy_scene();
    painter.set_scene(scene);
    scene.light.environment = Light::Environment::image;
    scene.light.image = "a.hdr";
    for (const double rotation : {0.0, 30.0}) {
        scene.light.image_rotation = rotation;
        painter.set_scene(scene);
        expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, 2, *wavy(), default_model(), tables));
    }
    EXPECT_EQ(reads, 1);
}

TEST(SessionPainter, AnotherVolumeTakesThePlaceOfTheFirst) {
    const auto other = std::make_shared<const PreparedVolume>(
        volume_of<std::uint8_t>({20, 30, 16}, [](int x, int y, int z) { return (x * 3 + y * 5 + z * 7) % 200; }));
    SessionPainter painter = painter_of();
    Scene scene = wavy_scene();
    scene.transfer.reset(); // the automatic one of each
    painter.set_scene(scene);
    in_full_size(painter, scene, 2);
    painter.set_volume(other);
    expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, 2, *other));
    EXPECT_TRUE(painter.set_scene(scene)) << "its samples are of another volume";
    expect_same(in_full_size(painter, scene, 2).pixels, rendered(scene, 2, *other));
}

TEST(SessionPainter, PositionsLieWhereThePictureShowsThem) {
    constexpr double radius = 24;
    const Int3 dims{64, 64, 64};
    const auto ball = std::make_shared<const PreparedVolume>(volume_of<std::uint8_t>(dims, [&](int x, int y, int z) {
        const double r = std::sqrt((x - 31.5) * (x - 31.5) + (y - 31.5) * (y - 31.5) + (z - 31.5) * (z - 31.5));
        return static_cast<int>(std::clamp(128 + 32 * (radius - r), 0.0, 255.0));
    }));
    const Double3 centre = ball->voxels.geometry.to_world({31.5, 31.5, 31.5});
    Scene scene = wavy_scene();
    scene.transfer->points = {{127, {1, 1, 1}, 0}, {129, {1, 1, 1}, 1}};
    scene.extinction = 20;
    scene.camera.eye = centre + Double3{0, -120, 0};
    scene.camera.target = centre;
    scene.camera.height = 64;
    for (const bool orthographic : {false, true})
        for (const Mode mode : {Mode::path, Mode::dvr})
            for (const std::vector<Device>& devices : {std::vector<Device>{shared_device()}, two_devices()}) {
                scene.camera.orthographic = orthographic;
                scene.mode = mode;
                SessionPainter painter(devices, ball, default_model(), no_environment);
                EXPECT_FALSE(painter.position_at(0.5, 0.5)) << "there is no scene";
                painter.set_scene(scene);
                const auto expect = [&] {
                    const std::optional<Double3> middle = painter.position_at(0.5, 0.5);
                    ASSERT_TRUE(middle);
                    EXPECT_NEAR(norm(*middle - centre), radius, 0.5);
                    EXPECT_LT(norm(*middle - (centre - Double3{0, radius, 0})), 2) << "a pixel is 2 mm";
                    // x to the right is the patient's left, as seen from the front; z is up.
                    const std::optional<Double3> aside = painter.position_at(0.6, 0.35);
                    ASSERT_TRUE(aside);
                    EXPECT_NEAR(norm(*aside - centre), radius, 0.5);
                    EXPECT_GT((*aside - centre)[0], 4);
                    EXPECT_GT((*aside - centre)[2], 4);
                    EXPECT_FALSE(painter.position_at(0.02, 0.02));
                    EXPECT_FALSE(painter.position_at(1, 1));
                };
                expect(); // before a picture
                in_motion(painter, 30, 21);
                expect();
                const DisplayPixels before = in_full_size(painter, scene, 2).pixels;
                expect();
                expect_same(in_full_size(painter, scene, 2).pixels, before);
                Scene other = scene;
                other.width = other.height = 16;
                other.camera.eye = centre + Double3{0, 120, 0};
                painter.still(other, {});
                expect();
            }
}

TEST(SessionPainter, ACameraCostsNoUploadOfTheVolume) {
    Device device = open_device();
    const auto large = std::make_shared<const PreparedVolume>(constant_volume({100, 100, 100}));
    SessionPainter painter({device}, large, default_model(), no_environment);
    Scene scene = wavy_scene();
    const auto draw = [&] {
        painter.set_scene(scene);
        in_motion(painter, 30, 21);
        in_full_size(painter, scene, 1);
    };
    EXPECT_GT(bytes_written(device, draw), 1e6);
    scene.camera.azimuth += 10;
    EXPECT_LT(bytes_written(device, draw), 2e5);
}

TEST(SessionPainter, TakesNoMoreMemoryHoweverOftenSizesChange) {
    Device device = open_device();
    SessionPainter painter = painter_of({device});
    Scene scene = wavy_scene();
    const auto turn = [&] {
        for (const auto& [width, height] : {std::pair{30, 21}, {61, 43}, {20, 14}, {15, 10}}) {
            scene.camera.azimuth += 3;
            painter.set_scene(scene);
            in_motion(painter, width, height);
        }
        in_full_size(painter, scene, 2);
        Scene still = scene;
        still.width = 90;
        painter.still(still, {});
        in_motion(painter, 30, 21);
    };
    turn();
    turn();
    const std::size_t left = device.free_bytes();
    for (int k = 0; k < 5; ++k) turn();
    EXPECT_EQ(device.free_bytes(), left);
}

} // namespace
} // namespace clvr::testing

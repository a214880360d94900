// Several devices at once: the same bits as from one.
#include "tests/render/several_devices.hpp"

namespace clvr::testing {
namespace {

TEST(SeveralDevices, GiveTheBitsOfOne) {
    const PreparedVolume volume = wavy_volume();
    std::vector<Device> parts = open_two_devices(), twice{shared_device(), open_device()}; // these have contexts and volumes of their own
    parts[1].set_tunable("packet", 4);
    for (const Mode mode : {Mode::path, Mode::dvr}) {
        Scene scene = wavy_scene();
        scene.mode = mode;
        scene.background.kind = Background::Kind::environment;
        const Frame one = Renderer({shared_device()}, volume, scene).render();
        ASSERT_EQ(one.has("variance.R"), mode == Mode::path);
        expect_same(Renderer(parts, volume, scene).render(), one);
        if (mode == Mode::path) expect_same(Renderer(twice, volume, scene).render(), one);
    }
}

TEST(SeveralDevices, SubDevicesShareTheVolume) {
    const std::vector<Device> devices = two_devices();
    if (devices[0].context()() != devices[1].context()()) GTEST_SKIP() << "not two parts of one device";
    const PreparedVolume volume(constant_volume({64, 64, 64}));
    Scene scene = wavy_scene();
    const std::size_t before = devices[0].used_bytes();
    const Renderer one({devices[0]}, volume, scene);
    const std::size_t alone = devices[0].used_bytes() - before;
    const Renderer both(devices, volume, scene);
    EXPECT_LT(devices[0].used_bytes() - before - alone, alone + 64 * 64 * 64 / 2);
}

TEST(SeveralDevices, AViewAfterTheOther) {
    const PreparedVolume volume = wavy_volume();
    const Scene scene = wavy_scene();
    Renderer one({shared_device()}, volume, scene), two(two_devices(), volume, scene);
    for (int view = 0; view < 3; ++view) {
        Camera camera = scene.camera;
        camera.azimuth += 40 * view;
        one.aim(camera, view), two.aim(camera, view);
        expect_same(two.render(), one.render());
    }
}

} // namespace
} // namespace clvr::testing

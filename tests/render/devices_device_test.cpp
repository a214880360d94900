// Several devices at once: the same bits as from one.
#include "tests/render/several_devices.hpp"
#include "tests/runtime/faulty_devices.hpp"

#include <gmock/gmock.h>

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
        const Frame one = clvr::render({shared_device()}, volume, scene);
        ASSERT_EQ(one.has("variance.R"), mode == Mode::path);
        expect_same(clvr::render(parts, volume, scene), one);
        if (mode == Mode::path) expect_same(clvr::render(twice, volume, scene), one);
    }
}

TEST(SeveralDevices, SubDevicesShareTheVolume) {
    const std::vector<Device> devices = two_devices();
    if (devices[0].context()() != devices[1].context()()) GTEST_SKIP() << "not two parts of one device";
    const PreparedVolume volume(constant_volume({64, 64, 64}));
    Scene scene = wavy_scene();
    const std::size_t before = devices[0].used_bytes();
    RenderSession one({devices[0]}, volume, scene);
    const std::size_t alone = devices[0].used_bytes() - before;
    RenderSession both(devices, volume, scene);
    EXPECT_LT(devices[0].used_bytes() - before - alone, alone + 64 * 64 * 64 / 2);
}

TEST(SeveralDevices, AViewAfterTheOther) {
    const PreparedVolume volume = wavy_volume();
    const Scene scene = wavy_scene();
    RenderSession one({shared_device()}, volume, scene), two(two_devices(), volume, scene);
    for (int view = 0; view < 3; ++view) {
        Scene there = scene;
        there.camera.azimuth += 40 * view;
        there.view = view;
        one.set_view(there), two.set_view(there);
        expect_same(clvr::render(two, there), clvr::render(one, there));
    }
}

/// Renders with faults in the second of two devices; its bits must be those of one, with so many lines of warning.
void expect_same_with(const std::string& fault, long warned, int delay_ms = 0) {
    SCOPED_TRACE(fault);
    static const PreparedVolume volume = wavy_volume();
    static const Frame one = clvr::render({shared_device()}, volume, wavy_scene());
    const Warnings warnings;
    RenderSession session(faulty_devices(fault, 2, delay_ms), volume, wavy_scene());
    expect_same(clvr::render(session, wavy_scene()), one);
    EXPECT_EQ(lines_of(warnings.text()), warned) << warnings.text();
    if (warned > 0) {
        EXPECT_THAT(warnings.text(), ::testing::AllOf(::testing::HasSubstr("part 2/2 of device"),
                                                      ::testing::HasSubstr("failed and is left out, the other devices do its work")));
    }
    EXPECT_EQ(session.devices().size(), warned > 0 ? 1u : 2u);
    expect_same(clvr::render(session, wavy_scene()), one); // and without a word about it again
    EXPECT_EQ(lines_of(warnings.text()), warned) << warnings.text();
}

ErrorKind refusal_with(const std::string& fault, int part, std::string* line = nullptr) {
    SCOPED_TRACE(fault);
    const PreparedVolume volume = wavy_volume();
    const Warnings warnings;
    try {
        clvr::render(faulty_devices(fault, part), volume, wavy_scene());
    } catch (const Error& e) {
        if (line) *line = e.line();
        return e.kind();
    }
    return ErrorKind::internal;
}

TEST(FaultyDevices, AreLeftOutOrWaitedFor) {
    if (faulty_devices("delay:1").empty()) GTEST_SKIP() << "the device has no parts";
    expect_same_with("delay:15", 0);
    for (const char* fault : {"launch:2", "alloc:3", "alloc:12", "build:render/shade"}) expect_same_with(fault, 1);
    expect_same_with("launch:60", 1, 2); // while it traces
}

TEST(FaultyDevices, AllOfThemAreAnError) {
    if (faulty_devices("delay:1").empty()) GTEST_SKIP() << "the device has no parts";
    std::string line;
    EXPECT_EQ(refusal_with("launch:9", 0, &line), ErrorKind::device);
    EXPECT_THAT(line, ::testing::HasSubstr("CL_DEVICE_NOT_AVAILABLE"));
    EXPECT_EQ(refusal_with("alloc:4", 0), ErrorKind::device_memory);
    EXPECT_EQ(refusal_with("build:render/compact", 0, &line), ErrorKind::device);
    EXPECT_THAT(line, ::testing::HasSubstr("does not build"));
}

TEST(FaultyDevices, OtherBitsThanTheOthersAreFoundBeforeTheyMix) {
    if (faulty_devices("delay:1").empty()) GTEST_SKIP() << "the device has no parts";
    std::string line;
    EXPECT_EQ(refusal_with("result:render/accumulate", 2, &line), ErrorKind::device); // of two that differ, nobody knows which one is wrong
    EXPECT_THAT(line, ::testing::HasSubstr("compute different pictures"));
}

} // namespace
} // namespace clvr::testing

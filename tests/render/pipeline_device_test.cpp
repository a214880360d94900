// From samples to the filtered picture: the same on one device, on several, and for a session that goes on.
#include "host/io/model/model_file.hpp"
#include "host/render/pipeline.hpp"
#include "tests/render/several_devices.hpp"

#include <gtest/gtest.h>

namespace clvr::testing {
namespace {

TEST(Pipeline, GivesTheSameBitsOnSeveralDevices) {
    const PreparedVolume volume = wavy_volume();
    const Scene scene = wavy_scene();
    const auto& devices = two_devices();
    RenderSession one({devices.front()}, volume, scene), two(devices, volume, scene);
    Pipeline first(read_model("default")), second(read_model("default"));
    first.run(one, scene, {});
    second.run(two, scene, {});
    ASSERT_NE(one.film(), nullptr);
    ASSERT_EQ(two.film(), nullptr);
    first.run(one, scene, {}); // film() is the samples' mean again
    second.run(two, scene, {});
    expect_same(one.frame(), two.frame());
    expect_same(one.frame(scene.background, true), two.frame(scene.background, true));
    EXPECT_EQ(two.frame(scene.background, true).channels.size(), 4u);
    EXPECT_EQ(one.picture({}, {}, true).values, two.picture({}, {}, true).values);
    EXPECT_EQ(one.frame().attributes, two.frame().attributes);
    EXPECT_TRUE(one.frame().has("noisy.R"));

    // More samples: the filtered picture is no longer what it was, and the features need no second march.
    Scene more = scene;
    more.spp = 2;
    RenderControl go_on;
    go_on.go_on = true;
    first.run(one, more, go_on);
    second.run(two, more, go_on);
    EXPECT_EQ(one.samples(), scene.spp + 2);
    expect_same(one.frame(), two.frame());
    Scene all = scene;
    all.spp = scene.spp + 2;
    RenderSession anew({devices.front()}, volume, scene);
    Pipeline(read_model("default")).run(anew, all, {});
    expect_same(one.frame(), anew.frame());
}

TEST(Pipeline, ACancelledFilterLeavesTheSamples) {
    const PreparedVolume volume = wavy_volume();
    const Scene scene = wavy_scene();
    RenderSession session({shared_device()}, volume, scene), other({shared_device()}, volume, scene);
    Pipeline pipeline(read_model("default"));
    pipeline.take(session, scene, {});
    const std::atomic<bool> cancelled{true};
    try {
        pipeline.filter(session, &cancelled);
        FAIL() << "it was cancelled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::interrupted);
    }
    pipeline.filter(session);
    pipeline.run(other, scene, {});
    expect_same(session.frame(), other.frame());
}

TEST(Pipeline, WithoutAModelIsTheSamples) {
    const PreparedVolume volume = wavy_volume();
    const Scene scene = wavy_scene();
    RenderSession session({shared_device()}, volume, scene);
    Pipeline().run(session, scene, {});
    expect_same(session.frame(), render({shared_device()}, volume, scene));
    EXPECT_THROW(session.set_filtered(session.frame()), Error) << "the picture lies on the device";
}

TEST(Pipeline, ADraftOfTheSkysLightIsReplacedByTheWholeOne) {
    const PreparedVolume volume(
        volume_of<std::uint8_t>({90, 80, 70}, [](int x, int y, int z) { return (x / 9 + y / 8 + z / 7) % 3 * 90; }));
    Scene scene = wavy_scene();
    scene.feature_samples = 1;
    RenderSession session({shared_device()}, volume, scene);
    const auto sky = [&](bool draft) {
        RenderControl control;
        control.draft = draft;
        EXPECT_TRUE(session.march_features(1, control));
        session.accumulate(1);
        return session.frame().at("light.sky.G");
    };
    const std::vector<float> draft = sky(true), whole = sky(false);
    EXPECT_NE(draft, whole);
    EXPECT_EQ(sky(true), whole) << "what is there is taken";
    const Frame other = render({shared_device()}, volume, scene);
    EXPECT_EQ(whole, other.at("light.sky.G"));
    double apart = 0, sum = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) apart += std::abs(whole[i] - draft[i]), sum += whole[i];
    EXPECT_LT(apart, 0.3 * sum);
}

} // namespace
} // namespace clvr::testing

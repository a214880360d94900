// What of a scene makes its samples other ones.
#include "host/live/scene_parts.hpp"
#include "host/render/scene_settings.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <set>
#include <string>
#include <type_traits>

namespace clvr {
namespace {

TEST(SceneParts, EverySettingMakesOtherSamplesButThoseThatOnlyShowThem) {
    const std::set<std::string> only_show{"spp", "feature_samples", "features", "exposure"};
    for (const SceneSetting& setting : scene_settings()) {
        SCOPED_TRACE(setting.key);
        const Scene before;
        Scene after;
        visit_setting(setting, after, [](auto& value) {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, bool>)
                value = !value;
            else
                value += 1;
        });
        EXPECT_EQ(same_samples(before, after), only_show.count(setting.key) == 1);
        EXPECT_TRUE(same_samples(after, after));
    }
}

TEST(SceneParts, SoDoesEverythingElse) {
    Scene before;
    before.transfer = TransferFunction{false, {{0, {1, 1, 1}, 0}, {1, {1, 1, 1}, 1}}, "mine"};
    const auto differs = [&](const std::function<void(Scene&)>& change) {
        Scene after = before;
        change(after);
        return !same_samples(before, after) && !same_samples(after, before);
    };
    EXPECT_TRUE(differs([](Scene& s) { s.mode = Mode::dvr; }));
    EXPECT_TRUE(differs([](Scene& s) { s.shading = Shading::phase; }));
    EXPECT_TRUE(differs([](Scene& s) { s.transfer.reset(); }));
    EXPECT_TRUE(differs([](Scene& s) { s.transfer->normalized = true; }));
    EXPECT_TRUE(differs([](Scene& s) { s.transfer->points[1].opacity = 0.5; }));
    EXPECT_TRUE(differs([](Scene& s) { s.transfer->points[1].color[2] = 0.5; }));
    EXPECT_TRUE(differs([](Scene& s) { s.transfer->points[0].value = -1; }));
    EXPECT_TRUE(differs([](Scene& s) { s.transfer->points.pop_back(); }));
    EXPECT_TRUE(differs([](Scene& s) { s.clip_box = {0, 0, 0, 1, 1, 0.5}; }));
    EXPECT_TRUE(differs([](Scene& s) { s.clip_plane = ClipPlane{}; }));
    EXPECT_TRUE(differs([](Scene& s) { s.camera.up = {0, 1, 0}; }));
    EXPECT_TRUE(differs([](Scene& s) { s.camera.eye = s.camera.target = Double3{1, 2, 3}; }));
    EXPECT_TRUE(differs([](Scene& s) { s.light.environment = Light::Environment::constant; }));
    EXPECT_TRUE(differs([](Scene& s) { s.light.image = "sky.hdr"; }));
    EXPECT_FALSE(differs([](Scene& s) { s.transfer->name = "yours"; }));
    EXPECT_FALSE(differs([](Scene& s) { s.background.kind = Background::Kind::color; }));
    EXPECT_FALSE(differs([](Scene& s) { s.tonemap = "linear"; }));
    EXPECT_FALSE(differs([](Scene& s) { s.volume = "another name of it"; }));
    before.clip_plane = ClipPlane{{0, 0, 1}, 3};
    EXPECT_TRUE(differs([](Scene& s) { s.clip_plane->offset = 4; }));
    before.mode = Mode::mip;
    EXPECT_TRUE(differs([](Scene& s) { s.feature_samples = 1; })) << "a march's rays are its samples";
}

TEST(SceneParts, TablesOfTheEnvironmentAreThoseOfImageAndLevel) {
    Light sky, other;
    other.level = 2;
    EXPECT_TRUE(same_environment(sky, other)) << "there is no image";
    Light image;
    image.environment = Light::Environment::image;
    image.image = "a.hdr";
    EXPECT_FALSE(same_environment(sky, image));
    Light turned = image, brighter = image, another = image;
    turned.image_rotation = 30, brighter.level = 2, another.image = "b.hdr";
    EXPECT_TRUE(same_environment(image, turned));
    EXPECT_FALSE(same_environment(image, brighter));
    EXPECT_FALSE(same_environment(image, another));
}

} // namespace
} // namespace clvr

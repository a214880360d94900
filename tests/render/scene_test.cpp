// The ranges of a scene's values.
#include "host/render/scene.hpp"
#include "runtime/error.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

namespace clvr {
namespace {

using ::testing::HasSubstr;

const double nan_value = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

Scene good() {
    Scene s;
    s.volume = "demo:head";
    return s;
}

/// The line of the Error{usage} after a change to a good scene; empty when it stays good.
std::string refusal(const std::function<void(Scene&)>& change) {
    Scene s = good();
    change(s);
    try {
        validate(s);
    } catch (const Error& e) {
        EXPECT_FALSE(e.where().empty());
        return e.line();
    }
    return {};
}

TEST(SceneTest, DefaultsAreValid) {
    EXPECT_EQ(refusal([](Scene&) {}), "");
}

TEST(SceneTest, WhatAnOptionSetsIsNamedByIt) {
    EXPECT_THAT(refusal([](Scene& s) { s.volume.clear(); }), HasSubstr("VOLUME"));
    EXPECT_THAT(refusal([](Scene& s) { s.width = 0; }), HasSubstr("--size (width): is 0; expected 1 to 16384"));
    EXPECT_THAT(refusal([](Scene& s) { s.height = 16385; }), HasSubstr("--size (height): is 16385"));
    EXPECT_THAT(refusal([](Scene& s) { s.spp = -1; }), HasSubstr("--spp"));
    EXPECT_THAT(refusal([](Scene& s) { s.feature_samples = 2; }), HasSubstr("--feature-samples: is 2; expected 1 or 4"));
    EXPECT_THAT(refusal([](Scene& s) { s.bounces = -1; }), HasSubstr("--bounces"));
    EXPECT_THAT(refusal([](Scene& s) { s.reading.frame = -1; }), HasSubstr("--frame"));
    EXPECT_THAT(refusal([](Scene& s) { s.exposure = 100; }), HasSubstr("--exposure"));
    EXPECT_THAT(refusal([](Scene& s) { s.tonemap = "Filmic"; }), HasSubstr("--tonemap: is 'Filmic'; expected one of filmic"));
    for (double g : {-1.0, 1.0, nan_value}) EXPECT_THAT(refusal([=](Scene& s) { s.phase_g = g; }), HasSubstr("--phase-g"));
    for (double x : {-1.0, inf, nan_value}) {
        EXPECT_THAT(refusal([=](Scene& s) { s.extinction = x; }), HasSubstr("--extinction"));
        EXPECT_THAT(refusal([=](Scene& s) { s.light.level = x; }), HasSubstr("--environment"));
        EXPECT_THAT(refusal([=](Scene& s) { s.light.key = x; }), HasSubstr("--key"));
        EXPECT_THAT(refusal([=](Scene& s) { s.light.headlight = x; }), HasSubstr("--headlight"));
        EXPECT_THAT(refusal([=](Scene& s) { s.background.color[2] = x; }), HasSubstr("--background"));
    }
}

TEST(SceneTest, Camera) {
    for (double x : {0.0, 180.0, -5.0, nan_value}) EXPECT_THAT(refusal([=](Scene& s) { s.camera.fov = x; }), HasSubstr("--fov"));
    for (double x : {0.0, -1.0, inf, nan_value}) EXPECT_THAT(refusal([=](Scene& s) { s.camera.zoom = x; }), HasSubstr("--zoom"));
    for (double x : {90.1, -91.0, nan_value}) EXPECT_THAT(refusal([=](Scene& s) { s.camera.elevation = x; }), HasSubstr("--elevation"));
    EXPECT_EQ(refusal([](Scene& s) { s.camera.elevation = -90; }), "");
    EXPECT_THAT(refusal([](Scene& s) { s.camera.azimuth = inf; }), HasSubstr("--azimuth"));
    EXPECT_THAT(refusal([](Scene& s) { s.camera.eye = Double3{0, 0, 0}; }), HasSubstr("an eye without a target"));
    EXPECT_THAT(refusal([](Scene& s) { s.camera.target = Double3{0, 0, 0}; }), HasSubstr("a target without an eye"));
    const auto look = [](const Double3& eye, const Double3& target, const Double3& up) {
        return refusal([&](Scene& s) { s.camera.eye = eye, s.camera.target = target, s.camera.up = up; });
    };
    EXPECT_EQ(look({0, -5, 0}, {0, 0, 0}, {0, 0, 1}), "");
    EXPECT_THAT(look({1, 2, 3}, {1, 2, 3}, {0, 0, 1}), HasSubstr("--target"));
    EXPECT_THAT(look({0, 0, 5}, {0, 0, 0}, {0, 0, 1}), HasSubstr("parallel"));
    EXPECT_THAT(look({0, 0, 5}, {0, 0, 0}, {0, 0, 0}), HasSubstr("camera.up"));
    EXPECT_THAT(look({0, nan_value, 5}, {0, 0, 0}, {0, 1, 0}), HasSubstr("--eye"));
    EXPECT_THAT(refusal([](Scene& s) {
                    s.camera.eye = Double3{0, -5, 0}, s.camera.target = Double3{0, 0, 0};
                    s.camera.orthographic = true;
                }),
                HasSubstr("camera.height"));
}

TEST(SceneTest, LightsAndClips) {
    EXPECT_THAT(refusal([](Scene& s) { s.light.environment = Light::Environment::image; }), HasSubstr("light.image"));
    EXPECT_THAT(refusal([](Scene& s) { s.light.image = "sky.hdr"; }), HasSubstr("light.image"));
    EXPECT_THAT(refusal([](Scene& s) { s.light.key_elevation = 91; }), HasSubstr("--key-elevation"));
    EXPECT_THAT(refusal([](Scene& s) { s.light.key_angle = 181; }), HasSubstr("light.key_angle"));
    const auto box = [](std::array<double, 6> b) { return refusal([&](Scene& s) { s.clip_box = b; }); };
    EXPECT_EQ(box({0, 0, 0, 1, 1, 1}), "");
    EXPECT_THAT(box({0, 0.5, 0, 1, 0.5, 1}), HasSubstr("--clip-box: is 0.5 to 0.5 along axis y"));
    EXPECT_THAT(box({-0.1, 0, 0, 1, 1, 1}), HasSubstr("--clip-box"));
    EXPECT_THAT(box({0, 0, 0, 1, 1, 1.5}), HasSubstr("axis z"));
    EXPECT_THAT(box({0, 0, 0, nan_value, 1, 1}), HasSubstr("axis x"));
    EXPECT_THAT(refusal([](Scene& s) { s.clip_plane = ClipPlane{{0, 0, 0}, 1}; }), HasSubstr("--clip-plane"));
    EXPECT_THAT(refusal([](Scene& s) { s.clip_plane = ClipPlane{{0, 0, 1}, nan_value}; }), HasSubstr("--clip-plane"));
}

TEST(SceneTest, TransferFunctionIsChecked) {
    EXPECT_THAT(refusal([](Scene& s) { s.transfer.emplace(); }), HasSubstr("--tf: the transfer function is empty"));
}

} // namespace
} // namespace clvr

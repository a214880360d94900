// Pictures for a display, made on the device: the pixels that the host finds in double.
#include "host/render/display.hpp"
#include "host/render/pixel_numbers.hpp"
#include "tests/render/several_devices.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace clvr::testing {
namespace {

/// Light from far below the least code to far beyond white, some of it exactly where a code begins or just below; every kind of alpha.
Frame colours_of_all_kinds(int width, int height) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-6, 4), share(0, 1);
    const auto light = [&]() -> float {
        const double pick = share(random);
        if (pick < 0.02) return 0;
        if (pick < 0.03) return -0.5f;
        if (pick < 0.04) return 1e34f;
        if (pick < 0.05) return std::numeric_limits<float>::quiet_NaN();
        if (pick < 0.3) {
            const auto code = static_cast<float>(least_of_srgb_codes()[static_cast<std::size_t>(256 * share(random))]);
            return pick < 0.2 ? code : std::nextafter(code, 0.0f);
        }
        return static_cast<float>(std::pow(10, exponent(random)));
    };
    Frame frame;
    frame.width = width, frame.height = height;
    for (const char* name : {"R", "G", "B"})
        for (float& v : frame.channel(name)) v = light();
    for (float& a : frame.channel("A")) {
        const double pick = share(random);
        a = pick < 0.1 ? 0.0f : pick < 0.5 ? 1.0f : pick < 0.55 ? 1.0000001f : pick < 0.6 ? -0.1f : static_cast<float>(share(random));
        if (pick > 0.97) a = std::numeric_limits<float>::quiet_NaN();
        if (pick > 0.9 && pick < 0.95) a = static_cast<float>(least_of_alpha_codes()[static_cast<std::size_t>(256 * share(random))]);
    }
    return frame;
}

Film on_film(const Device& device, const Frame& frame) {
    Film film(device, frame.width, frame.height);
    film.require({"depth.Z", "R", "G", "B", "A"});
    for (const char* name : {"R", "G", "B", "A"}) film.upload(name, frame.at(name));
    return film;
}

void expect_equal(const DisplayPixels& a, const DisplayPixels& b, const std::string& what) {
    ASSERT_EQ(a.components, b.components) << what;
    ASSERT_EQ(a.values.size(), b.values.size()) << what;
    std::size_t other = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) other += a.values[i] != b.values[i];
    EXPECT_EQ(other, 0u) << what << ": of " << a.values.size();
}

TEST(DisplayOnDevice, ShowsWhatTheHostFinds) {
    Device device = open_device();
    const Frame frame = colours_of_all_kinds(331, 217);
    Film film = on_film(device, frame);
    Display display(device);
    for (const char* curve : tonemap_names)
        for (const double exposure : {0.0, -3.7, 1.3, 60.0, -64.0})
            for (const bool alpha : {true, false}) {
                const Tonemap tonemap{curve, exposure};
                expect_equal(display.show(film, {}, tonemap, alpha), display_pixels(frame, tonemap, alpha),
                             std::string(curve) + ", " + std::to_string(exposure) + ", " + std::to_string(alpha));
            }
    EXPECT_THROW(display.show(film, {}, {"curvy", 0}, true), Error);
}

TEST(DisplayOnDevice, LiesOverColourAndEnvironment) {
    Device device = open_device();
    const PreparedVolume volume = wavy_volume();
    Scene scene = wavy_scene();
    RenderSession session({device}, volume, scene);
    EXPECT_THROW(session.picture({}, {}, true), Error) << "nothing is there yet";
    for (int view = 0; view < 2; ++view) { // the environment is seen again from another side
        scene.camera.azimuth += 40;
        session.set_view(scene);
        session.accumulate(3);
        ASSERT_NE(session.film(), nullptr);
        for (const auto kind : {Background::Kind::transparent, Background::Kind::environment, Background::Kind::color}) {
            const Background background{kind, {0.3, 0.5, 0.1}};
            expect_equal(session.picture(background, {}, true), display_pixels(session.frame(background), {}, true), "a background");
        }
    }
}

TEST(DisplayOnDevice, IsTheSamePictureOnSeveralDevices) {
    const auto devices = two_devices();
    const PreparedVolume volume = wavy_volume();
    const Scene scene = wavy_scene();
    RenderSession one({devices.front()}, volume, scene), two(devices, volume, scene);
    for (RenderSession* session : {&one, &two}) session->accumulate(2);
    EXPECT_EQ(two.film(), nullptr);
    expect_equal(one.picture({}, {}, true), two.picture({}, {}, true), "two devices");
}

} // namespace
} // namespace clvr::testing

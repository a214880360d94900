// Exposure and known light of a picture on the device, beside the same in double on the host.
#include "host/denoise/picture_light.hpp"
#include "tests/denoise/batches.hpp"
#include "tests/denoise/frames.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace clvr::testing {
namespace {

/// `region` of a frame on a film, with all that PictureLight reads.
Film film_of(const Device& device, const Frame& frame, const Region& region) {
    std::vector<std::string> names{"R", "G", "B", "A"};
    names.insert(names.end(), known_light_channels().begin(), known_light_channels().end());
    Film film(device, region.width, region.height);
    film.require(names);
    const ChannelPlan plan(default_settings(), false);
    for (const std::string& name : names) {
        std::vector<float> plane;
        plan.gather_plane(name, frame, region, std::nullopt, plane);
        film.upload(name, plane);
    }
    return film;
}

/// A frame in which light and shares change from place to place, some of it empty.
Frame varied_frame(int width, int height) {
    Frame f = noisy_frame(width, height);
    for (std::size_t i = 0; i < f.pixels(); ++i) {
        const double x = static_cast<double>(i % static_cast<std::size_t>(width)) / width;
        f.channel("opacity.A")[i] = x < 0.2 ? 0.001f : static_cast<float>(0.3 + 0.7 * x);
        for (const std::string c : {"R", "G", "B"}) {
            f.channel("albedo." + c)[i] = 0.5f;
            const float key = f.channel("light.key." + c)[i] = 0.4f + 0.1f * static_cast<float>(i * 31 % 7);
            const float sky = f.channel("light.sky." + c)[i] = 0.3f + 0.1f * static_cast<float>(i * 17 % 5);
            f.channel(c)[i] = static_cast<float>((0.8 + x) * key + (1.3 - x) * sky) * f.at("opacity.A")[i];
        }
    }
    return f;
}

TEST(PictureLightOnDevice, IsThatOfTheHost) {
    for (const auto& [width, height, cell] : {std::tuple{150, 97, 32}, {31, 5, 32}, {64, 64, 8}, {130, 70, 48}, {97, 33, 0}, {1, 1, 32}}) {
        Device device = test_device();
        const Frame frame = varied_frame(width, height);
        Model model = default_settings();
        model.exposure = model.control_variate = true;
        model.control_variate_cell = cell;
        Film film = film_of(device, frame, {0, 0, width, height});
        PictureLight light(device, model);
        light.begin(width, height, true);
        light.add(film, {0, 0, width, height});
        light.make_known(film, 0, 0);
        EXPECT_NEAR(light.exposure() / exposure_of(frame), 1, 1e-6) << width;
        const KnownLight known(frame, cell);
        const char* const colours[] = {"known.R", "known.G", "known.B"};
        for (int c = 0; c < 3; ++c) {
            const std::vector<float> there = film.download(colours[c]);
            for (std::size_t i = 0; i < there.size(); ++i)
                ASSERT_NEAR(there[i], known(c, i), 2e-5 * (1 + std::abs(known(c, i)))) << width << "x" << height << ", pixel " << i;
        }
    }
}

TEST(PictureLightOnDevice, GivesTheSameBitsInPartsAndAtAnyWidth) {
    const int width = 150, height = 110;
    const Frame frame = varied_frame(width, height);
    Model model = default_settings();
    model.exposure = model.control_variate = true;
    model.control_variate_cell = 24;
    std::vector<float> first;
    for (const int lanes : {1, 4, 8, 16})
        for (const bool parts : {false, true}) {
            Device device = test_device();
            device.set_tunable("conv_width", lanes);
            PictureLight light(device, model);
            light.begin(width, height, true);
            const int edge = parts ? light.block() : 1 << 20;
            ASSERT_EQ(light.block(), 48);
            for (int y = 0; y < height; y += edge)
                for (int x = 0; x < width; x += edge) {
                    const Region region{x, y, std::min(edge, width - x), std::min(edge, height - y)};
                    Film film = film_of(device, frame, region);
                    light.add(film, region);
                }
            std::vector<float> all{static_cast<float>(light.exposure())};
            const Region shown = parts ? Region{37, 21, 113, 89} : Region{0, 0, width, height};
            Film film = film_of(device, frame, shown);
            light.make_known(film, shown.x, shown.y);
            const std::vector<float> plane = film.download("known.G");
            for (int y = 21; y < height; ++y)
                for (int x = 37; x < width; ++x)
                    all.push_back(plane[static_cast<std::size_t>(y - shown.y) * shown.width + static_cast<std::size_t>(x - shown.x)]);
            if (first.empty()) first = all;
            ASSERT_EQ(std::memcmp(first.data(), all.data(), all.size() * sizeof(float)), 0) << lanes << (parts ? " in parts" : "");
        }
}

TEST(PictureLightOnDevice, OfNothingIsTheLightAsItIs) {
    Device device = test_device();
    Frame frame = varied_frame(40, 40);
    for (float& a : frame.channel("opacity.A")) a = 0;
    Model model = default_settings();
    model.exposure = model.control_variate = true;
    Film film = film_of(device, frame, {0, 0, 40, 40});
    PictureLight light(device, model);
    light.begin(40, 40, true);
    light.add(film, {0, 0, 40, 40});
    light.make_known(film, 0, 0);
    EXPECT_EQ(light.exposure(), 1);
    EXPECT_NEAR(film.download("known.R")[7], frame.at("light.key.R")[7] + frame.at("light.sky.R")[7], 1e-5);
}

} // namespace
} // namespace clvr::testing

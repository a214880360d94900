// The renderer as a whole: what a frame holds, unusual volumes and scenes, limits of memory and time.
#include "host/render/path_tracer.hpp"
#include "tests/render/scenes.hpp"

namespace clvr::testing {
namespace {

const char* const feature_channels[] = {"albedo.R", "albedo.G", "albedo.B",  "normal.X",        "normal.Y",
                                        "normal.Z", "depth.Z",  "opacity.A", "depth.deviation", "depth.half"};

void expect_finite(const Frame& f) {
    for (const auto& [name, values] : f.channels) {
        ASSERT_EQ(values.size(), f.pixels()) << name;
        for (float x : values) ASSERT_TRUE(std::isfinite(x)) << name;
        if (name.find("normal") == std::string::npos) {
            for (float x : values) ASSERT_GE(x, 0) << name;
        }
    }
}

template <class Call>
ErrorKind kind_of(Call&& call) {
    try {
        call();
    } catch (const Error& e) {
        EXPECT_FALSE(std::string(e.what()).empty());
        return e.kind();
    }
    return ErrorKind::internal;
}

Scene small_scene(int spp = 2) {
    Scene s;
    s.volume = "test";
    s.width = 20;
    s.height = 16;
    s.spp = spp;
    s.transfer = uniform_transfer({0.8, 0.5, 0.3}, 0.5);
    return s;
}

TEST(Frame, HoldsItsChannels) {
    const Voxels v = constant_volume({8, 8, 8});
    Scene s = small_scene(1);
    const Frame one = render(v, s);
    EXPECT_EQ(one.width, 20);
    EXPECT_EQ(one.height, 16);
    EXPECT_FALSE(one.has("variance.R")) << "no variance of one sample";
    EXPECT_FALSE(one.has("background.R"));
    for (const char* name : feature_channels) EXPECT_TRUE(one.has(name)) << name;
    expect_finite(one);
    EXPECT_EQ(one.attributes.at("clvr.spp"), "1");
    s.spp = 2;
    s.features = false;
    const Frame two = render(v, s);
    for (const char* name : {"R", "G", "B", "A", "variance.R", "variance.G", "variance.B"}) EXPECT_TRUE(two.has(name)) << name;
    EXPECT_FALSE(two.has("albedo.R"));
    expect_finite(two);
}

TEST(Frame, LeavesLightOutThatNobodyWants) {
    const Voxels v = constant_volume({8, 8, 8});
    const PreparedVolume prepared(v);
    RenderSession session({shared_device()}, prepared, small_scene(1));
    const Frame lit = clvr::render(session, small_scene(1));
    RenderControl control;
    control.light = false;
    const Frame unlit = clvr::render(session, small_scene(1), control);
    EXPECT_EQ(unlit.channels.size(), lit.channels.size() - 6);
    for (const auto& [name, values] : lit.channels) {
        if (name.rfind("light.", 0) == 0)
            EXPECT_FALSE(unlit.has(name)) << name;
        else
            EXPECT_EQ(unlit.at(name), values) << name;
    }
}

/// Mean and variance of a pixel are those of its samples, traced one by one.
TEST(Frame, MeanAndVarianceAreThoseOfTheSamples) {
    constexpr int spp = 11;
    Scene s = plain_scene(8, spp);
    s.extinction = 0.2;
    s.camera.target = Double3{3.5, 3.5, 3.5};
    s.camera.eye = Double3{10, -20, 8};
    s.camera.fov = 20;
    const Stage stage(constant_volume({8, 8, 8}), s);
    Device device = shared_device();
    const DeviceVolume volume = stage.upload(device);
    const DeviceLights light(device, stage.render, {});
    PathTracer tracer(device, volume, light, 64);
    const std::atomic<bool> going{false};
    struct Sums {
        std::vector<shared::float4> mean, deviation;
    };
    const auto trace = [&](std::uint32_t first, std::uint32_t samples) {
        const PixelSums zero(device, 64);
        PixelSums sums(device, 64);
        EXPECT_TRUE(tracer.trace(0, 64, first, samples, zero, sums, 0, going));
        return Sums{device.download<shared::float4>(sums.mean, 64), device.download<shared::float4>(sums.deviation, 64)};
    };
    const Sums all = trace(0, spp);
    std::vector<Sums> single;
    for (std::uint32_t k = 0; k < spp; ++k) { // counted as sample k, it joins an average of k zeros with the weight 1 / (k + 1)
        single.push_back(trace(k, 1));
        for (auto& m : single.back().mean) m.x *= static_cast<float>(k + 1), m.w *= static_cast<float>(k + 1);
    }
    for (int i = 0; i < 64; ++i) {
        double mean = 0, squares = 0, alpha = 0;
        for (const Sums& one : single) mean += one.mean[i].x / spp, alpha += one.mean[i].w / spp;
        for (const Sums& one : single) squares += (one.mean[i].x - mean) * (one.mean[i].x - mean);
        EXPECT_NEAR(all.mean[i].x, mean, 1e-5);
        EXPECT_NEAR(all.mean[i].w, alpha, 1e-5);
        EXPECT_NEAR(all.deviation[i].x, squares, 1e-4 * squares + 1e-6);
    }
    const Frame frame = render(stage.volume.voxels, s);
    EXPECT_NEAR(frame.at("variance.R")[0], all.deviation[0].x / (spp * (spp - 1.0)), 1e-6);
}

TEST(Frame, LiesOverItsBackground) {
    const Voxels v = constant_volume({8, 8, 8});
    Scene s = small_scene(3);
    const Frame clear = render(v, s);
    s.background.kind = Background::Kind::color;
    s.background.color = {0.25, 0.5, 2};
    const Frame over = render(v, s);
    for (std::size_t i = 0; i < over.pixels(); ++i) {
        ASSERT_EQ(over.at("A")[i], clear.at("A")[i]); // the denoiser takes the background off again by it
        ASSERT_EQ(over.at("background.B")[i], 2);
        ASSERT_NEAR(over.at("G")[i], clear.at("G")[i] + (1 - clear.at("A")[i]) * 0.5f, 1e-6);
    }
    EXPECT_EQ(over.at("opacity.A"), clear.at("opacity.A"));
    // The sky's gradient, from below to above.
    s.background.kind = Background::Kind::environment;
    s.light.key = 0;
    s.camera.fov = 80;
    s.camera.elevation = 0;
    s.camera.azimuth = 0;
    const std::vector<float> sky = render(v, s).at("background.R");
    const Stage stage(v, [&] {
        Scene eyed = s;
        eyed.camera.eye = Double3{0, -1, 0};
        eyed.camera.target = Double3{0, 0, 0};
        return eyed;
    }());
    for (int y = 0; y < 16; ++y) {
        double expected = 0;
        for (double py : {0.25, 0.75})
            for (double px : {0.25, 0.75}) {
                const double up = (1 - (y + py) / 8) * std::tan(40 * 3.14159265358979 / 180),
                             right = ((10 + px) / 10 - 1) * 1.25 * std::tan(40 * 3.14159265358979 / 180);
                expected += (stage.render.sky.x + stage.render.sky.y * up / std::sqrt(1 + up * up + right * right)) / 4;
            }
        EXPECT_NEAR(sky[y * 20 + 10], expected, 1e-5);
    }
}

TEST(Mip, IsTheGreatestVisibleValue) {
    const Voxels v = volume_of<std::uint8_t>({40, 24, 40}, [](int x, int y, int) { return y == 12 ? 100 + 3 * x : y; });
    Scene s = plain_scene(24, 1);
    s.mode = Mode::mip;
    s.transfer->points = {{50, {1, 1, 1}, 0}, {60, {1, 1, 1}, 0.1}, {250, {1, 1, 1}, 0.1}};
    look_along_y(s, {19.5, 11.5, 19.5}, 24);
    const Frame f = render(v, s);
    for (int x = 0; x < 24; ++x) {
        // Of the pixel's four lattices the first and the last have samples a sixteenth of a voxel from the bright slice, between it and its
        // dark neighbours. The last one's ray sees the greater value.
        const double value = 100 + 3 * (19.5 + x + 0.5 - 12);
        EXPECT_NEAR(f.at("R")[10 * 24 + x], (15 * (value + 3 * 0.375) + 12 - 16 * 50) / 16 / 200, 0.01);
        EXPECT_EQ(f.at("A")[10 * 24 + x], 1);
    }
}

TEST(NothingVisible, IsATransparentPictureAndAWarning) {
    for (Mode mode : {Mode::path, Mode::dvr, Mode::mip}) {
        Scene s = small_scene();
        s.mode = mode;
        s.transfer = uniform_transfer({1, 1, 1}, 0);
        const PreparedVolume volume(constant_volume({20, 20, 20}));
        RenderSession session({shared_device()}, volume, s);
        ASSERT_EQ(session.warnings().size(), 1u);
        EXPECT_NE(session.warnings()[0].find("nothing is visible"), std::string::npos);
        const Frame f = clvr::render(session, s);
        for (const char* name : {"R", "G", "B", "A", "opacity.A"}) EXPECT_EQ(f.at(name), std::vector<float>(f.pixels(), 0.0f)) << name;
        for (const char* name : {"albedo.R", "depth.Z", "depth.half"}) EXPECT_EQ(f.at(name), std::vector<float>(f.pixels(), 1.0f)) << name;
    }
    Scene s = small_scene(); // cut away whole
    s.clip_plane = ClipPlane{{0, 0, 1}, -100};
    const Frame f = render(constant_volume({8, 8, 8}), s);
    EXPECT_EQ(f.at("A"), std::vector<float>(f.pixels(), 0.0f));
}

TEST(UnusualVolumes, RenderInEveryMode) {
    for (const Int3& dims : {Int3{1, 1, 1}, Int3{2, 2, 2}, Int3{1, 512, 512}, Int3{512, 1, 1}, Int3{512, 512, 1}})
        for (bool automatic : {false, true})
            for (Mode mode : {Mode::path, Mode::dvr, Mode::mip}) {
                const Voxels v = volume_of<std::uint8_t>(dims, [](int x, int y, int z) { return 100 + (x + y + z) % 32; });
                Scene s = small_scene();
                s.mode = mode;
                if (automatic) s.transfer.reset();
                const Frame f = render(v, s);
                expect_finite(f);
                if (!automatic) {
                    EXPECT_GT(mean_of(f.at("opacity.A")), 1e-4) << dims[0] << "x" << dims[1] << "x" << dims[2];
                }
            }
}

TEST(UnusualVolumes, ConstantOnesRender) {
    for (std::uint8_t value : {0, 128, 255})
        for (bool automatic : {false, true}) {
            Scene s = small_scene();
            if (automatic) s.transfer.reset();
            expect_finite(render(constant_volume({16, 16, 16}, value), s));
        }
}

TEST(ExtremeScenes, StayFinite) {
    const Voxels v = volume_of<std::uint8_t>({24, 24, 24}, [](int x, int y, int z) { return (x * 11 + y * 7 + z * 5) % 256; });
    const auto expect = [&](const char* what, auto&& change) {
        SCOPED_TRACE(what);
        Scene s = small_scene(4);
        s.transfer->points = {{0, {0, 0, 0}, 0}, {100, {1, 1, 1}, 1}, {200, {0, 1, 0}, 0}, {255, {1, 1, 1}, 1}};
        change(s);
        expect_finite(render(v, s));
    };
    expect("dense", [](Scene& s) { s.extinction = 1e6; });
    expect("thin", [](Scene& s) { s.extinction = 1e-9; });
    expect("dark", [](Scene& s) { s.light.level = 0, s.light.key = 0; });
    expect("bright", [](Scene& s) { s.light.level = 1e6, s.light.key = 1e6; });
    expect("forward", [](Scene& s) { s.shading = Shading::phase, s.phase_g = 0.999; });
    expect("backward", [](Scene& s) { s.shading = Shading::phase, s.phase_g = -0.999; });
    expect("unlimited and black", [](Scene& s) { s.bounces = 0, s.transfer = uniform_transfer({0, 0, 0}); });
    expect("key of half the sky", [](Scene& s) { s.light.key_angle = 180; });
    expect("eye inside", [](Scene& s) { s.camera.eye = Double3{12, 12, 12}, s.camera.target = Double3{12, 20, 12}; });
    expect("eye on a voxel's corner, along an axis", [](Scene& s) {
        s.camera.eye = Double3{12.5, -20, 16}, s.camera.target = Double3{12.5, 0, 16};
    });
}

TEST(Memory, TooLittleIsAnErrorAndIsGivenBack) {
    Device device = open_device();
    const std::size_t before = device.used_bytes();
    const PreparedVolume volume(constant_volume({128, 128, 128}));
    device.set_memory_limit(before + (1 << 20));
    EXPECT_EQ(kind_of([&] { RenderSession({device}, volume, small_scene()); }), ErrorKind::device_memory);
    EXPECT_EQ(device.used_bytes(), before);
    device.set_memory_limit(before + (3 << 20)); // the volume fits, the paths do not
    EXPECT_EQ(kind_of([&] {
                  Scene s = small_scene();
                  s.width = s.height = 1024;
                  clvr::render({device}, volume, s);
              }),
              ErrorKind::device_memory);
    EXPECT_EQ(device.used_bytes(), before);
}

TEST(Scenes, AreCheckedFirst) {
    Scene s = small_scene();
    s.spp = 0;
    EXPECT_EQ(kind_of([&] { render(constant_volume({4, 4, 4}), s); }), ErrorKind::usage);
}

TEST(Cancelling, BeforeTheFirstPassIsAnError) {
    const PreparedVolume volume(constant_volume({16, 16, 16}));
    const std::atomic<bool> cancelled{true};
    RenderControl control;
    control.cancelled = &cancelled;
    for (bool features : {true, false}) {
        Scene s = small_scene();
        s.features = features;
        RenderSession session({shared_device()}, volume, s);
        EXPECT_EQ(kind_of([&] { clvr::render(session, s, control); }), ErrorKind::interrupted);
    }
}

TEST(Progress, RisesToOne) {
    const PreparedVolume volume(constant_volume({16, 16, 16}));
    RenderSession session({shared_device()}, volume, small_scene(7));
    double last = 0;
    int samples = 0;
    RenderControl control;
    control.progress = [&](const RenderProgress& p) {
        EXPECT_GE(p.done, last);
        last = p.done;
        samples = p.samples;
    };
    clvr::render(session, small_scene(7), control);
    EXPECT_EQ(last, 1);
    EXPECT_EQ(samples, 7);
}

} // namespace
} // namespace clvr::testing

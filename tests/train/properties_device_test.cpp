// What the operators of the bilateral grid promise for any input (kernels/denoise/README.md, "Properties").
#include "host/denoise/denoiser.hpp"
#include "host/train/training_step.hpp"
#include "tests/denoise/batches.hpp"
#include "tests/denoise/frames.hpp"

#include <algorithm>

namespace clvr::testing {
namespace {

struct Random {
    std::uint32_t k = 1;
    float operator()() {
        k = k * 1664525u + 1013904223u;
        return static_cast<float>(k >> 8) / (1 << 24);
    }
};

/// A level of a grid under given guides and colours, at its stages.
struct Level {
    Device device = test_device();
    Model model;
    int width, height;
    NeuralGrid grid;
    std::vector<float> guide; // [pixels], 0..1

    Level(int w, int h, int pixels, int codes, std::uint32_t seed)
        : model(one_level(pixels, codes)), width(w), height(h), grid(device, model, {w, h}) {
        Random random{seed};
        for (int i = 0; i < w * h; ++i) guide.push_back(random());
        std::vector<float> plane(grid.plane_floats(1) + 16);
        const shared::DenoiseParams& p = grid.shape();
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) plane[(y + p.pad) * p.row + p.pad + x] = guide[y * w + x];
        guides = device.upload(plane, "guides");
        ones = colours(std::vector<shared::float4>(pixels_of_image(), {1, 1, 1, 1}));
        splat_kernel = kernel("denoise/splat", {{"CLVR_BINS", std::to_string(p.level[0].depth)}});
        sum_kernel = kernel("denoise/splat", {{"CLVR_BINS", std::to_string(p.level[0].depth)}, {"CLVR_SUMS", "1"}});
        slice_kernel = kernel("denoise/slice", {});
        slice_gradient_kernel = kernel("train/slice_gradient", {});
    }

    std::size_t pixels_of_image() const { return static_cast<std::size_t>(width) * height; }
    std::size_t cell_count() const { return grid.shape().cells; }
    Buffer colours(std::vector<shared::float4> values) {
        values.push_back({}); // read in pairs
        return device.upload(values, "colours");
    }
    std::vector<shared::float4> splatted(const Buffer& from, bool sums) {
        const Buffer cells = device.buffer(cell_count() * 16 + 16, "cells");
        const shared::GridLevel& l = grid.shape().level[0];
        device.launch(sums ? sum_kernel : splat_kernel, {static_cast<std::size_t>(l.columns), static_cast<std::size_t>(l.rows)}, {1}, {},
                      grid.params(), 0, 1, guides, from, 0, cells);
        return device.download<shared::float4>(cells, cell_count());
    }
    /// [pixels][3]
    std::vector<double> sliced(const Buffer& cells) {
        const Buffer out = planes(std::vector<double>(3 * pixels_of_image()));
        device.launch(slice_kernel, grid.pixel_items(1), {1}, {}, grid.params(), guides, cells, ones, ones /* no light is known */, out);
        return interleaved(grid, out, 3, 0, 3);
    }
    /// U / S of each pixel.
    Buffer upstream(const std::vector<double>& u, const Buffer& cells) {
        Buffer up = device.buffer(pixels_of_image() * 16, "upstream");
        const Buffer unused = planes(std::vector<double>(3 * pixels_of_image()));
        device.launch(slice_gradient_kernel, grid.pixel_items(1), {1}, {}, grid.params(), guides, cells, ones, planes(u), up, unused);
        return up;
    }

private:
    Buffer guides, ones;
    Kernel splat_kernel, sum_kernel, slice_kernel, slice_gradient_kernel;

    static Model one_level(int pixels, int codes) {
        Model m;
        m.channels = {"R"};
        m.levels = {{pixels, codes}};
        initialise(m, 1);
        return m;
    }
    Kernel kernel(const std::string& stage, Defines defines) {
        defines["CLVR_WIDTH"] = std::to_string(NeuralGrid::pixel_width(device));
        return device.kernel(stage, defines);
    }
    Buffer planes(const std::vector<double>& values) { // [pixels][3]
        const shared::DenoiseParams& p = grid.shape();
        std::vector<float> all(3 * static_cast<std::size_t>(p.plane) + 16);
        for (int c = 0; c < 3; ++c)
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x)
                    all[static_cast<std::size_t>(c) * p.plane + (y + p.pad) * p.row + p.pad + x] =
                        static_cast<float>(values[3 * (static_cast<std::size_t>(y) * width + x) + c]);
        return device.upload(all, "planes");
    }
};

std::vector<shared::float4> random_colours(std::size_t count, std::uint32_t seed, float gain = 1, float offset = 0) {
    Random random{seed};
    std::vector<shared::float4> colours;
    for (std::size_t i = 0; i < count; ++i) {
        const float r = random(), g = random(), b = random();
        colours.push_back({gain * r + offset, gain * g + offset, gain * b + offset, 1});
    }
    return colours;
}

struct Levels : ::testing::TestWithParam<std::pair<int, int>> {
    Level level{45, 29, GetParam().first, GetParam().second, 7};
};

TEST_P(Levels, SumsOfCellsAreSumsOfPixels) {
    const Buffer colours = level.colours(random_colours(level.pixels_of_image(), 3));
    const shared::GridLevel& l = level.grid.shape().level[0];
    const auto kept = [](double at, int count) { // what is left of a pixel's weight where one of its cells lies outside
        const double t = at - 0.5 - std::floor(at - 0.5);
        return (std::floor(at - 0.5) >= 0 ? 1 - t : 0) + (std::floor(at - 0.5) + 1 < count ? t : 0);
    };
    double expected = 0, red = 0, sum = 0, red_sum = 0;
    const auto values = random_colours(level.pixels_of_image(), 3);
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * level.width + x;
            const double w = kept((y + 0.5) / l.pixels, l.rows) * kept((x + 0.5) / l.pixels, l.columns) *
                             kept((255.0 * level.guide[i] + 0.5) / l.codes, l.depth);
            expected += w, red += w * values[i].x;
        }
    for (const auto& cell : level.splatted(colours, true)) sum += cell.w, red_sum += cell.x;
    EXPECT_NEAR(sum, expected, 1e-5 * expected);
    EXPECT_NEAR(red_sum, red, 1e-5 * expected);
}

TEST_P(Levels, SlicingIsAdjointToItsGradient) {
    // <U, slice(V)> = <slice^T U, V> for any V in occupied cells.
    std::vector<shared::float4> v = random_colours(level.cell_count(), 5);
    Random random{9};
    for (auto& cell : v)
        if (random() < 0.3f) cell = {}; // empty
    const Buffer cells = level.colours(v);
    std::vector<double> u;
    for (std::size_t i = 0; i < 3 * level.pixels_of_image(); ++i) u.push_back(2 * random() - 1);
    const std::vector<double> sliced = level.sliced(cells);
    double there = 0, back = 0, size = 0;
    for (std::size_t i = 0; i < u.size(); ++i) there += u[i] * sliced[i], size += std::abs(u[i] * sliced[i]);
    const auto gradient = level.splatted(level.upstream(u, cells), true);
    for (std::size_t k = 0; k < v.size(); ++k)
        if (v[k].w > 0)
            back += static_cast<double>(gradient[k].x) * v[k].x + static_cast<double>(gradient[k].y) * v[k].y +
                    static_cast<double>(gradient[k].z) * v[k].z;
    EXPECT_NEAR(there, back, 1e-6 * size);
}

TEST_P(Levels, IsAffineAndConvex) {
    const auto result = [&](float gain, float offset) {
        return level.sliced(level.colours(level.splatted(level.colours(random_colours(level.pixels_of_image(), 3, gain, offset)), false)));
    };
    const std::vector<double> plain = result(1, 0), moved = result(3, -0.5f);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        ASSERT_GE(plain[i], 0);
        ASSERT_LE(plain[i], 1);
        ASSERT_NEAR(moved[i], 3 * plain[i] - 0.5, 3e-6);
    }
}
INSTANTIATE_TEST_SUITE_P(Factors, Levels, ::testing::Values(std::pair(4, 4), std::pair(8, 8), std::pair(16, 16), std::pair(5, 7)));

Model trained_like_model() {
    Model m;
    m.channels = reference_channels();
    m.opacity_weight = true;
    initialise(m, 4);
    return m;
}

Frame transposed(const Frame& f) {
    Frame t;
    t.width = f.height, t.height = f.width;
    for (const auto& [name, values] : f.channels) {
        std::vector<float>& to = t.channel(name);
        for (int y = 0; y < f.height; ++y)
            for (int x = 0; x < f.width; ++x)
                to[static_cast<std::size_t>(x) * t.width + y] = values[static_cast<std::size_t>(y) * f.width + x];
    }
    return t;
}

TEST(Properties, TransposedPicturesAndKernelsGiveTheTransposedResult) {
    Model model = trained_like_model(), turned = model;
    const auto turn = [&](std::vector<float>& weights) {
        const std::vector<float> old = weights;
        const std::size_t k = static_cast<std::size_t>(model.kernel), taps = k * k;
        for (std::size_t i = 0; i < old.size(); ++i) weights[i / taps * taps + i % taps % k * k + i % taps / k] = old[i];
    };
    turn(turned.conv1_weight), turn(turned.conv2_weight);
    Device device = test_device();
    const Frame frame = noisy_frame(53, 38);
    const Frame a = transposed(Denoiser(device, model).denoise(frame)), b = Denoiser(device, turned).denoise(transposed(frame));
    for (const char* c : {"R", "G", "B"})
        for (std::size_t i = 0; i < a.pixels(); ++i) ASSERT_NEAR(a.at(c)[i], b.at(c)[i], 1e-4 * (1 + a.at(c)[i]));
}

TEST(Properties, ImagesOfABatchAreIndependent) {
    const Model model = trained_like_model();
    const auto gradient = [&](const std::vector<Crop>& crops) {
        StepConfig config;
        config.patch = 24;
        config.batch = 3;
        config.micro_batch = 3;
        TrainingStep step(test_device(), model, config);
        for (const int size : {40, 41, 42}) step.add_image(noisy_frame(size, 40), noisy_frame(size, 40));
        std::vector<float> g;
        step.gradient(crops, g);
        return g;
    };
    const Crop a{0, 1, 2, 0}, b{1, 3, 4, 2}, c{2, 0, 7, 5};
    const std::vector<float> all = gradient({a, b, c}), ga = gradient({a}), gb = gradient({b}), gc = gradient({c});
    for (std::size_t i = 0; i < all.size(); ++i)
        ASSERT_NEAR(all[i], (ga[i] + gb[i] + gc[i]) / 3, 1e-6f * (std::abs(ga[i]) + std::abs(gb[i]) + std::abs(gc[i])) + 1e-9f);
}

TEST(Properties, BlackStaysBlackWithoutAGradient) {
    Frame black = noisy_frame(30, 30);
    for (const char* c : {"R", "G", "B"}) black.channel(c).assign(black.pixels(), 0.0f);
    Device device = test_device();
    const Frame done = Denoiser(device, trained_like_model()).denoise(black);
    for (const float v : done.at("G")) ASSERT_EQ(v, 0);
    for (const Loss loss : {Loss::shifted_gamma, Loss::reference, Loss::smape, Loss::relative_l2, Loss::noisy, Loss::shifted_gamma_l2,
                            Loss::shifted_gamma_bands}) {
        StepConfig config;
        config.loss = loss;
        config.patch = 24;
        config.batch = 1;
        TrainingStep step(device, trained_like_model(), config);
        step.add_image(black, black);
        std::vector<float> g;
        EXPECT_EQ(step.gradient({{0, 0, 0, 0}}, g), 0);
        for (std::size_t i = 0; i < g.size(); ++i) ASSERT_EQ(g[i], 0) << static_cast<int>(loss) << " " << i;
    }
}

} // namespace
} // namespace clvr::testing

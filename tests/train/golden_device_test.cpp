// The kernels against the golden vectors, forward and backward.
#include "host/train/gradients.hpp"
#include "host/train/training_step.hpp"
#include "tests/denoise/batches.hpp"

namespace clvr::testing {
namespace {

std::vector<double> product(std::vector<double> a, const std::vector<double>& b, std::size_t per) {
    for (std::size_t i = 0; i < a.size(); ++i) a[i] *= b[i / per];
    return a;
}

/// Colour (k = 0..2) or weight (3) of each cell of a level of image 0.
std::vector<double> cells_of(Device& device, const NeuralGrid& grid, const Buffer& cells, int level, bool weight) {
    const shared::GridLevel& l = grid.shape().level[level];
    const std::size_t count = static_cast<std::size_t>(l.rows) * l.columns * l.depth;
    const auto values = device.download<shared::float4>(cells, count, l.offset);
    std::vector<double> out;
    for (const auto& v : values)
        if (weight)
            out.push_back(v.w);
        else
            out.insert(out.end(), {v.x, v.y, v.z});
    return out;
}

struct EndToEnd : ::testing::TestWithParam<const char*> {};

TEST_P(EndToEnd, MeetsTheGoldenVectors) {
    const Golden golden(GetParam()), weights("weights");
    const int height = static_cast<int>(golden.shape("x")[1]), width = static_cast<int>(golden.shape("x")[2]);
    Device device = test_device();
    const Model model = golden_model(weights);
    const ChannelPlan plan(model, true);
    const Frame frame = frame_of(golden["x"], height, width, 0), target = colours_of(golden["target"], height, width, 0);
    std::vector<float> planes;
    plan.gather(frame, &target, {0, 0, width, height}, plan.known_light(frame), planes);
    const Buffer source = device.upload(planes, "source"), parameters = device.upload(model.flat(), "parameters");
    const auto prepared = [&](NeuralGrid& grid) {
        grid.set_parameters(parameters);
        grid.assemble(source, width, height, plan.params(1, 1), 0, 0, 0, 0);
        grid.forward(1);
    };

    const BatchShape shape{width, height, 1, false, true};
    NeuralGrid grid(device, model, shape), shown(device, model, {width, height, 1, true, true});
    prepared(grid), prepared(shown);
    const bool all = golden.file().find("net_in") != nullptr;
    if (all) {
        golden.expect_near("net_in", interleaved(grid, grid.input(), 10, 0, 10));
        golden.expect_near("hidden", interleaved(grid, grid.hidden(), 20, 0, 20));
    }
    golden.expect_near("y", interleaved(grid, grid.outputs(), 5, 0, 5));
    std::vector<double> albedo;
    for (std::size_t i = 0; i < frame.pixels(); ++i)
        for (const char* c : {"albedo.R", "albedo.G", "albedo.B"}) albedo.push_back(frame.at(c)[i]);
    for (int l = 0; l < 3; ++l) {
        const std::string n = std::to_string(l + 1);
        const std::vector<double> d = golden["cellw" + n], got_d = cells_of(device, grid, grid.cells(), l, true);
        golden.expect_near("cellw" + n, got_d);
        golden.expect_near("grid" + n, product(cells_of(device, grid, grid.cells(), l, false), d, 3), product(golden["grid" + n], d, 3));
        golden.expect_near("sliced" + n, interleaved(shown, shown.result(), 12, 3 + 3 * l, 3), product(golden["sliced" + n], albedo, 1));
    }
    golden.expect_near("denoised", interleaved(grid, grid.result(), 3, 0, 3));
    EXPECT_EQ(interleaved(grid, grid.result(), 3, 0, 3), interleaved(shown, shown.result(), 12, 0, 3));

    Gradients gradients(device, model, Loss::reference, grid, shape);
    gradients.set_parameters(parameters);
    Buffer gradient = device.buffer(model.parameters() * 4, "gradient"), loss = device.buffer(4, "loss");
    gradients.backward(grid, 1, static_cast<float>(1.0 / (3.0 * width * height)), gradient, loss, 0);
    golden.expect_near("loss", {device.download<float>(loss, 1)[0]});
    golden.expect_near("d_denoised", interleaved(grid, gradients.result_gradient(), 3, 0, 3));
    const std::vector<double> y = golden["y"], d_logits = interleaved(grid, gradients.output_gradient(), 5, 0, 5);
    std::vector<double> d_y;
    for (std::size_t i = 0; i < y.size(); ++i) d_y.push_back(d_logits[i] / (y[i] * (1 - y[i])));
    golden.expect_near("d_y", d_y);
    for (int l = 0; l < 3; ++l) {
        const std::string n = std::to_string(l + 1);
        const std::vector<double> d = cells_of(device, grid, grid.cells(), l, true);
        golden.expect_near("d_grid" + n, product(cells_of(device, grid, gradients.cell_gradient(), l, false), d, 3));
    }
    if (all) {
        golden.expect_near("d_logits", d_logits);
        Convolution to_input(device, "train/input_gradient", 20, 10, 5, 0, 0, true, width);
        to_input.set_parameters(device, parameters);
        const Buffer input_gradient = device.buffer(grid.plane_floats(10) * 4 + 64, "input gradient");
        to_input.run(device, grid.shape(), 1, grid.params(), gradients.hidden_gradient(), input_gradient);
        golden.expect_near("d_net_in", interleaved(grid, input_gradient, 10, 0, 10));
    }
    const std::vector<float> flat = device.download<float>(gradient, model.parameters());
    auto at = flat.begin();
    for (const char* name : {"conv1.weight", "conv1.bias", "conv2.weight", "conv2.bias"}) {
        const auto count = static_cast<std::ptrdiff_t>(weights[name].size());
        golden.expect_near(std::string("d_") + name, {at, at + count});
        at += count;
    }
}
INSTANTIATE_TEST_SUITE_P(Cases, EndToEnd, ::testing::Values("e2e_tiny_5x7", "e2e_div_16x32"));

struct Stage : ::testing::TestWithParam<const char*> {};

/// Splat, normalise and slice alone, with the guide in codes, and each one's gradient.
TEST_P(Stage, MeetsTheGoldenVectors) {
    const Golden golden(GetParam());
    const int height = static_cast<int>(golden.shape("image")[1]), width = static_cast<int>(golden.shape("image")[2]);
    const std::vector<double> s_r = golden["s_r"], kink = golden["kink_mask"];
    Device device = test_device();
    for (const int lanes : {1, 4, 16}) {
        device.set_tunable("conv_width", lanes);
        Model model;
        model.channels = {"R", "G", "B"};
        model.levels = {{static_cast<int>(s_r[0]), static_cast<int>(s_r.back())}};
        initialise(model, 1);
        NeuralGrid grid(device, model, {width, height});
        shared::DenoiseParams p = grid.shape();
        p.guide_scale = 1;
        p.level[0].slope = p.level[0].inverse_codes;
        const Buffer params = device.upload(std::vector<shared::DenoiseParams>{p}, "params");
        const auto cells = static_cast<std::size_t>(p.cells), pixels = static_cast<std::size_t>(width) * height;

        const auto plane_of = [&](const std::vector<double>& values, int channels) { // [H, W, C] with border
            std::vector<float> planes(static_cast<std::size_t>(channels) * p.plane + 16);
            for (int c = 0; c < channels; ++c)
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x)
                        planes[static_cast<std::size_t>(c) * p.plane + (y + p.pad) * p.row + p.pad + x] =
                            static_cast<float>(values[(static_cast<std::size_t>(y) * width + x) * channels + c]);
            return device.upload(planes, "planes");
        };
        const auto colours_of_array = [&](const std::vector<double>& values, float w) {
            std::vector<shared::float4> colours;
            for (std::size_t i = 0; i < values.size(); i += 3)
                colours.push_back({static_cast<float>(values[i]), static_cast<float>(values[i + 1]), static_cast<float>(values[i + 2]), w});
            colours.push_back({});
            return device.upload(colours, "colours");
        };
        const auto xyz = [&](const Buffer& b, std::size_t count) {
            std::vector<double> v;
            for (const auto& c : device.download<shared::float4>(b, count)) v.insert(v.end(), {c.x, c.y, c.z});
            return v;
        };
        const auto smooth = [&](std::vector<double> v) { // on a kink any slope between the two sides is right
            for (std::size_t i = 0; i < v.size(); ++i)
                if (kink[i] != 0) v[i] = 0;
            return v;
        };
        const Defines width_of{{"CLVR_WIDTH", std::to_string(lanes)}};
        const auto with = [&](Defines more) {
            more.insert(width_of.begin(), width_of.end());
            return more;
        };
        const std::string bins = std::to_string(p.level[0].depth);
        Kernel splat = device.kernel("denoise/splat", with({{"CLVR_BINS", bins}})),
               sums = device.kernel("denoise/splat", with({{"CLVR_BINS", "3"}, {"CLVR_WHOLE", "0"}, {"CLVR_SUMS", "1"}})),
               slice = device.kernel("denoise/slice", width_of), slice_gradient = device.kernel("train/slice_gradient", width_of),
               normalise = device.kernel("train/normalise_gradient"),
               guide_gradient = device.kernel("train/guide_gradient", with({{"CLVR_SIGMOID", "0"}, {"CLVR_IMAGE_GRADIENT", "1"}}));
        const Buffer guide = plane_of(golden["guide255"], 1), image = colours_of_array(golden["image"], 1),
                     ones = colours_of_array(std::vector<double>(pixels * 3, 1), 1),
                     no_colours = colours_of_array(std::vector<double>(pixels * 3, 0), 0);
        const Buffer grid_cells = device.buffer(cells * 16 + 16, "cells"), gradient_cells = device.buffer(cells * 16 + 16, "cells"),
                     no_cells = device.upload(std::vector<float>(cells * 4 + 4), "cells");
        const Range columns{static_cast<std::size_t>(p.level[0].columns), static_cast<std::size_t>(p.level[0].rows)},
            third{columns.x * static_cast<std::size_t>((p.level[0].depth + 2) / 3), columns.y}, all = grid.pixel_items(1);

        device.launch(splat, columns, {1}, {}, params, 0, 1, guide, image, 0, grid_cells);
        golden.expect_near("grid", xyz(grid_cells, cells));
        std::vector<double> weight;
        for (const auto& c : device.download<shared::float4>(grid_cells, cells)) weight.push_back(c.w);
        golden.expect_near("cellw", weight);

        const Buffer result = plane_of(std::vector<double>(pixels * 3), 3);
        device.launch(slice, all, {1}, {}, params, guide, grid_cells, ones, ones /* no light is known */, result);
        golden.expect_near("sliced", interleaved(grid, result, 3, 0, 3));

        const Buffer upstream = device.buffer(pixels * 16, "upstream"), by_guide = plane_of(std::vector<double>(pixels), 1),
                     by_image = device.buffer(pixels * 16, "by image");
        device.launch(slice_gradient, all, {1}, {}, params, guide, grid_cells, ones, plane_of(golden["up_sliced"], 3), upstream, by_guide);
        device.launch(sums, third, {1}, {}, params, 0, 1, guide, upstream, 0, gradient_cells);
        golden.expect_near("slice_d_grid", xyz(gradient_cells, cells));
        device.launch(guide_gradient, all, {1}, {}, params, guide, grid_cells, no_cells, image, upstream, by_guide, by_image);
        golden.expect_near("slice_d_guide", smooth(interleaved(grid, by_guide, 1, 0, 1)), smooth(golden["slice_d_guide"]));

        const Buffer up_grid = colours_of_array(golden["up_grid"], 0);
        device.launch(normalise, {cells}, {1}, {}, grid_cells, up_grid, static_cast<cl_uint>(cells));
        device.launch(guide_gradient, all, {1}, {}, params, guide, grid_cells, up_grid, image, no_colours, by_guide, by_image);
        golden.expect_near("splat_d_guide", smooth(interleaved(grid, by_guide, 1, 0, 1)), smooth(golden["splat_d_guide"]));
        golden.expect_near("splat_d_image", xyz(by_image, pixels));
    }
}
INSTANTIATE_TEST_SUITE_P(Cases, Stage, ::testing::Values("stage_edges_s4", "stage_edges_s8", "stage_zero_valued_cells", "stage_one_pixel"));

TEST(Adam, MeetsTheGoldenVectors) {
    const Golden golden("adam");
    Device device = test_device();
    Kernel adam = device.kernel("train/adam");
    Buffer parameters = device.upload(golden.floats("param0"), "parameters");
    const Buffer first = device.upload(std::vector<float>(16), "m"), second = device.upload(std::vector<float>(16), "v"),
                 one = device.upload(std::vector<float>{1}, "scale");
    const std::vector<float> gradients = golden.floats("grads");
    std::vector<double> got;
    for (int k = 0; k < 12; ++k) {
        const Buffer gradient = device.upload(std::vector<float>(gradients.begin() + 16 * k, gradients.begin() + 16 * (k + 1)), "gradient");
        const std::array<float, 2> correction{static_cast<float>(1 / (1 - std::pow(0.9, k + 1))),
                                              static_cast<float>(1 / (1 - std::pow(0.999, k + 1)))};
        device.launch(adam, {16}, {1}, {}, parameters, first, second, gradient, one, shared::float4{0.9f, 0.1f, 0.999f, 0.001f}, correction,
                      0.01f, 1e-8f, cl_uint{16});
        for (const float v : device.download<float>(parameters, 16)) got.push_back(v);
    }
    golden.expect_near("params", got);
}

TEST(Training, MeetsTheGoldenSteps) {
    const Golden golden("train_steps");
    Device device = test_device();
    StepConfig config;
    config.loss = Loss::reference;
    config.patch = 16;
    config.batch = 2;
    TrainingStep step(device, golden_model(golden), config);
    for (int n = 0; n < 2; ++n) step.add_image(frame_of(golden["x"], 16, 16, n), colours_of(golden["target"], 16, 16, n));
    const std::vector<Crop> crops{{0, 0, 0, 0}, {1, 0, 0, 0}};
    for (int k = 0; k < 4; ++k) step.step(crops, 1e-4);
    std::vector<double> losses = step.take_losses();
    std::vector<float> gradient;
    losses.push_back(step.gradient(crops, gradient));
    golden.expect_near("losses", losses);
    const Model trained = step.model();
    golden.expect_near("final.conv1.weight", {trained.conv1_weight.begin(), trained.conv1_weight.end()});
    golden.expect_near("final.conv1.bias", {trained.conv1_bias.begin(), trained.conv1_bias.end()});
    golden.expect_near("final.conv2.weight", {trained.conv2_weight.begin(), trained.conv2_weight.end()});
    golden.expect_near("final.conv2.bias", {trained.conv2_bias.begin(), trained.conv2_bias.end()});
}

} // namespace
} // namespace clvr::testing

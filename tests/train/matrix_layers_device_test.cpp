// The convolutions by CLBlast against the direct kernels.
#include "host/train/gradients.hpp"
#include "host/train/training_step.hpp"
#include "tests/denoise/batches.hpp"
#include "tests/denoise/frames.hpp"

#include <algorithm>

namespace clvr::testing {
namespace {

Model model_of(int hidden, int kernel) {
    Model m;
    m.channels = reference_channels();
    m.hidden = hidden;
    m.kernel = kernel;
    initialise(m, 8);
    for (float& b : m.conv1_bias) b = 0.1f;
    return m;
}

/// Greatest difference, in units of the greatest value.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0, apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(b[i])), apart = std::max(apart, std::abs(a[i] - b[i]));
    return apart / most;
}

/// Planes of both images of a batch.
std::vector<double> all_planes(NeuralGrid& grid, const Buffer& planes, int channels) {
    std::vector<double> all;
    for (int n = 0; n < 2; ++n)
        for (int c = 0; c < channels; ++c)
            for (const float v : grid.download(planes, channels, n, c)) all.push_back(v);
    return all;
}

/// Each operator on the same input: forward layers, gradient by the hidden layer, by the weights.
TEST(MatrixLayers, AgreeWithTheDirectKernels) {
    for (const auto& [width, height, hidden, kernel] : {std::tuple(48, 48, 20, 5), {37, 21, 7, 3}}) {
        const Model model = model_of(hidden, kernel);
        Device device = test_device();
        const BatchShape shape{width, height, 2, false, true};
        NeuralGrid grid(device, model, shape);
        Gradients gradients(device, model, Loss::shifted_gamma, grid, shape);
        MatrixLayers matrices(device, model, shape);
        const Buffer parameters = device.upload(model.flat(), "parameters");
        grid.set_parameters(parameters), gradients.set_parameters(parameters), matrices.set_parameters(parameters);
        const ChannelPlan plan(model, true);
        for (int n = 0; n < 2; ++n) {
            Frame frame = noisy_frame(width, height), target = frame;
            for (float& v : target.channel("G")) v = 0.3f + 0.2f * static_cast<float>(n);
            std::vector<float> planes;
            plan.gather(frame, &target, {0, 0, width, height}, plan.known_light(frame), planes);
            grid.assemble(device.upload(planes, "source"), width, height, plan.params(1, 1), 0, 0, 4 * n, n);
            device.finish();
        }
        matrices.forward(grid, 2);
        const auto by_product = all_planes(grid, grid.hidden(), hidden), outputs_by_product = all_planes(grid, grid.outputs(), 5);
        grid.forward(2);
        const auto direct = all_planes(grid, grid.hidden(), hidden);
        EXPECT_NE(by_product, direct); // it is another backend
        EXPECT_LT(distance(by_product, direct), 5e-6);
        EXPECT_LT(distance(outputs_by_product, all_planes(grid, grid.outputs(), 5)), 5e-6);

        const auto count = 2 * model.parameters();
        Buffer by_patch = device.buffer(count * 4, "gradients"), loss = device.buffer(8, "loss");
        gradients.backward(grid, 2, 1.0f / static_cast<float>(6 * width * height), by_patch, loss, 0);
        const auto hidden_gradient = all_planes(grid, gradients.hidden_gradient(), hidden);
        const std::vector<float> weights = device.download<float>(by_patch, count);
        matrices.weight_gradients(grid, 2, gradients.output_gradient(), gradients.hidden_gradient(), by_patch, 0);
        const std::vector<float> weights_by_product = device.download<float>(by_patch, count);
        EXPECT_NE(weights_by_product, weights);
        EXPECT_LT(distance({weights_by_product.begin(), weights_by_product.end()}, {weights.begin(), weights.end()}), 5e-5);
        matrices.hidden_gradient(grid, 2, gradients.output_gradient(), gradients.hidden_gradient());
        EXPECT_LT(distance(all_planes(grid, gradients.hidden_gradient(), hidden), hidden_gradient), 5e-6);
    }
}

TEST(MatrixLayers, TrainToTheSameBitsEachTime) {
    const auto trained = [](int micro_batch) {
        StepConfig config;
        config.convolution = ConvolutionBackend::clblast;
        config.patch = 24;
        config.batch = 3;
        config.micro_batch = micro_batch;
        TrainingStep step(test_device(), model_of(20, 5), config);
        Frame target = noisy_frame(40, 40);
        for (float& v : target.channel("R")) v *= 0.5f;
        step.add_image(noisy_frame(40, 40), target);
        for (int k = 0; k < 3; ++k) step.step({{0, k, 2, 0}, {0, 7, k, 3}, {0, 16, 16, 5}}, 1e-3);
        return step.state().parameters;
    };
    const std::vector<float> once = trained(3);
    EXPECT_NE(once, model_of(20, 5).flat());
    EXPECT_EQ(trained(3), once);
    EXPECT_EQ(trained(1), once);
}

} // namespace
} // namespace clvr::testing

// clvr-denoise-bench: GuideNet against the machine's FMA peak, the whole denoiser against GuideNet, a training step against its
// convolutions, in one run.
#include "host/denoise/neural_grid.hpp"
#include "host/train/training_step.hpp"
#include "runtime/select.hpp"
#include "tools/bench/native_peak.hpp"
#include "tools/bench/timing.hpp"

#include <fmt/format.h>

#include <string>

using namespace clvr;

namespace {

float noise(std::uint32_t i) {
    i = (i ^ (i >> 16)) * 0x7feb352du;
    i = (i ^ (i >> 15)) * 0x846ca68bu;
    return static_cast<float>((i ^ (i >> 16)) >> 8) / (1 << 24);
}

Frame noisy_frame(int width, int height) {
    Frame f;
    f.width = width, f.height = height;
    std::uint32_t k = 0;
    for (const auto& name : reference_channels())
        for (float& v : f.channel(name)) v = noise(++k);
    return f;
}

void denoise(Device& device, const Model& model, int width, int height) {
    NeuralGrid grid(device, model, {width, height});
    grid.set_parameters(device.upload(model.flat(), "model"));
    const Frame frame = noisy_frame(width, height);
    const ChannelPlan plan(model, false);
    std::vector<float> planes;
    plan.gather(frame, nullptr, {0, 0, width, height}, planes);
    const Buffer source = device.upload(planes, "frame");
    const auto assemble = [&] { grid.assemble(source, width, height, plan.params(1), 0, 0, 0, 0); };
    assemble();
    device.finish();
    constexpr long rounds = 4000000;
    double operations = 0;
    const auto t = bench::in_turn({[&] { operations = native::fma_chains(rounds); }, [&] { grid.guide_network(1), device.finish(); },
                                   [&] { assemble(), grid.forward(1), device.finish(); }},
                                  9);
    const double flops = 2.0 * width * height * model.kernel * model.kernel * model.hidden * (model.channels.size() + model.outputs());
    fmt::print("{}x{}: GuideNet {:.1f} ms, {:.0f} GFLOP/s, {:.0f} % of the native peak ({:.0f}); whole denoiser {:.1f} ms, {:.2f} x "
               "GuideNet; {:.0f} MB\n",
               width, height, t[1] * 1e3, flops / t[1] * 1e-9, 100 * flops / t[1] / (operations / t[0]), operations / t[0] * 1e-9,
               t[2] * 1e3, t[2] / t[1], device.used_bytes() * 1e-6);
}

void train(Device& device, const Model& model, int patches, ConvolutionBackend convolution) {
    StepConfig config;
    config.convolution = convolution;
    config.batch = patches;
    TrainingStep step(device, model, config);
    const Frame frame = noisy_frame(512, 512);
    step.add_image(frame, frame);
    std::vector<Crop> crops;
    for (int i = 0; i < patches; ++i) crops.push_back({0, 8 * i, 16 * i, i % 8});
    double operations = 0;
    const auto t =
        bench::in_turn({[&] { operations = native::fma_chains(4000000); }, [&] { step.step(crops, 1e-4), step.take_losses(); }}, 9);
    // Forward, by the weights, by the hidden layer. The kernel study took 57 ms for them: 70 % of its machine's peak.
    const double inner = static_cast<double>(model.channels.size()) + model.outputs();
    const double flops = 2.0 * patches * 65536 * model.kernel * model.kernel * model.hidden * (2 * inner + model.outputs());
    const double convolutions = flops / (0.7 * operations / t[0]);
    fmt::print(
        "training step of {} patches of 256x256, {} convolutions: {:.0f} ms, {:.2f} x its convolutions at the study's rate ({:.0f} ms)\n",
        patches, convolution == ConvolutionBackend::clblast ? "CLBlast" : "direct", t[1] * 1e3, t[1] / convolutions, convolutions * 1e3);
}

} // namespace

int main(int argc, char** argv) {
    try {
        Device device = Device::open(select_devices(argc > 1 ? argv[1] : "").devices.front());
        Model model;
        model.channels = reference_channels();
        initialise(model, 1);
        denoise(device, model, 1280, 720);
        denoise(device, model, 1920, 1080);
        for (const auto convolution : {ConvolutionBackend::direct, ConvolutionBackend::clblast}) train(device, model, 8, convolution);
        device.finish();
        fmt::print("{}", device.profile().table());
        return 0;
    } catch (const Error& e) {
        fmt::print(stderr, "clvr-denoise-bench: {}\n", e.line());
        return e.exit_code();
    }
}

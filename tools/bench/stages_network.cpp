// The denoiser, stage by stage and whole, and a step of training.
#include "host/denoise/denoiser.hpp"
#include "host/denoise/neural_grid.hpp"
#include "host/train/training_step.hpp"
#include "tools/bench/stage.hpp"

namespace clvr::bench {
namespace {

Model benchmark_model() {
    Model m;
    m.channels = reference_channels();
    initialise(m, 1);
    return m;
}

Frame noisy_frame(int width, int height) {
    Frame f;
    f.width = width, f.height = height;
    std::uint32_t k = 0;
    for (const auto& name : reference_channels())
        for (float& v : f.channel(name)) v = noise(++k);
    return f;
}

Frame frame_of(Size size) { return size == Size::tiny ? noisy_frame(16, 12) : noisy_frame(1280, 720); }

double convolution_flops(const Model& m, double pixels) {
    return 2 * pixels * m.kernel * m.kernel * m.hidden * static_cast<double>(m.channels.size() + static_cast<std::size_t>(m.outputs()));
}

/// A frame in a NeuralGrid of its size, run through once.
std::shared_ptr<NeuralGrid> grid_with_frame(Device& d, const Model& model, const Frame& frame) {
    const auto grid = std::make_shared<NeuralGrid>(d, model, BatchShape{frame.width, frame.height});
    grid->set_parameters(d.upload(model.flat(), "model"));
    const ChannelPlan plan(model, false);
    std::vector<float> planes;
    plan.gather(frame, nullptr, {0, 0, frame.width, frame.height}, plan.known_light(frame), planes);
    const Buffer source = d.upload(planes, "frame");
    grid->assemble(source, frame.width, frame.height, plan.params(1, 1), 0, 0, 0, 0);
    grid->forward(1);
    d.finish();
    return grid;
}

std::string hash_of_planes(NeuralGrid& grid, const Buffer& planes, int channels) {
    std::vector<float> all;
    for (int c = 0; c < channels; ++c) {
        const std::vector<float> plane = grid.download(planes, channels, 0, c);
        all.insert(all.end(), plane.begin(), plane.end());
    }
    return hash_of(all);
}

StageRun guide_network(std::vector<Device>& devices, Size size) {
    const auto d = std::make_shared<Device>(devices.front());
    const Model model = benchmark_model();
    const Frame frame = frame_of(size);
    const auto grid = grid_with_frame(*d, model, frame);
    StageRun r;
    r.run = [=] { grid->guide_network(1), d->finish(); };
    r.hash = [=] { return hash_of_planes(*grid, grid->outputs(), model.outputs()); };
    r.items = static_cast<double>(frame.pixels());
    r.flops = convolution_flops(model, r.items);
    r.bytes = 4 * r.items * (static_cast<double>(model.channels.size()) + 2 * model.hidden + model.outputs());
    return r;
}

// Arithmetic that is of use, for the roofline: a pixel goes into 4 windows x 2 depths of 4 channels a level, and comes out of 8 cells
// likewise.
constexpr double splat_flops = 4 * 2 * 4 * 2, slice_flops = 8 * 4 * 2;

StageRun splat(std::vector<Device>& devices, Size size) {
    const auto d = std::make_shared<Device>(devices.front());
    const Model model = benchmark_model();
    const Frame frame = frame_of(size);
    const auto grid = grid_with_frame(*d, model, frame);
    const int levels = static_cast<int>(model.levels.size());
    StageRun r;
    r.run = [=] {
        for (int l = 0; l < levels; ++l) grid->splat(l, 1, grid->splatted(), 0, grid->cells(), false);
        d->finish();
    };
    r.hash = [=] { return hash_of(d->download<float>(grid->cells(), std::size_t{4} * grid->shape().cells)); };
    r.items = static_cast<double>(frame.pixels());
    r.flops = r.items * levels * splat_flops;
    r.bytes = r.items * 20 * levels + 16.0 * grid->shape().cells;
    return r;
}

StageRun slice(std::vector<Device>& devices, Size size) {
    const auto d = std::make_shared<Device>(devices.front());
    const Model model = benchmark_model();
    const Frame frame = frame_of(size);
    const auto grid = grid_with_frame(*d, model, frame);
    const double levels = static_cast<double>(model.levels.size());
    StageRun r;
    r.run = [=] { grid->slice(1), d->finish(); };
    r.hash = [=] { return hash_of_planes(*grid, grid->result(), 3); };
    r.items = static_cast<double>(frame.pixels());
    r.flops = r.items * levels * slice_flops;
    r.bytes = r.items * (16 + 12 + 4 * (2 * levels - 1)) + 16.0 * grid->shape().cells;
    return r;
}

StageRun whole_frame(std::vector<Device>& devices, Size size) {
    const Model model = benchmark_model();
    const auto frame = std::make_shared<Frame>(frame_of(size)), done = std::make_shared<Frame>();
    const auto denoiser = std::make_shared<Denoiser>(devices.front(), model);
    StageRun r;
    r.run = [=] { *done = denoiser->denoise(*frame); };
    r.hash = [=] { return pixel_hash(*done); };
    r.items = static_cast<double>(frame->pixels());
    return r;
}

/// Each run takes the same step from the start, so that its result is one and the same.
StageRun training_step(std::vector<Device>& devices, Size size) {
    const bool tiny = size == Size::tiny;
    const Model model = benchmark_model();
    StepConfig config;
    config.patch = tiny ? 8 : 256;
    config.batch = tiny ? 1 : 4;
    const auto step = std::make_shared<TrainingStep>(devices.front(), model, config);
    const Frame noisy = tiny ? noisy_frame(8, 8) : noisy_frame(320, 320);
    step->add_image(noisy, noisy);
    std::vector<Crop> crops;
    for (int i = 0; i < config.batch; ++i) crops.push_back({0, tiny ? 0 : 8 * i, tiny ? 0 : 16 * i, i % 8});
    const auto start = std::make_shared<OptimizerState>(step->state());
    StageRun r;
    r.run = [=] {
        step->set_state(*start);
        step->step(crops, 1e-4);
        step->take_losses();
    };
    r.hash = [=] { return hash_of(step->state().parameters); };
    r.items = config.batch;
    // Forward, by the weights, by the hidden layer.
    const double inner = static_cast<double>(model.channels.size()) + model.outputs();
    r.flops = 2.0 * config.batch * config.patch * config.patch * model.kernel * model.kernel * model.hidden * (2 * inner + model.outputs());
    return r;
}

} // namespace

std::vector<Stage> network_stages() {
    return {{"GuideNet", "Mpixels/s", 1e6, Ceiling::arithmetic, "", true, "", guide_network},
            {"splat", "Mpixels/s", 1e6, Ceiling::bandwidth, "", true, "", splat},
            {"slice", "Mpixels/s", 1e6, Ceiling::bandwidth, "", true, "", slice},
            {"denoise a frame", "Mpixels/s", 1e6, Ceiling::none, "denoise", true, "", whole_frame},
            {"training step", "patches/s", 1, Ceiling::arithmetic, "train", true, "", training_step}};
}

} // namespace clvr::bench

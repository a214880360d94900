#include "host/train/training_step.hpp"
#include "host/denoise/neural_grid.hpp"
#include "host/train/gradients.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace clvr {

namespace {

/// A training image: its planes on the device, or on the host where the device is full.
struct Image {
    int width = 0, height = 0;
    shared::SourceParams params{};
    Buffer on_device;
    std::vector<float> on_host;
};

constexpr cl_uint loss_slots = 1024; // steps whose losses wait on the device

/// x^n by squaring: the same bits everywhere, which pow does not promise.
double power(double x, std::int64_t n) {
    double result = 1;
    for (; n > 0; n /= 2, x *= x)
        if (n % 2) result *= x;
    return result;
}

} // namespace

struct TrainingStep::State {
    Device device;
    Model start;
    StepConfig config;
    ChannelPlan plan;
    std::size_t parameters;
    int micro = 1;
    std::unique_ptr<NeuralGrid> grid;
    std::unique_ptr<Gradients> gradients;
    std::unique_ptr<MatrixLayers> matrices; // null: the direct kernels convolve
    std::vector<Image> images;
    Buffer parameter_values, first_moment, second_moment, scale, crop_planes;
    Buffer patch_gradients; // [batch][parameters]
    Buffer gradient;        // [parameters]
    Buffer patch_losses;    // [batch]
    Buffer step_losses;     // [loss_slots]
    Kernel sum_runs, gradient_scale, adam;
    std::int64_t step = 0;
    std::vector<double> losses;
    cl_uint waiting = 0;

    State(const Device& d, const Model& m, const StepConfig& c)
        : device(d), start(m), config(c), plan(m, true), parameters(m.parameters()) {}

    BatchShape shape(int patches) const { return {config.patch, config.patch, patches, false, true}; }
    std::size_t bytes(int patches) const {
        return NeuralGrid::bytes(device, start, shape(patches)) + Gradients::bytes(device, start, shape(patches)) +
               (by_matrices() ? MatrixLayers::bytes(start, shape(patches)) : 0);
    }
    std::size_t largest_bytes(int patches) const {
        return std::max(Gradients::largest_bytes(device, start, shape(patches)),
                        by_matrices() ? MatrixLayers::largest_bytes(start, shape(patches)) : 0);
    }
    bool by_matrices() const { return config.convolution == ConvolutionBackend::clblast; }

    void assemble(const Crop& crop, int n) {
        Image& image = images.at(static_cast<std::size_t>(crop.image));
        const int size = config.patch;
        if (crop.x < 0 || crop.y < 0 || crop.x + size > image.width || crop.y + size > image.height || crop.orientation < 0 ||
            crop.orientation > 7)
            throw Error(ErrorKind::internal, fmt::format("crop at {}, {} of a {} x {} image", crop.x, crop.y, image.width, image.height));
        if (image.on_device)
            return grid->assemble(image.on_device, image.width, image.height, image.params, crop.x, crop.y, crop.orientation, n);
        std::vector<float> part;
        const std::size_t plane = static_cast<std::size_t>(image.width) * image.height;
        for (std::size_t p = 0; p < plan.planes().size(); ++p)
            for (int y = 0; y < size; ++y) {
                const auto row = image.on_host.begin() +
                                 static_cast<std::ptrdiff_t>(p * plane + static_cast<std::size_t>(crop.y + y) * image.width + crop.x);
                part.insert(part.end(), row, row + size);
            }
        if (!crop_planes) crop_planes = device.buffer(part.size() * 4, "crop");
        device.write(crop_planes, part.data(), part.size() * 4);
        grid->assemble(crop_planes, size, size, image.params, 0, 0, crop.orientation, n);
    }

    void sum(const Buffer& values, const Buffer& totals, cl_uint first, std::size_t count, std::size_t item, std::size_t step_between,
             std::size_t run) {
        device.launch(sum_runs, {count}, sum_runs.group(64), {4.0 * count * run, static_cast<double>(count) * run}, values, totals, first,
                      static_cast<cl_uint>(count), static_cast<cl_uint>(item), static_cast<cl_uint>(step_between),
                      static_cast<cl_uint>(run));
    }

    /// The crops' gradient, and their loss in slot `waiting`.
    void find_gradient(const std::vector<Crop>& crops) {
        if (crops.empty() || crops.size() > static_cast<std::size_t>(config.batch))
            throw Error(ErrorKind::internal, fmt::format("a step over {} patches; its batch is {}", crops.size(), config.batch));
        grid->set_parameters(parameter_values);
        gradients->set_parameters(parameter_values);
        if (matrices) matrices->set_parameters(parameter_values);
        const float share = static_cast<float>(1.0 / (3.0 * config.patch * config.patch * static_cast<double>(crops.size())));
        for (std::size_t first = 0; first < crops.size(); first += static_cast<std::size_t>(micro)) {
            const int n = static_cast<int>(std::min(crops.size() - first, static_cast<std::size_t>(micro)));
            for (int i = 0; i < n; ++i) assemble(crops[first + static_cast<std::size_t>(i)], i);
            if (matrices)
                matrices->forward(*grid, n);
            else
                grid->guide_network(n);
            grid->grids(n);
            gradients->backward(*grid, n, share, patch_gradients, patch_losses, first, matrices.get());
        }
        sum(patch_gradients, gradient, 0, parameters, 1, parameters, crops.size());
        sum(patch_losses, step_losses, waiting, 1, 1, 1, crops.size());
        ++waiting;
    }

    void fetch_losses() {
        for (const float loss : device.download<float>(step_losses, waiting)) losses.push_back(loss);
        waiting = 0;
    }
};

TrainingStep::TrainingStep(const Device& device, const Model& model, const StepConfig& config)
    : state_(std::make_unique<State>(device, model, config)) {
    State& s = *state_;
    validate(model);
    const auto fits = [&](int patches) {
        return s.bytes(patches) <= s.device.free_bytes() / 2 && s.largest_bytes(patches) <= s.device.max_alloc_bytes();
    };
    // 65536 pixels at once keep a CPU's caches (8 % faster than 8 times as many) and are enough to share between its cores.
    const int pixels = s.device.tunable("micro_pixels", device.facts().type == DeviceType::cpu ? 1 << 16 : 1 << 19);
    const int patches = std::max(1, pixels / (config.patch * config.patch));
    s.micro = std::min(config.batch, config.micro_batch > 0 ? config.micro_batch : patches);
    while (s.micro > 1 && !fits(s.micro)) s.micro = (s.micro + 1) / 2;
    s.grid = std::make_unique<NeuralGrid>(s.device, model, s.shape(s.micro));
    s.gradients = std::make_unique<Gradients>(s.device, model, config.loss, *s.grid, s.shape(s.micro));
    if (s.by_matrices()) s.matrices = std::make_unique<MatrixLayers>(s.device, model, s.shape(s.micro));
    s.parameter_values = s.device.upload(model.flat(), "parameters");
    for (Buffer* b : {&s.first_moment, &s.second_moment, &s.gradient}) {
        *b = s.device.buffer(s.parameters * 4, "moments");
        s.device.fill(*b, 0);
    }
    s.scale = s.device.upload(std::vector<float>{1}, "gradient scale");
    s.patch_gradients = s.device.buffer(s.parameters * 4 * static_cast<std::size_t>(config.batch), "gradients");
    s.patch_losses = s.device.buffer(static_cast<std::size_t>(config.batch) * 4, "losses");
    s.step_losses = s.device.buffer(loss_slots * 4, "losses");
    s.sum_runs = s.device.kernel("train/sum_runs");
    s.gradient_scale = s.device.kernel("train/gradient_scale");
    s.adam = s.device.kernel("train/adam");
}
TrainingStep::~TrainingStep() = default;

int TrainingStep::add_image(const Frame& noisy, const Frame& target) {
    State& s = *state_;
    s.plan.check(noisy);
    for (const char* c : {"R", "G", "B"})
        if (!target.has(c)) throw Error(ErrorKind::input, fmt::format("target lacks channel {}", c));
    if (target.width != noisy.width || target.height != noisy.height)
        throw Error(ErrorKind::input,
                    fmt::format("is {} x {} pixels, its target {} x {}", noisy.width, noisy.height, target.width, target.height));
    if (noisy.width < s.config.patch || noisy.height < s.config.patch)
        throw Error(ErrorKind::input,
                    fmt::format("is {} x {} pixels, smaller than a patch of {}", noisy.width, noisy.height, s.config.patch));
    Image image;
    image.width = noisy.width;
    image.height = noisy.height;
    image.params = s.plan.params(s.start.exposure ? exposure_of(noisy) : 1);
    s.plan.gather(noisy, &target, {0, 0, noisy.width, noisy.height}, image.on_host);
    const std::size_t bytes = image.on_host.size() * 4, reserve = s.device.free_bytes() / 8;
    if (bytes <= s.device.max_alloc_bytes() && bytes + reserve <= s.device.free_bytes()) {
        image.on_device = s.device.upload(image.on_host, "training image");
        image.on_host = {};
    }
    s.images.push_back(std::move(image));
    return static_cast<int>(s.images.size()) - 1;
}

int TrainingStep::images() const { return static_cast<int>(state_->images.size()); }

OptimizerState TrainingStep::state() const {
    State& s = *state_;
    return {s.device.download<float>(s.parameter_values, s.parameters), s.device.download<float>(s.first_moment, s.parameters),
            s.device.download<float>(s.second_moment, s.parameters), s.step};
}

void TrainingStep::set_state(const OptimizerState& state) {
    State& s = *state_;
    for (auto [from, to] : {std::pair(&state.parameters, &s.parameter_values),
                            {&state.first_moment, &s.first_moment},
                            {&state.second_moment, &s.second_moment}}) {
        if (from->size() != s.parameters)
            throw Error(ErrorKind::input, fmt::format("has {} parameters; the model has {}", from->size(), s.parameters));
        s.device.write(*to, from->data(), from->size() * 4);
    }
    s.step = state.step;
}

void TrainingStep::step(const std::vector<Crop>& crops, double learning_rate) {
    State& s = *state_;
    s.find_gradient(crops);
    const StepConfig& c = s.config;
    const auto n = static_cast<cl_uint>(s.parameters);
    if (c.clip_norm > 0) s.device.launch(s.gradient_scale, {1}, {1}, {}, s.gradient, n, static_cast<float>(c.clip_norm), s.scale);
    ++s.step;
    const shared::float4 rates{static_cast<float>(c.beta1), static_cast<float>(1 - c.beta1), static_cast<float>(c.beta2),
                               static_cast<float>(1 - c.beta2)};
    const std::array<float, 2> correction{static_cast<float>(1 / (1 - power(c.beta1, s.step))),
                                          static_cast<float>(1 / (1 - power(c.beta2, s.step)))};
    s.device.launch(s.adam, {n}, s.adam.group(64), {}, s.parameter_values, s.first_moment, s.second_moment, s.gradient, s.scale, rates,
                    correction, static_cast<float>(learning_rate), static_cast<float>(c.epsilon), n);
    if (s.waiting == loss_slots) s.fetch_losses();
}

std::vector<double> TrainingStep::take_losses() {
    state_->fetch_losses();
    return std::exchange(state_->losses, {});
}

double TrainingStep::gradient(const std::vector<Crop>& crops, std::vector<float>& gradient) {
    State& s = *state_;
    s.fetch_losses();
    s.find_gradient(crops);
    gradient = s.device.download<float>(s.gradient, s.parameters);
    const double loss = s.device.download<float>(s.step_losses, s.waiting).back();
    s.waiting = 0;
    return loss;
}

Model TrainingStep::model() const {
    Model m = state_->start;
    m.set_flat(state_->device.download<float>(state_->parameter_values, state_->parameters));
    return m;
}

} // namespace clvr

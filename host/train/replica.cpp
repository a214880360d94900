#include "host/train/replica.hpp"
#include "host/train/tunables.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace clvr {

namespace {

constexpr cl_uint loss_slots = 1024; // steps whose losses wait on the device

/// x^n by squaring: the same bits everywhere, which pow does not promise.
double power(double x, std::int64_t n) {
    double result = 1;
    for (; n > 0; n /= 2, x *= x)
        if (n % 2) result *= x;
    return result;
}

BatchShape shape_of(const StepConfig& c, int patches) { return {c.patch, c.patch, patches, false, true}; }

bool by_matrices(const StepConfig& c) { return c.convolution == ConvolutionBackend::clblast; }

/// Patches at once: what is asked for, less where memory is short.
int micro_batch_of(const Device& device, const Model& model, const StepConfig& c) {
    const auto fits = [&](int patches) {
        const BatchShape shape = shape_of(c, patches);
        const std::size_t bytes = NeuralGrid::bytes(device, model, shape) + Gradients::bytes(device, model, shape) +
                                  (by_matrices(c) ? MatrixLayers::bytes(model, shape) : 0);
        const std::size_t largest =
            std::max(Gradients::largest_bytes(device, model, shape), by_matrices(c) ? MatrixLayers::largest_bytes(model, shape) : 0);
        return bytes <= device.free_bytes() / 2 && largest <= device.max_alloc_bytes();
    };
    const int pixels = device.tunable(tunables::micro_pixels);
    int micro = std::min(c.batch, c.micro_batch > 0 ? c.micro_batch : std::max(1, pixels / (c.patch * c.patch)));
    while (micro > 1 && !fits(micro)) micro = (micro + 1) / 2;
    return micro;
}

} // namespace

Replica::Replica(const Device& device, const Model& model, const StepConfig& config)
    : device_(device), config_(config), parameters_(model.parameters()), micro_(micro_batch_of(device, model, config)) {
    const BatchShape shape = shape_of(config, micro_);
    grid_ = std::make_unique<NeuralGrid>(device_, model, shape);
    gradients_ = std::make_unique<Gradients>(device_, model, config.loss, *grid_, shape);
    if (by_matrices(config)) matrices_ = std::make_unique<MatrixLayers>(device_, model, shape);
    parameter_values_ = device_.upload(model.flat(), "parameters");
    for (Buffer* b : {&first_moment_, &second_moment_, &gradient_}) {
        *b = device_.buffer(parameters_ * 4, "moments");
        device_.fill(*b, 0);
    }
    scale_ = device_.upload(std::vector<float>{1}, "gradient scale");
    patch_gradients_ = device_.buffer(parameters_ * 4 * static_cast<std::size_t>(config.batch), "gradients");
    patch_losses_ = device_.buffer(static_cast<std::size_t>(config.batch) * 4, "losses");
    step_losses_ = device_.buffer(loss_slots * 4, "losses");
    sum_runs_ = device_.kernel("train/sum_runs");
    gradient_scale_ = device_.kernel("train/gradient_scale");
    adam_ = device_.kernel("train/adam");
}

std::shared_ptr<const Buffer> Replica::add_image(const TrainingImage& image, std::shared_ptr<const Buffer> uploaded) {
    const std::size_t bytes = image.planes.size() * 4, reserve = device_.free_bytes() / 8;
    if (!uploaded && bytes <= device_.max_alloc_bytes() && bytes + reserve <= device_.free_bytes())
        uploaded = std::make_shared<Buffer>(device_.upload(image.planes, "training image"));
    images_.push_back(uploaded);
    return uploaded;
}

void Replica::assemble(const Crop& crop, const TrainingImage& image, int n) {
    const int size = config_.patch;
    if (crop.x < 0 || crop.y < 0 || crop.x + size > image.width || crop.y + size > image.height || crop.orientation < 0 ||
        crop.orientation > 7)
        throw Error(ErrorKind::internal, fmt::format("crop at {}, {} of a {} x {} image", crop.x, crop.y, image.width, image.height));
    if (const auto& held = images_.at(static_cast<std::size_t>(crop.image)))
        return grid_->assemble(*held, image.width, image.height, image.params, crop.x, crop.y, crop.orientation, n);
    std::vector<float> part;
    const std::size_t plane = static_cast<std::size_t>(image.width) * image.height;
    for (std::size_t p = 0; p < image.planes.size() / plane; ++p)
        for (int y = 0; y < size; ++y) {
            const auto row =
                image.planes.begin() + static_cast<std::ptrdiff_t>(p * plane + static_cast<std::size_t>(crop.y + y) * image.width + crop.x);
            part.insert(part.end(), row, row + size);
        }
    if (!crop_planes_) crop_planes_ = device_.buffer(part.size() * 4, "crop");
    device_.write(crop_planes_, part.data(), part.size() * 4);
    grid_->assemble(crop_planes_, size, size, image.params, 0, 0, crop.orientation, n);
}

void Replica::begin() {
    grid_->set_parameters(parameter_values_);
    gradients_->set_parameters(parameter_values_);
    if (matrices_) matrices_->set_parameters(parameter_values_);
}

void Replica::find_gradients(const std::vector<Crop>& crops, const std::vector<TrainingImage>& images, std::size_t first, std::size_t count,
                             float share) {
    for (const std::size_t end = first + count; first < end; first += static_cast<std::size_t>(micro_)) {
        const int n = static_cast<int>(std::min(end - first, static_cast<std::size_t>(micro_)));
        for (int i = 0; i < n; ++i) {
            const Crop& crop = crops[first + static_cast<std::size_t>(i)];
            assemble(crop, images.at(static_cast<std::size_t>(crop.image)), i);
        }
        if (matrices_)
            matrices_->forward(*grid_, n);
        else
            grid_->guide_network(n);
        grid_->grids(n);
        gradients_->backward(*grid_, n, share, patch_gradients_, patch_losses_, first, matrices_.get());
    }
}

void Replica::sum(const Buffer& values, const Buffer& totals, cl_uint first, std::size_t count, std::size_t item, std::size_t step_between,
                  std::size_t run) {
    device_.launch(sum_runs_, {count}, sum_runs_.group(64), {4.0 * count * run, static_cast<double>(count) * run}, values, totals, first,
                   static_cast<cl_uint>(count), static_cast<cl_uint>(item), static_cast<cl_uint>(step_between), static_cast<cl_uint>(run));
}

void Replica::sum_patches(std::size_t patches) {
    sum(patch_gradients_, gradient_, 0, parameters_, 1, parameters_, patches);
    sum(patch_losses_, step_losses_, waiting_, 1, 1, 1, patches);
    ++waiting_;
}

void Replica::adam(std::int64_t step, double learning_rate) {
    const StepConfig& c = config_;
    const auto n = static_cast<cl_uint>(parameters_);
    if (c.clip_norm > 0) device_.launch(gradient_scale_, {1}, {1}, {}, gradient_, n, static_cast<float>(c.clip_norm), scale_);
    const shared::float4 rates{static_cast<float>(c.beta1), static_cast<float>(1 - c.beta1), static_cast<float>(c.beta2),
                               static_cast<float>(1 - c.beta2)};
    const std::array<float, 2> correction{static_cast<float>(1 / (1 - power(c.beta1, step))),
                                          static_cast<float>(1 / (1 - power(c.beta2, step)))};
    device_.launch(adam_, {n}, adam_.group(64), {}, parameter_values_, first_moment_, second_moment_, gradient_, scale_, rates, correction,
                   static_cast<float>(learning_rate), static_cast<float>(c.epsilon), n);
}

std::vector<float> Replica::take_losses() {
    const std::vector<float> losses = device_.download<float>(step_losses_, waiting_);
    waiting_ = 0;
    return losses;
}

bool Replica::losses_full() const { return waiting_ == loss_slots; }

std::vector<float> Replica::gradient() { return device_.download<float>(gradient_, parameters_); }

OptimizerState Replica::state() {
    return {device_.download<float>(parameter_values_, parameters_), device_.download<float>(first_moment_, parameters_),
            device_.download<float>(second_moment_, parameters_), 0};
}

void Replica::set_state(const OptimizerState& state) {
    for (auto [from, to] :
         {std::pair(&state.parameters, &parameter_values_), {&state.first_moment, &first_moment_}, {&state.second_moment, &second_moment_}})
        device_.write(*to, from->data(), from->size() * 4);
    waiting_ = 0;
}

void Replica::set_parameters(const std::vector<float>& parameters) {
    device_.write(parameter_values_, parameters.data(), parameters.size() * 4);
}

} // namespace clvr

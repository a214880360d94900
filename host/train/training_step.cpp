#include "host/train/training_step.hpp"
#include "host/train/replica.hpp"
#include "runtime/error.hpp"
#include "runtime/schedule/scheduler.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace clvr {

namespace {

/// The device that did a patch, and the gradient where that device does not share the leader's context.
struct PatchRow {
    std::size_t device = 0;
    std::vector<float> gradient;
    float loss = 0;
};

} // namespace

/// A single device enqueues step after step. Several devices share a step's patches: the first one that is left, the leader, sums their
/// gradients in patch order and takes the step. The host then holds the result, so that the next device can continue from there should the
/// leader fail.
struct TrainingStep::State {
    Model start;
    StepConfig config;
    ChannelPlan plan;
    std::size_t parameters;
    Scheduler scheduler;
    std::vector<std::unique_ptr<Replica>> replicas; // by device; null for one that failed at once
    std::vector<TrainingImage> images;
    std::int64_t step = 0;
    std::vector<double> losses;
    // Of several devices:
    OptimizerState present;
    std::size_t leader = 0; // the device that holds the moments of `present`
    std::vector<PatchRow> rows;
    bool compared = false;

    State(const std::vector<Device>& devices, const Model& m, const StepConfig& c)
        : start(m), config(c), plan(m, true), parameters(m.parameters()), scheduler(devices), replicas(devices.size()) {}

    bool alone() const { return replicas.size() == 1; }
    Replica& only() const { return *replicas.front(); }
    bool same_context(std::size_t a, std::size_t b) const { return replicas[a]->device().context()() == replicas[b]->device().context()(); }

    float share_of(const std::vector<Crop>& crops) const {
        if (crops.empty() || crops.size() > static_cast<std::size_t>(config.batch))
            throw Error(ErrorKind::internal, fmt::format("a step over {} patches; its batch is {}", crops.size(), config.batch));
        return static_cast<float>(1.0 / (3.0 * config.patch * config.patch * static_cast<double>(crops.size())));
    }

    void find_alone(const std::vector<Crop>& crops) {
        const float share = share_of(crops);
        only().begin();
        only().find_gradients(crops, images, 0, crops.size(), share);
        only().sum_patches(crops.size());
    }

    /// All devices that are left share the patches. `rows` notes which device did which patch.
    void find_gradients(const std::vector<Crop>& crops) {
        const float share = share_of(crops);
        rows.resize(crops.size());
        std::vector<Scheduler::ChunkSize> chunk_sizes(replicas.size());
        const std::size_t to = scheduler.left().front();
        scheduler.each([&](std::size_t k) {
            chunk_sizes[k].most = static_cast<std::uint32_t>(replicas[k]->micro_batch());
            replicas[k]->begin();
        });
        if (!std::exchange(compared, true)) // one that computes other bits must not mix with the others
            scheduler.compare("gradients", [&](std::size_t k) {
                Replica& r = *replicas[k];
                r.find_gradients(crops, images, 0, 1, share);
                const auto row = r.device().download<float>(r.patch_gradients(), parameters);
                return std::string(reinterpret_cast<const char*>(row.data()), row.size() * sizeof(float));
            });
        scheduler.run("patches", static_cast<std::uint32_t>(crops.size()), 1, chunk_sizes,
                      [&](std::size_t k, std::uint32_t first, std::uint32_t count) {
                          Replica& r = *replicas[k];
                          r.find_gradients(crops, images, first, count, share);
                          if (same_context(k, to)) r.device().finish();
                          for (std::size_t i = first; i < first + count; ++i) {
                              rows[i].device = k;
                              if (same_context(k, to)) continue; // the leader copies it on its device
                              rows[i].gradient = r.device().download<float>(r.patch_gradients(), parameters, i * parameters);
                              rows[i].loss = r.device().download<float>(r.patch_losses(), 1, i).front();
                          }
                      });
    }

    /// Brings the rows of the others to the leader.
    void gather(std::size_t to) {
        Device& device = replicas[to]->device();
        Buffer &gradients = replicas[to]->patch_gradients(), &patch_losses = replicas[to]->patch_losses();
        const std::size_t row = parameters * 4;
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const PatchRow& r = rows[i];
            if (r.device == to) continue;
            if (same_context(r.device, to)) {
                copy(device, replicas[r.device]->patch_gradients(), gradients, row, i * row, i * row);
                copy(device, replicas[r.device]->patch_losses(), patch_losses, 4, i * 4, i * 4);
            } else {
                device.write(gradients, r.gradient.data(), row, i * row);
                device.write(patch_losses, &r.loss, 4, i * 4);
            }
        }
    }

    /// Finds the crops' gradient on all devices, sums it on the leader, then calls finish(leader). Whenever the leader fails, all of this
    /// is done again by the devices that are left.
    template <class Finish>
    void together(const std::vector<Crop>& crops, Finish&& finish) {
        for (;;) {
            const std::size_t first = scheduler.left().front();
            find_gradients(crops);
            if (scheduler.left().front() != first) continue;
            try {
                if (leader != first) replicas[first]->set_state(present);
                leader = first;
                gather(first);
                replicas[first]->sum_patches(crops.size());
                return finish(*replicas[first]);
            } catch (const Error& error) {
                if (!is_device_failure(error)) throw;
                scheduler.drop(first, error);
            }
        }
    }

    void step_alone(const std::vector<Crop>& crops, double learning_rate) {
        find_alone(crops);
        only().adam(++step, learning_rate);
        if (only().losses_full()) fetch_losses();
    }

    void step_together(const std::vector<Crop>& crops, double learning_rate) {
        together(crops, [&](Replica& r) {
            r.adam(step + 1, learning_rate);
            OptimizerState next = r.state();
            const float loss = r.take_losses().back();
            present = std::move(next);
            present.step = ++step;
            losses.push_back(loss);
        });
        scheduler.each([&](std::size_t k) {
            if (k != leader) replicas[k]->set_parameters(present.parameters);
        });
    }

    void fetch_losses() {
        if (!alone()) return;
        for (const float loss : only().take_losses()) losses.push_back(loss);
    }
};

TrainingStep::TrainingStep(const Device& device, const Model& model, const StepConfig& config)
    : TrainingStep(std::vector<Device>{device}, model, config) {}

TrainingStep::TrainingStep(const std::vector<Device>& devices, const Model& model, const StepConfig& config)
    : state_(std::make_unique<State>(devices, model, config)) {
    State& s = *state_;
    validate(model);
    if (!s.alone() && config.convolution == ConvolutionBackend::clblast)
        throw Error(ErrorKind::usage, "takes one device: its sums have another order on each; give one --device", "--conv clblast");
    s.scheduler.each([&](std::size_t k) { s.replicas[k] = std::make_unique<Replica>(devices[k], model, config); });
    s.leader = s.scheduler.left().front();
    s.present = {model.flat(), std::vector<float>(s.parameters), std::vector<float>(s.parameters), 0};
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
    TrainingImage image{noisy.width, noisy.height, s.plan.params(noisy), {}};
    s.plan.gather(noisy, &target, {0, 0, noisy.width, noisy.height}, s.plan.known_light(noisy), image.planes);
    std::vector<std::shared_ptr<const Buffer>> uploaded(s.replicas.size());
    s.scheduler.each([&](std::size_t k) {
        std::shared_ptr<const Buffer> from; // devices of one context share an upload
        for (std::size_t other = 0; other < k; ++other)
            if (uploaded[other] && s.same_context(other, k)) from = uploaded[other];
        uploaded[k] = s.replicas[k]->add_image(image, from);
    });
    const auto left = s.scheduler.left();
    if (std::all_of(left.begin(), left.end(), [&](std::size_t k) { return uploaded[k] != nullptr; })) image.planes = {};
    s.images.push_back(std::move(image));
    return static_cast<int>(s.images.size()) - 1;
}

int TrainingStep::images() const { return static_cast<int>(state_->images.size()); }

std::vector<Device> TrainingStep::devices() const {
    std::vector<Device> devices;
    for (const std::size_t k : state_->scheduler.left()) devices.push_back(state_->replicas[k]->device());
    return devices;
}

OptimizerState TrainingStep::state() const {
    State& s = *state_;
    OptimizerState state = s.alone() ? s.only().state() : s.present;
    state.step = s.step;
    return state;
}

void TrainingStep::set_state(const OptimizerState& state) {
    State& s = *state_;
    for (const auto* values : {&state.parameters, &state.first_moment, &state.second_moment})
        if (values->size() != s.parameters)
            throw Error(ErrorKind::input, fmt::format("has {} parameters; the model has {}", values->size(), s.parameters));
    s.fetch_losses();
    s.present = state;
    s.step = state.step;
    s.scheduler.each([&](std::size_t k) { s.replicas[k]->set_state(state); });
}

void TrainingStep::step(const std::vector<Crop>& crops, double learning_rate) {
    if (state_->alone())
        state_->step_alone(crops, learning_rate);
    else
        state_->step_together(crops, learning_rate);
}

std::vector<double> TrainingStep::take_losses() {
    state_->fetch_losses();
    return std::exchange(state_->losses, {});
}

double TrainingStep::gradient(const std::vector<Crop>& crops, std::vector<float>& gradient) {
    State& s = *state_;
    s.fetch_losses();
    double loss = 0;
    const auto fetch = [&](Replica& r) {
        gradient = r.gradient();
        loss = r.take_losses().back();
    };
    if (s.alone()) {
        s.find_alone(crops);
        fetch(s.only());
    } else {
        s.together(crops, fetch);
    }
    return loss;
}

Model TrainingStep::model() const {
    Model m = state_->start;
    m.set_flat(state().parameters);
    return m;
}

} // namespace clvr

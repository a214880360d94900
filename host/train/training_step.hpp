// One step of training on a device or several: crops, forward, loss, backward, Adam.
#pragma once
#include "host/denoise/model.hpp"
#include "host/frame/frame.hpp"
#include "host/train/matrix_layers.hpp"
#include "runtime/opencl/device.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace clvr {

/// How far a result is from its target; the formulas are in kernels/denoise/README.md, "Loss". The last one also punishes errors of the
/// size of blotches, which eyes see as mottle.
enum class Loss { shifted_gamma, reference, smape, relative_l2, noisy, shifted_gamma_l2, shifted_gamma_bands };

/// A patch: its image (the number that add_image gave), its top left pixel, and one of the 8 dihedral transforms, numbered as in
/// kernels/denoise/README.md, "Training".
struct Crop {
    int image = 0, x = 0, y = 0, orientation = 0;
};

struct StepConfig {
    Loss loss = Loss::shifted_gamma;
    ConvolutionBackend convolution = ConvolutionBackend::direct;
    int patch = 256;     ///< width and height [pixels]
    int batch = 128;     ///< patches of a step
    int micro_batch = 0; ///< patches on the device at once; 0: what memory allows (the same bits for any)
    double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8;
    double clip_norm = 0; ///< greatest L2 norm of a step's gradient, 0: not clipped
};

/// Parameters (order of Model::flat) and the moments of Adam after `step` steps.
struct OptimizerState {
    std::vector<float> parameters, first_moment, second_moment;
    std::int64_t step = 0;
};

class TrainingStep {
public:
    /// Throws Error; {memory} when not even one patch fits.
    TrainingStep(const Device& device, const Model& model, const StepConfig& config);
    /// Several devices share each step's patches; gradients are summed in patch order, so the bits are those of one. A device that fails is
    /// left out with a warning, and the others do its work; the last one's failure is thrown. CLBlast convolves on one device only:
    /// Error{usage}.
    TrainingStep(const std::vector<Device>& devices, const Model& model, const StepConfig& config);
    ~TrainingStep();

    /// Makes an image known: a noisy frame with the model's channels and its target's R G B (premultiplied, as wide and high). Kept on the
    /// device while it fits, else on the host. Throws Error{input} when a channel is missing or sizes differ.
    int add_image(const Frame& noisy, const Frame& target);
    int images() const;
    /// The devices that have not failed.
    std::vector<Device> devices() const;

    OptimizerState state() const;
    void set_state(const OptimizerState& state);

    /// One step at the given learning rate over any number of crops up to `batch` (the mean is over those given). One device alone only
    /// enqueues it: the loss comes later.
    void step(const std::vector<Crop>& crops, double learning_rate);
    /// The mean loss of each step since the last call, in order; NaN where it was NaN. Waits for the steps.
    std::vector<double> take_losses();
    /// The loss and gradient (order of Model::flat) of crops without a step.
    double gradient(const std::vector<Crop>& crops, std::vector<float>& gradient);

    /// The model with the present parameters.
    Model model() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace clvr

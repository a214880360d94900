// One step of training on a device or several: crops, forward, loss, backward, Adam.
#pragma once
#include "host/denoise/model.hpp"
#include "host/frame/frame.hpp"
#include "host/train/matrix_layers.hpp"
#include "runtime/device.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace clvr {

/// Of DESIGN.md "Loss": mean absolute error in a shifted gamma (the default), in SPEC's clipped gamma, symmetric relative error |a-b| /
/// (|a|+|b|+0.01), (a-b)^2 / (b^2+0.01), the noise-to-noise loss (a-b)^2 / (sg(a)+0.01)^2 against a noisy target, mean squared error in
/// the shifted gamma, and that with 4 times the squared band of its errors: the mean of each 8x8 pixels about the mean of 32x32 (mottle).
enum class Loss { shifted_gamma, reference, smape, relative_l2, noisy, shifted_gamma_l2, shifted_gamma_bands };

/// A patch: of which image (as add_image numbered it), its top left pixel, and one of the 8 dihedral transforms as SPEC section 9 numbers
/// them.
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
    /// The mean loss of each step since the last call, in order; waits for them. NaN where it was.
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

// The network in training on one device. Several devices hold replicas with the same parameters and share a batch's patches.
#pragma once
#include "host/denoise/neural_grid.hpp"
#include "host/train/gradients.hpp"
#include "host/train/matrix_layers.hpp"
#include "host/train/training_step.hpp"

#include <memory>
#include <vector>

namespace clvr {

/// A training image on the host: planes of a ChannelPlan with target. `planes` is empty where every replica holds them.
struct TrainingImage {
    int width = 0, height = 0;
    shared::SourceParams params{};
    std::vector<float> planes;
};

class Replica {
public:
    /// Throws Error; {memory} when not even one patch fits.
    Replica(const Device& device, const Model& model, const StepConfig& config);

    /// The next image: taken from `uploaded` (of the same context) where given, else uploaded while it fits. Null where the device lacks
    /// the room; find_gradients then reads the host's planes.
    std::shared_ptr<const Buffer> add_image(const TrainingImage& image, std::shared_ptr<const Buffer> uploaded);

    /// Makes the present parameters those of the next find_gradients().
    void begin();
    /// Gradient and loss of crops first .. first + count - 1 into these rows of patch_gradients() and patch_losses(). `share` is what a
    /// colour of a pixel counts in the mean.
    void find_gradients(const std::vector<Crop>& crops, const std::vector<TrainingImage>& images, std::size_t first, std::size_t count,
                        float share);
    /// Sums the first `patches` rows in order: the gradient, and the loss in the next of loss_slots.
    void sum_patches(std::size_t patches);
    /// Adam's step number `step` (from 1) with the summed gradient.
    void adam(std::int64_t step, double learning_rate);

    /// The sums of losses since the last call; waits for them.
    std::vector<float> take_losses();
    bool losses_full() const;
    std::vector<float> gradient();
    /// Parameters and moments; `step` stays 0.
    OptimizerState state();
    void set_state(const OptimizerState& state);
    void set_parameters(const std::vector<float>& parameters);

    Device& device() { return device_; }
    /// Patches that the device takes at once.
    int micro_batch() const { return micro_; }
    Buffer& patch_gradients() { return patch_gradients_; } ///< [batch][parameters]
    Buffer& patch_losses() { return patch_losses_; }       ///< [batch]

private:
    Device device_;
    StepConfig config_;
    std::size_t parameters_;
    int micro_ = 1;
    std::unique_ptr<NeuralGrid> grid_;
    std::unique_ptr<Gradients> gradients_;
    std::unique_ptr<MatrixLayers> matrices_; // null: the direct kernels convolve
    std::vector<std::shared_ptr<const Buffer>> images_;
    Buffer parameter_values_, first_moment_, second_moment_, scale_, crop_planes_;
    Buffer patch_gradients_, patch_losses_, gradient_, step_losses_;
    Kernel sum_runs_, gradient_scale_, adam_;
    cl_uint waiting_ = 0; // losses in step_losses_

    void assemble(const Crop& crop, const TrainingImage& image, int n);
    void sum(const Buffer& values, const Buffer& totals, cl_uint first, std::size_t count, std::size_t item, std::size_t step_between,
             std::size_t run);
};

} // namespace clvr

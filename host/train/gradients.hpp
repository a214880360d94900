// The backward pass of NeuralGrid: from its result to the gradient of every parameter, for each image by itself.
#pragma once
#include "host/denoise/neural_grid.hpp"
#include "host/train/matrix_layers.hpp"
#include "host/train/training_step.hpp"

namespace clvr {

class Gradients {
public:
    /// Allocates beside `forward`, whose batch has the given shape. Throws Error{device_memory}.
    Gradients(const Device& device, const Model& model, Loss loss, const NeuralGrid& forward, const BatchShape& shape);

    /// Takes the parameters (order of Model::flat).
    void set_parameters(const Buffer& parameters);
    /// After forward.forward(images): the gradients of the first `images` images become rows first .. of `patch_gradients`
    /// [..][parameters], their losses elements first .. of `patch_losses`. `share` is what a colour of a pixel counts in the mean.
    /// `matrices` convolve in place of the direct kernels, where given.
    void backward(NeuralGrid& forward, int images, float share, const Buffer& patch_gradients, const Buffer& patch_losses,
                  std::size_t first, MatrixLayers* matrices = nullptr);

    /// Device bytes beside those of the forward pass, and the largest single buffer of both.
    static std::size_t bytes(const Device& device, const Model& model, const BatchShape& shape);
    static std::size_t largest_bytes(const Device& device, const Model& model, const BatchShape& shape);

    // What backward() leaves, for tests: planes of dL/dresult, dL/d(sums before the sigmoid), dL/d(hidden sums); A and b of each cell.
    const Buffer& result_gradient() const { return result_gradient_; }
    const Buffer& output_gradient() const { return output_gradient_; }
    const Buffer& hidden_gradient() const { return hidden_gradient_; }
    const Buffer& cell_gradient() const { return cell_gradient_; }

private:
    Device device_;
    bool with_bands_;
    int channels_, hidden_, outputs_, levels_, kernel_;
    std::size_t parameters_, conv1_, bias1_, conv2_;
    int width_; // lanes of 16 that a work-item takes
    Kernel column_errors_, bands_, loss_, slice_gradient_, normalise_gradient_, guide_gradient_, bias_gradient_, sum_lanes_, sum_runs_;
    Kernel weight_gradient1_, weight_gradient2_;
    int block1_, block2_;
    Convolution to_hidden_;
    Buffer result_gradient_, upstream_, cell_gradient_, output_gradient_, hidden_gradient_, lanes_, loss_lanes_, row_losses_, columns_,
        banded_, nothing_;

    void find_bands(const NeuralGrid& forward, int images);
    void weight_gradients(NeuralGrid& forward, int images, const Buffer& patch_gradients, std::size_t first, MatrixLayers* matrices);
};

} // namespace clvr

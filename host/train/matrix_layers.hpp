// GuideNet's convolutions as matrix products by CLBlast.
#pragma once
#include "host/denoise/neural_grid.hpp"

namespace clvr {

/// Which kernels convolve in training.
enum class ConvolutionBackend { direct, clblast };

/// Forward and backward convolutions of a training batch as im2col and SGEMM (CLBlast), image by image: the other backend beside the direct
/// kernels. Its sums have an order of its own, so the bits differ; forward and input gradients agree with the direct ones to 5e-6 of the
/// maximum, weight gradients (sums over all pixels of an image) to 5e-5.
class MatrixLayers {
public:
    /// Allocates the matrices of one image. Throws Error{device_memory}.
    MatrixLayers(const Device& device, const Model& model, const BatchShape& shape);

    /// Takes the parameters (order of Model::flat), which must live on.
    void set_parameters(const Buffer& parameters);
    /// grid.input() to grid.hidden() and grid.outputs(), like NeuralGrid::guide_network. Throws Error{device} naming CLBlast's status.
    void forward(NeuralGrid& grid, int images);
    /// dL/d(output sums) to dL/d(hidden sums).
    void hidden_gradient(NeuralGrid& grid, int images, const Buffer& output_gradient, const Buffer& hidden_gradient);
    /// Gradients of both layers' weights into rows first .. of `patch_gradients` [..][parameters]; those of the biases stay as they are.
    void weight_gradients(NeuralGrid& grid, int images, const Buffer& output_gradient, const Buffer& hidden_gradient,
                          const Buffer& patch_gradients, std::size_t first);

    static std::size_t bytes(const Model& model, const BatchShape& shape);
    static std::size_t largest_bytes(const Model& model, const BatchShape& shape);

private:
    struct Matrix {
        const Buffer* buffer;
        std::size_t offset; ///< [floats]
        std::size_t columns;
        bool transposed = false;
    };

    Device device_;
    int channels_, hidden_, outputs_, kernel_;
    std::size_t pixels_, parameters_, conv1_, bias1_, conv2_;
    Kernel unfold_, unfold_one_, leaky_, sigmoid_, slope_, pack_;
    Buffer unfolded_, dense_, mirrored_, mirrored_from_;
    const Buffer* weights_ = nullptr;

    Range items(const shared::DenoiseParams& shape, int channels) const;
    /// c [rows][columns] = a [rows][inner] b [inner][columns], row-major.
    void product(const Matrix& a, const Matrix& b, const Matrix& c, std::size_t rows, std::size_t columns, std::size_t inner);
    /// `with_taps`: a row a tap; without: the planes without their borders.
    void unfold(NeuralGrid& grid, bool with_taps, const Buffer& planes, int channels, int image, const Buffer& to);
    void activate(NeuralGrid& grid, Kernel& kernel, std::size_t bias, int channels, int image, const Buffer& planes);
};

} // namespace clvr

// GuideNet and the bilateral grids over a batch of equal images, on a device.
#pragma once
#include "host/denoise/channels.hpp"
#include "host/denoise/model.hpp"
#include "runtime/opencl/device.hpp"

#include <functional>
#include <vector>

namespace clvr {

/// What a batch is made of. All sizes in pixels.
struct BatchShape {
    int width = 0, height = 0, images = 1;
    bool show = false;   ///< keep each level's own result
    bool target = false; ///< images come with targets
    bool bands =
        false; ///< of one image, the network's input and hidden layer are kept for a band of rows at a time: picture() alone serves
};

/// Channels that a work-item computes at once: the greatest divisor of `channels` up to `most`, so that none is computed in vain.
int channels_at_once(int channels, int most);

/// A convolution kernel with its weights in the kernel's order.
class Convolution {
public:
    Convolution() = default;
    /// `stage`: kernels/<stage>.cl. The layer's weights begin at parameter `first` of the model, its biases at `first_bias` (none
    /// backwards). Forward maps `in` channels to `out`; `mirrored` is the backward one, from the layer's `in` outputs to its `out` inputs.
    /// `row_width`: pixels of a row.
    Convolution(Device& device, const std::string& stage, int in, int out, int kernel, std::size_t first, std::size_t first_bias,
                bool mirrored, int row_width);
    /// Takes the parameters (order of Model::flat).
    void set_parameters(Device& device, const Buffer& parameters);
    /// Convolves the planes `in` to `out` (DenoiseParams), for so many images; `more` are the stage's further arguments.
    template <class... More>
    void run(Device& device, const shared::DenoiseParams& shape, int images, const Buffer& params, const Buffer& in, const Buffer& out,
             const More&... more) {
        run_rows(device, shape, shape.height, images, params, in, out, more...);
    }
    /// The same for so many rows.
    template <class... More>
    void run_rows(Device& device, const shared::DenoiseParams& shape, int rows, int images, const Buffer& params, const Buffer& in,
                  const Buffer& out, const More&... more) {
        device.launch(kernel_, range(shape.width, rows, images), group_, work(shape.width, rows, images), params, in, weights_, bias_, out,
                      more...);
    }
    /// For images of this width, the floats of a row of a plane are a multiple of this, plus the borders.
    static int row_granularity(const Device& device, int row_width);

private:
    Kernel kernel_, pack_;
    Buffer weights_, bias_, weights_from_, bias_from_;
    Range group_;
    int in_ = 0, out_ = 0, size_ = 0, step_ = 1;

    Range range(int width, int rows, int images) const;
    Work work(int width, int rows, int images) const;
};

/// Device memory that a filter takes beside the film.
struct ScratchBuffer {
    const char* label;
    std::size_t bytes;
    bool zeros; ///< holds zeros at first: borders of planes
};

class NeuralGrid {
public:
    /// Allocates the batch's buffers. Throws Error{device_memory}. Memory of `former`, if any, serves again where it suffices; what does
    /// not is made for `largest`: shapes come and go without new memory, whose first touch costs more than the kernels (0.8 ms a MB on
    /// PoCL).
    NeuralGrid(const Device& device, const Model& model, const BatchShape& shape, NeuralGrid* former, const BatchShape& largest);
    NeuralGrid(const Device& device, const Model& model, const BatchShape& shape) : NeuralGrid(device, model, shape, nullptr, shape) {}
    /// Has the programs built that forward() takes for such images (Device::prepare).
    static void prepare(Device& device, const Model& model, int width, int height, bool show);

    /// Takes the parameters (order of Model::flat).
    void set_parameters(const Buffer& parameters);
    /// Image n of the batch becomes the part of `source` (planes of a ChannelPlan, `source_width` x `source_height` each) at (x, y), in one
    /// of the 8 orientations. `channels`: ChannelPlan::channels for other planes than the plan's.
    void assemble(const Buffer& source, int source_width, int source_height, const shared::SourceParams& params, int x, int y,
                  int orientation, int n, const Buffer* channels = nullptr);
    /// From the assembled images to result().
    void forward(int images);
    /// A batch of one image, from its pixels to result(), band by band through the network: assemble() and forward(), the same bits in less
    /// memory. `between` is called between its steps; it may throw.
    void picture(const Buffer& source, int source_width, int source_height, const shared::SourceParams& params, int x, int y,
                 const Buffer& channels, const std::function<void()>& between);

    /// Memory of a batch, and its sum [bytes].
    static std::vector<ScratchBuffer> scratch(const Device& device, const Model& model, const BatchShape& shape);
    static std::size_t bytes(const Device& device, const Model& model, const BatchShape& shape);
    /// What it has of the device's memory [bytes].
    std::size_t held_bytes();
    /// Shapes of the planes and grids.
    static shared::DenoiseParams params_of(const Device& device, const Model& model, int width, int height);

    const shared::DenoiseParams& shape() const { return params_; }
    std::size_t plane_floats(int channels) const { return static_cast<std::size_t>(batch_.images) * channels * params_.plane; }
    std::size_t pixels() const { return static_cast<std::size_t>(batch_.images) * params_.width * params_.height; }
    const Buffer& params() const { return params_buffer_; }
    const Buffer& input() const { return input_; }               ///< planes, model.channels; this and hidden() with bands of the last one
    const Buffer& hidden() const { return hidden_; }             ///< planes, model.hidden, after the activation
    const Buffer& outputs() const { return outputs_; }           ///< planes, model.outputs(), 0..1
    const Buffer& splatted() const { return splatted_; }         ///< float4 a pixel: demodulated radiance, weight
    const Buffer& remodulation() const { return remodulation_; } ///< float4 a pixel
    const Buffer& cells() const { return cells_; }               ///< float4 a cell: mean colour, weight
    const Buffer& result() const { return result_; }             ///< planes, 3, or 3 + 3 levels with `show`
    const Buffer& target() const { return target_; }             ///< planes, 3
    const Buffer& known() const { return known_; }               ///< planes, 3: the known light of a model that takes it off

    /// The stages alone: forward() is guide_network() and then grids().
    void guide_network(int images);
    void grids(int images);
    /// Splats float4 colours (from image `first_image` of `pixels` on) into a level of `cells`: means and weights, or with `sums` the sums.
    void splat(int level, int images, const Buffer& pixels, int first_image, const Buffer& cells, bool sums);
    void slice(int images);
    /// A plane without its border, [height * width], from planes of so many channels.
    std::vector<float> download(const Buffer& planes, int channels, int image, int channel);

    /// Work-items of a kernel over all pixels, pixel_width() of a row each; the group to ask it for (Kernel::group).
    Range pixel_items(int images) const;
    Range pixel_group() const;
    /// Pixels of a row that a work-item takes (tunable conv_width).
    static int pixel_width(const Device& device);

private:
    Device device_;
    int levels_, channels_;
    BatchShape batch_;
    shared::DenoiseParams params_, band_; // of the picture, and of the network's input and hidden layer
    int halo_;                            // rows around a band's guides
    Kernel assemble_, slice_;
    std::vector<Kernel> splat_, sum_;
    std::vector<int> bins_;
    Convolution to_hidden_, to_outputs_;
    Buffer params_buffer_, band_buffer_, channel_list_, input_, hidden_, outputs_, splatted_, remodulation_, cells_, result_, target_,
        known_;

    void assemble_band(int shift, const Buffer& source, int source_width, int source_height, const shared::SourceParams& params, int x,
                       int y, int orientation, int n, const Buffer& channels);
    Range pixel_items(int rows, int images) const;
    void guide_band(int shift, int first, int end, int images);
    /// In the order of scratch().
    std::vector<Buffer*> scratch_buffers();
};

} // namespace clvr

#include "host/train/matrix_layers.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <clblast.h>
#include <fmt/format.h>

namespace clvr {

namespace {

/// Rows of the unfolded matrix and of the dense one.
std::size_t unfolded_rows(const Model& m) {
    return static_cast<std::size_t>(std::max({static_cast<int>(m.channels.size()), m.hidden, m.outputs()})) * m.kernel * m.kernel;
}
std::size_t dense_rows(const Model& m) { return static_cast<std::size_t>(std::max(m.hidden, m.outputs())); }

} // namespace

std::size_t MatrixLayers::largest_bytes(const Model& model, const BatchShape& shape) {
    return unfolded_rows(model) * shape.width * shape.height * 4;
}

std::size_t MatrixLayers::bytes(const Model& model, const BatchShape& shape) {
    return largest_bytes(model, shape) + dense_rows(model) * shape.width * shape.height * 4;
}

MatrixLayers::MatrixLayers(const Device& device, const Model& model, const BatchShape& shape)
    : device_(device), channels_(static_cast<int>(model.channels.size())), hidden_(model.hidden), outputs_(model.outputs()),
      kernel_(model.kernel), pixels_(static_cast<std::size_t>(shape.width) * shape.height), parameters_(model.parameters()),
      conv1_(model.conv1_weight.size()), bias1_(model.conv1_bias.size()), conv2_(model.conv2_weight.size()) {
    unfold_ = device_.kernel("train/unfold", {{"CLVR_KERNEL", std::to_string(kernel_)}});
    unfold_one_ = device_.kernel("train/unfold", {{"CLVR_KERNEL", "1"}});
    leaky_ = device_.kernel("train/activate", {{"CLVR_ACTIVATION", "0"}});
    sigmoid_ = device_.kernel("train/activate", {{"CLVR_ACTIVATION", "1"}});
    slope_ = device_.kernel("train/activate", {{"CLVR_ACTIVATION", "2"}});
    pack_ = device_.kernel("denoise/pack_weights");
    unfolded_ = device_.buffer(largest_bytes(model, shape), "unfolded planes");
    dense_ = device_.buffer(dense_rows(model) * pixels_ * 4, "matrix product");
    std::vector<std::int32_t> from; // the second layer's weights, transposed and mirrored: [hidden][outputs][taps]
    const int taps = kernel_ * kernel_;
    for (int i = 0; i < hidden_; ++i)
        for (int o = 0; o < outputs_; ++o)
            for (int tap = taps - 1; tap >= 0; --tap)
                from.push_back(static_cast<std::int32_t>(conv1_ + bias1_) + (o * hidden_ + i) * taps + tap);
    mirrored_from_ = device_.upload(from, "weight order");
    mirrored_ = device_.buffer(from.size() * 4, "mirrored weights");
}

void MatrixLayers::set_parameters(const Buffer& parameters) {
    weights_ = &parameters;
    const auto n = static_cast<cl_uint>(conv2_);
    device_.launch(pack_, {n}, pack_.group(64), {n * 12.0, 0}, parameters, mirrored_from_, mirrored_, n);
}

Range MatrixLayers::items(const shared::DenoiseParams& shape, int channels) const {
    return {static_cast<std::size_t>(shape.width), static_cast<std::size_t>(shape.height), static_cast<std::size_t>(channels)};
}

void MatrixLayers::product(const Matrix& a, const Matrix& b, const Matrix& c, std::size_t rows, std::size_t columns, std::size_t inner) {
    const auto layout = [](const Matrix& m) { return m.transposed ? clblast::Transpose::kYes : clblast::Transpose::kNo; };
    cl_command_queue queue = device_.queue()();
    const clblast::StatusCode status =
        clblast::Gemm<float>(clblast::Layout::kRowMajor, layout(a), layout(b), rows, columns, inner, 1.0f, a.buffer->handle()(), a.offset,
                             a.columns, b.buffer->handle()(), b.offset, b.columns, 0.0f, c.buffer->handle()(), c.offset, c.columns, &queue);
    if (status != clblast::StatusCode::kSuccess)
        throw Error(ErrorKind::device,
                    fmt::format("CLBlast's SGEMM of {} x {} x {} failed with status {}", rows, columns, inner, static_cast<int>(status)));
}

void MatrixLayers::unfold(NeuralGrid& grid, bool with_taps, const Buffer& planes, int channels, int image, const Buffer& to) {
    const int rows = channels * (with_taps ? kernel_ * kernel_ : 1);
    Kernel& kernel = with_taps ? unfold_ : unfold_one_;
    device_.launch(kernel, items(grid.shape(), rows), kernel.group(256), {8.0 * static_cast<double>(pixels_) * rows, 0}, grid.params(),
                   planes, channels, image, to);
}

void MatrixLayers::activate(NeuralGrid& grid, Kernel& kernel, std::size_t bias, int channels, int image, const Buffer& planes) {
    device_.launch(kernel, items(grid.shape(), channels), kernel.group(64), {8.0 * static_cast<double>(pixels_) * channels, 0},
                   grid.params(), dense_, *weights_, static_cast<cl_uint>(bias), channels, image, planes, grid.hidden());
}

void MatrixLayers::forward(NeuralGrid& grid, int images) {
    const std::size_t taps = static_cast<std::size_t>(kernel_) * kernel_;
    for (int n = 0; n < images; ++n) {
        unfold(grid, true, grid.input(), channels_, n, unfolded_);
        product({weights_, 0, channels_ * taps}, {&unfolded_, 0, pixels_}, {&dense_, 0, pixels_}, hidden_, pixels_, channels_ * taps);
        activate(grid, leaky_, conv1_, hidden_, n, grid.hidden());
        unfold(grid, true, grid.hidden(), hidden_, n, unfolded_);
        product({weights_, conv1_ + bias1_, hidden_ * taps}, {&unfolded_, 0, pixels_}, {&dense_, 0, pixels_}, outputs_, pixels_,
                hidden_ * taps);
        activate(grid, sigmoid_, conv1_ + bias1_ + conv2_, outputs_, n, grid.outputs());
    }
}

void MatrixLayers::hidden_gradient(NeuralGrid& grid, int images, const Buffer& output_gradient, const Buffer& hidden_gradient) {
    const std::size_t taps = static_cast<std::size_t>(kernel_) * kernel_;
    for (int n = 0; n < images; ++n) {
        unfold(grid, true, output_gradient, outputs_, n, unfolded_);
        product({&mirrored_, 0, outputs_ * taps}, {&unfolded_, 0, pixels_}, {&dense_, 0, pixels_}, hidden_, pixels_, outputs_ * taps);
        activate(grid, slope_, 0, hidden_, n, hidden_gradient);
    }
}

void MatrixLayers::weight_gradients(NeuralGrid& grid, int images, const Buffer& output_gradient, const Buffer& hidden_gradient,
                                    const Buffer& patch_gradients, std::size_t first) {
    const std::size_t taps = static_cast<std::size_t>(kernel_) * kernel_;
    const auto layer = [&](const Buffer& in, int channels, const Buffer& gradient, int out, int n, std::size_t at) {
        unfold(grid, true, in, channels, n, unfolded_);
        unfold(grid, false, gradient, out, n, dense_);
        const std::size_t row = (first + static_cast<std::size_t>(n)) * parameters_ + at, columns = channels * taps;
        product({&dense_, 0, pixels_}, {&unfolded_, 0, pixels_, true}, {&patch_gradients, row, columns}, out, columns, pixels_);
    };
    for (int n = 0; n < images; ++n) {
        layer(grid.input(), channels_, hidden_gradient, hidden_, n, 0);
        layer(grid.hidden(), hidden_, output_gradient, outputs_, n, conv1_ + bias1_);
    }
}

} // namespace clvr

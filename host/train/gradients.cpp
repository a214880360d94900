#include "host/train/gradients.hpp"
#include "host/train/tunables.hpp"

#include <algorithm>

namespace clvr {

namespace {

constexpr std::size_t lanes = 16; // partial sums of every reduction, at every width

/// Output channels that a work-item of weight_gradient takes.
int block_of(const Device& device, int channels) { return channels_at_once(channels, device.tunable(tunables::gradient_block)); }

std::size_t planes_bytes(const shared::DenoiseParams& p, std::size_t channels, int images) {
    return channels * p.plane * 4 * static_cast<std::size_t>(images);
}

/// Of an image: column sums of the errors, and their bands (train/bands.cl).
std::size_t column_bytes(const shared::DenoiseParams& p) {
    return std::size_t{12} * shared::band_blocks(p.height) * shared::band_columns(p.width);
}
std::size_t band_bytes(const shared::DenoiseParams& p) {
    return std::size_t{12} * shared::band_blocks(p.height) * shared::band_blocks(p.width);
}

} // namespace

std::size_t Gradients::bytes(const Device& device, const Model& model, const BatchShape& b) {
    const shared::DenoiseParams p = NeuralGrid::params_of(device, model, b.width, b.height);
    const std::size_t pixels = static_cast<std::size_t>(b.width) * b.height, images = static_cast<std::size_t>(b.images);
    return planes_bytes(p, 3 + static_cast<std::size_t>(model.outputs() + model.hidden), b.images) +
           images * (16 * pixels * model.levels.size() + std::size_t{16} * p.cells + model.parameters() * lanes * 4 +
                     lanes * 4 * static_cast<std::size_t>(b.height) + column_bytes(p) + band_bytes(p));
}

std::size_t Gradients::largest_bytes(const Device& device, const Model& model, const BatchShape& b) {
    const shared::DenoiseParams p = NeuralGrid::params_of(device, model, b.width, b.height);
    const std::size_t pixels = static_cast<std::size_t>(b.width) * b.height, images = static_cast<std::size_t>(b.images);
    return std::max({planes_bytes(p, std::max<std::size_t>(model.channels.size(), static_cast<std::size_t>(model.hidden)), b.images),
                     images * 16 * pixels * model.levels.size(), images * std::size_t{16} * p.cells,
                     images * model.parameters() * lanes * 4});
}

Gradients::Gradients(const Device& device, const Model& model, Loss loss, const NeuralGrid& forward, const BatchShape& shape)
    : device_(device), with_bands_(loss == Loss::shifted_gamma_bands), channels_(static_cast<int>(model.channels.size())),
      hidden_(model.hidden), outputs_(model.outputs()), levels_(static_cast<int>(model.levels.size())), kernel_(model.kernel),
      parameters_(model.parameters()), conv1_(model.conv1_weight.size()), bias1_(model.conv1_bias.size()),
      conv2_(model.conv2_weight.size()), block1_(block_of(device, hidden_)), block2_(block_of(device, outputs_)) {
    width_ = NeuralGrid::pixel_width(device_);
    const std::string width = std::to_string(width_), size = std::to_string(kernel_);
    loss_ = device_.kernel("train/loss", {{"CLVR_WIDTH", width}, {"CLVR_LOSS", std::to_string(static_cast<int>(loss))}});
    if (with_bands_) {
        column_errors_ = device_.kernel("train/column_errors", {{"CLVR_WIDTH", width}});
        bands_ = device_.kernel("train/bands");
    }
    slice_gradient_ = device_.kernel("train/slice_gradient", {{"CLVR_WIDTH", width}});
    normalise_gradient_ = device_.kernel("train/normalise_gradient");
    guide_gradient_ = device_.kernel("train/guide_gradient", {{"CLVR_WIDTH", width}});
    bias_gradient_ = device_.kernel("train/bias_gradient", {{"CLVR_WIDTH", width}});
    sum_lanes_ = device_.kernel("train/sum_lanes");
    sum_runs_ = device_.kernel("train/sum_runs");
    const auto weights = [&](int in, int out, int block) {
        return device_.kernel("train/weight_gradient", {{"CLVR_WIDTH", width},
                                                        {"CLVR_KERNEL", size},
                                                        {"CLVR_IN", std::to_string(in)},
                                                        {"CLVR_OUT", std::to_string(out)},
                                                        {"CLVR_BLOCK", std::to_string(block)}});
    };
    weight_gradient1_ = weights(channels_, hidden_, block1_);
    weight_gradient2_ = weights(hidden_, outputs_, block2_);
    to_hidden_ = Convolution(device_, "train/hidden_gradient", outputs_, hidden_, kernel_, conv1_ + bias1_, 0, true, shape.width);

    const shared::DenoiseParams& p = forward.shape();
    const auto images = static_cast<std::size_t>(shape.images);
    const auto planes = [&](int channels, const char* label) {
        Buffer b = device_.buffer(planes_bytes(p, static_cast<std::size_t>(channels), shape.images), label);
        device_.fill(b, 0);
        return b;
    };
    result_gradient_ = planes(3, "gradient of the picture");
    output_gradient_ = planes(outputs_, "gradient of the guides");
    hidden_gradient_ = planes(hidden_, "gradient of the hidden layer");
    upstream_ = device_.buffer(16 * forward.pixels() * static_cast<std::size_t>(levels_), "gradient of the levels");
    cell_gradient_ = device_.buffer(forward.cells().bytes(), "gradient of the grids");
    device_.fill(cell_gradient_, 0); // the cells are read in pairs, so the last pair reads one beyond the end
    lanes_ = device_.buffer(images * parameters_ * lanes * 4, "gradients by lane");
    device_.fill(lanes_, 0); // matrix products do not write the lanes of the weights
    loss_lanes_ = device_.buffer(images * static_cast<std::size_t>(p.height) * lanes * 4, "losses by lane");
    row_losses_ = device_.buffer(images * static_cast<std::size_t>(p.height) * 4, "losses by row");
    if (with_bands_) columns_ = device_.buffer(images * column_bytes(p), "errors by column");
    banded_ = device_.buffer(with_bands_ ? images * band_bytes(p) : 4, "bands of the errors");
    nothing_ = device_.buffer(16, "no gradient of the colours");
}

void Gradients::set_parameters(const Buffer& parameters) { to_hidden_.set_parameters(device_, parameters); }

void Gradients::backward(NeuralGrid& forward, int images, float share, const Buffer& patch_gradients, const Buffer& patch_losses,
                         std::size_t first, MatrixLayers* matrices) {
    const shared::DenoiseParams& p = forward.shape();
    const auto n = static_cast<std::size_t>(images), rows = n * static_cast<std::size_t>(p.height);
    const double pixels = static_cast<double>(p.width) * p.height * images;
    const Range all = forward.pixel_items(images);
    const Range lane_items{lanes / static_cast<std::size_t>(width_), static_cast<std::size_t>(p.height), n},
        lane_group{lanes / static_cast<std::size_t>(width_)};

    if (with_bands_) find_bands(forward, images);
    device_.launch(loss_, lane_items, lane_group, {36 * pixels, 0}, forward.params(), forward.result(), forward.target(), banded_,
                   result_gradient_, share, loss_lanes_);
    device_.launch(sum_lanes_, {rows}, sum_lanes_.group(64), {68.0 * rows, 0}, loss_lanes_, row_losses_, 0u, static_cast<cl_uint>(rows));
    device_.launch(sum_runs_, {n}, {1}, {4.0 * rows, 0}, row_losses_, patch_losses, static_cast<cl_uint>(first), static_cast<cl_uint>(n),
                   static_cast<cl_uint>(p.height), 1u, static_cast<cl_uint>(p.height));

    device_.launch(slice_gradient_, all, slice_gradient_.group(forward.pixel_group()), {pixels * (48 + 144 * levels_), 0}, forward.params(),
                   forward.outputs(), forward.cells(), forward.remodulation(), result_gradient_, upstream_, output_gradient_);
    for (int l = 0; l < levels_; ++l) forward.splat(l, images, upstream_, l * images, cell_gradient_, true);
    const auto cells = static_cast<cl_uint>(n * p.cells);
    device_.launch(normalise_gradient_, {cells}, normalise_gradient_.group(64), {48.0 * cells, 0}, forward.cells(), cell_gradient_, cells);
    device_.launch(guide_gradient_, all, guide_gradient_.group(forward.pixel_group()), {pixels * (16 + 280 * levels_), 0}, forward.params(),
                   forward.outputs(), forward.cells(), cell_gradient_, forward.splatted(), upstream_, output_gradient_, nothing_);
    if (matrices)
        matrices->hidden_gradient(forward, images, output_gradient_, hidden_gradient_);
    else
        to_hidden_.run(device_, p, images, forward.params(), output_gradient_, hidden_gradient_, forward.hidden());
    weight_gradients(forward, images, patch_gradients, first, matrices);
}

void Gradients::find_bands(const NeuralGrid& forward, int images) {
    const shared::DenoiseParams& p = forward.shape();
    const auto across = static_cast<std::size_t>(shared::band_blocks(p.width)),
               down = static_cast<std::size_t>(shared::band_blocks(p.height)), planes = std::size_t{3} * static_cast<std::size_t>(images),
               width = static_cast<std::size_t>(width_);
    const auto groups = [](std::size_t blocks) { return (blocks + CLVR_BAND_GROUP - 1) / CLVR_BAND_GROUP; };
    device_.launch(column_errors_, {(static_cast<std::size_t>(p.width) + width - 1) / width, down, planes}, {},
                   {24.0 * p.width * p.height * images, 0}, forward.params(), forward.result(), forward.target(), columns_);
    device_.launch(bands_, {groups(across), groups(down), planes}, {}, {4.0 * static_cast<double>(planes * down) * p.width, 0},
                   forward.params(), columns_, banded_);
}

void Gradients::weight_gradients(NeuralGrid& forward, int images, const Buffer& patch_gradients, std::size_t first,
                                 MatrixLayers* matrices) {
    const shared::DenoiseParams& p = forward.shape();
    const auto n = static_cast<std::size_t>(images);
    const double pixels = static_cast<double>(p.width) * p.height * images;
    const std::size_t lane_items = lanes / static_cast<std::size_t>(width_);
    const auto count = static_cast<cl_uint>(parameters_);
    const auto weights = [&](Kernel& kernel, int in, int out, int block, const Buffer& from, const Buffer& gradient, std::size_t at) {
        const std::size_t jobs = static_cast<std::size_t>(out / block * in * kernel_);
        // A job of 16 work-items fills half of a GPU's 32 lanes: four jobs share a group where the kernel allows it.
        const std::size_t wanted = width_ == 1 ? 64 : lane_items, together = std::max<std::size_t>(kernel.group(wanted).x / lane_items, 1);
        device_.launch(kernel, {lane_items, jobs, n}, {lane_items, together},
                       {4 * pixels * (in + out), 2 * pixels * in * out * kernel_ * kernel_}, forward.params(), from, gradient, lanes_,
                       count, static_cast<cl_uint>(at));
    };
    const auto biases = [&](int channels, const Buffer& gradient, std::size_t at) {
        device_.launch(bias_gradient_, {lane_items, static_cast<std::size_t>(channels), n}, {lane_items}, {4 * pixels * channels, 0},
                       forward.params(), gradient, channels, lanes_, count, static_cast<cl_uint>(at));
    };
    if (!matrices) weights(weight_gradient1_, channels_, hidden_, block1_, forward.input(), hidden_gradient_, 0);
    biases(hidden_, hidden_gradient_, conv1_);
    if (!matrices) weights(weight_gradient2_, hidden_, outputs_, block2_, forward.hidden(), output_gradient_, conv1_ + bias1_);
    biases(outputs_, output_gradient_, conv1_ + bias1_ + conv2_);
    const auto sums = static_cast<cl_uint>(n * parameters_);
    device_.launch(sum_lanes_, {sums}, sum_lanes_.group(64), {68.0 * sums, 0}, lanes_, patch_gradients,
                   static_cast<cl_uint>(first * parameters_), sums);
    if (matrices) matrices->weight_gradients(forward, images, output_gradient_, hidden_gradient_, patch_gradients, first);
}

} // namespace clvr

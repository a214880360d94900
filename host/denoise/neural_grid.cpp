#include "host/denoise/neural_grid.hpp"
#include "host/denoise/tunables.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace clvr {

namespace {

bool is_cpu(const Device& device) { return device.facts().type == DeviceType::cpu; }
int conv_width(const Device& device) { return device.tunable(tunables::conv_width); }
/// Vectors of a row that a work-item takes: with many registers 5, or 4 where that fills rows of this width better.
int conv_vectors(const Device& device, int row_width) {
    if (tunables::few_registers(conv_width(device))) return device.tunable(tunables::conv_vectors);
    const auto padded = [&](int vectors) { return (row_width - 1) / (conv_width(device) * vectors) * vectors; };
    return device.tunable(tunables::conv_vectors, padded(5) <= padded(4) ? 5 : 4);
}
/// Pixels of a row that a work-item takes.
int conv_step(const Device& device, int row_width) { return conv_width(device) * conv_vectors(device, row_width); }
Range conv_group(const Device& device, int row_width) {
    auto x = static_cast<std::size_t>(device.tunable(tunables::conv_group_x));
    while (x > 1 && conv_step(device, row_width) * static_cast<int>(x / 2) >= row_width) x /= 2; // more would only pad the row
    return {x, static_cast<std::size_t>(device.tunable(tunables::conv_group_y))};
}

Defines conv_defines(const Device& device, int in, int out, int kernel, int row_width) {
    return {{"CLVR_IN", std::to_string(in)},
            {"CLVR_OUT", std::to_string(out)},
            {"CLVR_KERNEL", std::to_string(kernel)},
            {"CLVR_WIDTH", std::to_string(conv_width(device))},
            {"CLVR_VECTORS", std::to_string(conv_vectors(device, row_width))},
            {"CLVR_BLOCK", std::to_string(channels_at_once(out, device.tunable(tunables::conv_block)))}};
}

int splat_bins(const Device& device, const shared::GridLevel& level) { return std::min(device.tunable(tunables::splat_bins), level.depth); }

Defines splat_defines(const Device& device, const shared::GridLevel& level, bool sums) {
    const int bins = splat_bins(device, level);
    return {{"CLVR_WIDTH", std::to_string(conv_width(device))},
            {"CLVR_BINS", std::to_string(bins)},
            {"CLVR_WHOLE", bins == level.depth ? "1" : "0"},
            {"CLVR_SUMS", sums ? "1" : "0"}};
}

Defines assemble_defines(const Device& device) { return {{"CLVR_WIDTH", std::to_string(conv_width(device))}}; }

Defines slice_defines(const Device& device, const Model& model, bool show) {
    return {{"CLVR_WIDTH", std::to_string(conv_width(device))},
            {"CLVR_SHOW", show ? "1" : "0"},
            {"CLVR_KNOWN", model.control_variate ? "1" : "0"}};
}

int round_up(int n, int multiple) { return (n + multiple - 1) / multiple * multiple; }

/// Rows around a band that its guides depend on: the taps of two convolutions.
int band_halo(const Model& model) { return 2 * (model.kernel / 2); }

/// Rows of each band that goes through the network: as few bands as the tunable asks for, and no larger than as many need.
int band_rows(const Device& device, const Model& model, const BatchShape& b) {
    if (!b.bands) return b.height;
    const int shared = 2 * band_halo(model), most = std::max(device.tunable(tunables::band_pixels) / b.width, 1),
              bands = std::max(1, (b.height - shared + most - 1) / most);
    return (b.height + shared * (bands - 1) + bands - 1) / bands;
}

} // namespace

int channels_at_once(int channels, int most) {
    int d = std::min(channels, most);
    while (channels % d != 0) --d;
    return d;
}

int Convolution::row_granularity(const Device& device, int row_width) {
    // Also a multiple of 16, the lanes of the weight gradients.
    return std::lcm(16, conv_step(device, row_width) * static_cast<int>(conv_group(device, row_width).x));
}

Convolution::Convolution(Device& device, const std::string& stage, int in, int out, int kernel, std::size_t first, std::size_t first_bias,
                         bool mirrored, int row_width)
    : in_(in), out_(out), size_(kernel) {
    const int block = channels_at_once(out, device.tunable(tunables::conv_block));
    step_ = conv_step(device, row_width);
    kernel_ = device.kernel(stage, conv_defines(device, in, out, kernel, row_width));
    group_ = kernel_.group(conv_group(device, row_width));
    pack_ = device.kernel("denoise/pack_weights");
    const std::size_t taps = static_cast<std::size_t>(kernel) * kernel;
    std::vector<std::int32_t> from;
    for (int b = 0; b < out; b += block)
        for (int i = 0; i < in; ++i)
            for (std::size_t tap = 0; tap < taps; ++tap)
                for (int o = b; o < b + block; ++o) {
                    const std::size_t row = mirrored ? static_cast<std::size_t>(i) * out + o : static_cast<std::size_t>(o) * in + i;
                    from.push_back(static_cast<std::int32_t>(first + row * taps + (mirrored ? taps - 1 - tap : tap)));
                }
    std::vector<std::int32_t> bias_from;
    for (int o = 0; o < out; ++o) bias_from.push_back(mirrored ? -1 : static_cast<std::int32_t>(first_bias + o));
    weights_from_ = device.upload(from, "weight order");
    bias_from_ = device.upload(bias_from, "bias order");
    weights_ = device.buffer(from.size() * 4, "weights");
    bias_ = device.buffer(bias_from.size() * 4, "biases");
}

void Convolution::set_parameters(Device& device, const Buffer& parameters) {
    for (auto [from, to] : {std::pair(&weights_from_, &weights_), {&bias_from_, &bias_}}) {
        const auto n = static_cast<cl_uint>(to->bytes() / 4);
        device.launch(pack_, {n}, pack_.group(64), {n * 12.0, 0}, parameters, *from, *to, n);
    }
}

Range Convolution::range(int width, int rows, int images) const {
    return {static_cast<std::size_t>((width + step_ - 1) / step_), static_cast<std::size_t>(rows), static_cast<std::size_t>(images)};
}

Work Convolution::work(int width, int rows, int images) const {
    const double pixels = static_cast<double>(width) * rows * images;
    return {pixels * 4 * (in_ + out_), pixels * 2 * in_ * out_ * size_ * size_};
}

shared::DenoiseParams NeuralGrid::params_of(const Device& device, const Model& model, int width, int height) {
    shared::DenoiseParams p{};
    p.width = width;
    p.height = height;
    p.pad = model.kernel / 2;
    p.row = round_up(width, Convolution::row_granularity(device, width)) + 2 * p.pad;
    p.plane = p.row * (height + 2 * p.pad);
    p.levels = static_cast<int>(model.levels.size());
    p.guide_scale = 255;
    for (std::size_t l = 0; l < model.levels.size(); ++l) {
        const auto [pixels, codes] = model.levels[l];
        shared::GridLevel& level = p.level[l];
        level.offset = p.cells;
        level.pixels = pixels;
        level.codes = codes;
        level.rows = (height + pixels - 1) / pixels;
        level.columns = (width + pixels - 1) / pixels;
        level.depth = (256 + codes - 1) / codes;
        level.inverse_codes = static_cast<float>(1.0 / codes);
        level.slope = static_cast<float>(255.0 / codes);
        level.reciprocal = static_cast<std::uint32_t>(((std::uint64_t{1} << 32) + 2 * pixels - 1) / (2 * pixels));
        level.half_pixel = static_cast<float>(0.5 / pixels);
        p.cells += static_cast<std::uint32_t>(level.rows) * level.columns * level.depth;
    }
    return p;
}

std::vector<ScratchBuffer> NeuralGrid::scratch(const Device& device, const Model& model, const BatchShape& b) {
    const shared::DenoiseParams p = params_of(device, model, b.width, b.height),
                                band = params_of(device, model, b.width, band_rows(device, model, b));
    const std::size_t images = static_cast<std::size_t>(b.images), pixels = images * static_cast<std::size_t>(b.width) * b.height;
    const auto planes_of = [&](const shared::DenoiseParams& q, int channels) {
        return images * channels * q.plane * 4 + 64; // rows are read 16 pixels at once
    };
    const auto planes = [&](int channels) { return planes_of(p, channels); };
    return {{"network input", planes_of(band, static_cast<int>(model.channels.size())), true},
            {"hidden layer", planes_of(band, model.hidden), true},
            {"guides", planes(model.outputs()), true},
            {"denoised picture", planes(3 + (b.show ? 3 * p.levels : 0)), true},
            {"target", planes(b.target ? 3 : 0), true},
            {"known light", planes(model.control_variate ? 3 : 0), true},
            {"colours to splat", pixels * 16, false},
            {"albedo", pixels * 16, false},
            {"bilateral grids", std::size_t{16} * (p.cells * images + 1), false}};
}

std::size_t NeuralGrid::bytes(const Device& device, const Model& model, const BatchShape& shape) {
    std::size_t sum = 0;
    for (const ScratchBuffer& buffer : scratch(device, model, shape)) sum += buffer.bytes;
    return sum;
}

NeuralGrid::NeuralGrid(const Device& device, const Model& model, const BatchShape& shape, NeuralGrid* former, const BatchShape& largest)
    : device_(device), levels_(static_cast<int>(model.levels.size())), channels_(static_cast<int>(model.channels.size())), batch_(shape),
      params_(params_of(device, model, shape.width, shape.height)),
      band_(params_of(device, model, shape.width, band_rows(device, model, shape))), halo_(band_halo(model)) {
    assemble_ = device_.kernel("denoise/assemble", assemble_defines(device_));
    slice_ = device_.kernel("denoise/slice", slice_defines(device_, model, shape.show));
    for (int l = 0; l < levels_; ++l) {
        bins_.push_back(splat_bins(device_, params_.level[l]));
        splat_.push_back(device_.kernel("denoise/splat", splat_defines(device_, params_.level[l], false)));
    }
    const std::size_t conv1 = model.conv1_weight.size(), bias1 = model.conv1_bias.size(), conv2 = model.conv2_weight.size();
    to_hidden_ = Convolution(device_, "denoise/hidden", channels_, model.hidden, model.kernel, 0, conv1, false, shape.width);
    to_outputs_ = Convolution(device_, "denoise/guides", model.hidden, model.outputs(), model.kernel, conv1 + bias1, conv1 + bias1 + conv2,
                              false, shape.width);

    params_buffer_ = device_.upload(std::vector<shared::DenoiseParams>{params_}, "denoiser settings");
    band_buffer_ = device_.upload(std::vector<shared::DenoiseParams>{band_}, "settings of a band");
    channel_list_ = device_.upload(ChannelPlan(model, shape.target).channels(), "channel list");
    const std::vector<ScratchBuffer> wanted = scratch(device_, model, shape), most = scratch(device_, model, largest);
    const std::vector<Buffer*> buffers = scratch_buffers(),
                               from = former ? former->scratch_buffers() : std::vector<Buffer*>(buffers.size());
    for (std::size_t k = 0; k < wanted.size(); ++k) {
        if (from[k]) *buffers[k] = std::move(*from[k]);
        if (buffers[k]->bytes() < wanted[k].bytes) {
            *buffers[k] = {}; // given back before more is asked for
            *buffers[k] = device_.buffer(std::max(wanted[k].bytes, most[k].bytes), wanted[k].label);
        }
        if (wanted[k].zeros) device_.fill(*buffers[k], 0);
    }
    // Slicing reads cells in pairs. The last pair's second cell has the weight 0, but no NaN may lie there.
    const float nothing[4] = {};
    device_.write(cells_, nothing, sizeof nothing, wanted.back().bytes - sizeof nothing);
}

std::size_t NeuralGrid::held_bytes() {
    std::size_t sum = 0;
    for (const Buffer* buffer : scratch_buffers()) sum += buffer->bytes();
    return sum;
}

std::vector<Buffer*> NeuralGrid::scratch_buffers() {
    return {&input_, &hidden_, &outputs_, &result_, &target_, &known_, &splatted_, &remodulation_, &cells_};
}

void NeuralGrid::prepare(Device& device, const Model& model, int width, int height, bool show) {
    const shared::DenoiseParams params = params_of(device, model, width, height);
    const int channels = static_cast<int>(model.channels.size());
    device.prepare("denoise/assemble", assemble_defines(device));
    device.prepare("denoise/slice", slice_defines(device, model, show));
    for (int l = 0; l < params.levels; ++l) device.prepare("denoise/splat", splat_defines(device, params.level[l], false));
    device.prepare("denoise/hidden", conv_defines(device, channels, model.hidden, model.kernel, width));
    device.prepare("denoise/pack_weights");
    device.prepare("denoise/guides", conv_defines(device, model.hidden, model.outputs(), model.kernel, width));
}

int NeuralGrid::pixel_width(const Device& device) { return conv_width(device); }

Range NeuralGrid::pixel_items(int images) const { return pixel_items(params_.height, images); }

Range NeuralGrid::pixel_items(int rows, int images) const {
    const int width = pixel_width(device_);
    return {static_cast<std::size_t>((params_.width + width - 1) / width), static_cast<std::size_t>(rows),
            static_cast<std::size_t>(images)};
}

Range NeuralGrid::pixel_group() const {
    const auto x = static_cast<std::size_t>(device_.tunable(tunables::pixel_group));
    return {x, is_cpu(device_) ? 1u : 4u};
}

void NeuralGrid::set_parameters(const Buffer& parameters) {
    to_hidden_.set_parameters(device_, parameters);
    to_outputs_.set_parameters(device_, parameters);
}

void NeuralGrid::assemble(const Buffer& source, int source_width, int source_height, const shared::SourceParams& params, int x, int y,
                          int orientation, int n, const Buffer* channels) {
    assemble_band(0, source, source_width, source_height, params, x, y, orientation, n, channels ? *channels : channel_list_);
}

void NeuralGrid::assemble_band(int shift, const Buffer& source, int source_width, int source_height, const shared::SourceParams& params,
                               int x, int y, int orientation, int n, const Buffer& channels) {
    // The part's pixel (column, row) is the result of quarter turns of (x, y) within width x height, rows upside down first for 4..7
    // (kernels/denoise/README.md, "Training"): an affine map, found from three of its pixels.
    const auto source_pixel = [&](int column, int row) {
        int rows = params_.height, columns = params_.width;
        if (orientation >= 4) row = rows - 1 - row;
        for (int turn = orientation & 3; turn > 0; --turn) {
            const int above = row;
            row = column, column = rows - 1 - above;
            std::swap(rows, columns);
        }
        return (y + row) * source_width + x + column;
    };
    const int first = source_pixel(0, shift);
    const shared::int4 from{first, source_pixel(1, shift) - first, source_pixel(0, shift + 1) - first, n};
    const auto size = static_cast<cl_uint>(source_width) * static_cast<cl_uint>(source_height);
    // Turned images are read down their columns: 16 rows at once find what they share in the first-level cache (10 % on PoCL).
    device_.launch(assemble_, pixel_items(band_.height, 1), assemble_.group(is_cpu(device_) ? Range{1, 16} : pixel_group()),
                   {static_cast<double>(band_.width) * band_.height * (8 * channels_ + 64), 0}, band_buffer_, params_buffer_, shift, params,
                   source, size, from, channels, input_, splatted_, remodulation_, target_, known_);
}

void NeuralGrid::splat(int level, int images, const Buffer& pixels, int first_image, const Buffer& cells, bool sums) {
    const shared::GridLevel& l = params_.level[level];
    const auto runs = static_cast<std::size_t>((l.depth + bins_[level] - 1) / bins_[level]);
    if (sums && sum_.empty()) // in training
        for (int k = 0; k < levels_; ++k) sum_.push_back(device_.kernel("denoise/splat", splat_defines(device_, params_.level[k], true)));
    Kernel& kernel = sums ? sum_[level] : splat_[level];
    const Range group = is_cpu(device_) ? Range{1} : kernel.group(Range{32, 4});
    const double count = static_cast<double>(params_.width) * params_.height * images;
    device_.launch(kernel, {static_cast<std::size_t>(l.columns) * runs, static_cast<std::size_t>(l.rows), static_cast<std::size_t>(images)},
                   group, {count * 20 + 16.0 * l.rows * l.columns * l.depth * images, 0}, params_buffer_, level, 2 * levels_ - 1, outputs_,
                   pixels, first_image, cells);
}

void NeuralGrid::slice(int images) {
    device_.launch(slice_, pixel_items(images), slice_.group(pixel_group()),
                   {static_cast<double>(params_.width) * params_.height * images * (48 + 128 * levels_), 0}, params_buffer_, outputs_,
                   cells_, remodulation_, known_, result_);
}

void NeuralGrid::guide_network(int images) { guide_band(0, 0, band_.height, images); }

/// The band's rows from `first` to before `end`; the picture's row `shift` is its first.
void NeuralGrid::guide_band(int shift, int first, int end, int images) {
    to_hidden_.run(device_, band_, images, band_buffer_, input_, hidden_);
    to_outputs_.run_rows(device_, band_, end - first, images, band_buffer_, hidden_, outputs_, params_buffer_, shift, first, end);
}

void NeuralGrid::picture(const Buffer& source, int source_width, int source_height, const shared::SourceParams& params, int x, int y,
                         const Buffer& channels, const std::function<void()>& between) {
    // All bands have one height, so that their borders stay zeros: the last one begins earlier than it needs to.
    for (int done = 0; done < params_.height;) {
        const int shift = std::min(std::max(0, done - halo_), params_.height - band_.height);
        const bool last = shift + band_.height == params_.height;
        const int end = last ? band_.height : band_.height - halo_;
        assemble_band(shift, source, source_width, source_height, params, x, y, 0, 0, channels);
        guide_band(shift, done - shift, end, 1);
        done = shift + end;
        between();
    }
    grids(1);
    between();
}

void NeuralGrid::forward(int images) {
    guide_network(images);
    grids(images);
}

void NeuralGrid::grids(int images) {
    for (int l = 0; l < levels_; ++l) splat(l, images, splatted_, 0, cells_, false);
    slice(images);
}

std::vector<float> NeuralGrid::download(const Buffer& planes, int channels, int image, int channel) {
    std::vector<float> plane =
        device_.download<float>(planes, params_.plane, (static_cast<std::size_t>(image) * channels + channel) * params_.plane);
    std::vector<float> bare;
    bare.reserve(static_cast<std::size_t>(params_.width) * params_.height);
    for (int y = 0; y < params_.height; ++y) {
        const auto row = plane.begin() + (y + params_.pad) * params_.row + params_.pad;
        bare.insert(bare.end(), row, row + params_.width);
    }
    return bare;
}

} // namespace clvr

#include "host/denoise/denoiser.hpp"
#include "host/denoise/neural_grid.hpp"
#include "host/denoise/tunables.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace clvr {

namespace {

constexpr const char* colours[] = {"R", "G", "B"};

/// Tiles begin at multiples of `align`, so that their grid cells are the picture's, and read `halo` pixels around what they give.
struct Tiling {
    int align = 1, halo = 0;

    explicit Tiling(const Model& model) {
        int largest = 1;
        for (const auto& level : model.levels) {
            align = std::lcm(align, level.pixels);
            largest = std::max(largest, level.pixels);
        }
        // A pixel reads cells whose centres are less than a cell away, and those the guides of as many pixels further; a guide reads the
        // taps of two convolutions.
        halo = 2 * largest + 2 * (model.kernel / 2);
    }

    /// What a tile that gives `inner` must hold of a picture.
    Region outer(const Region& inner, int width, int height) const {
        const auto low = [&](int at) { return std::max(0, at - halo) / align * align; };
        Region r{low(inner.x), low(inner.y)};
        r.width = std::min(width, inner.x + inner.width + halo) - r.x;
        r.height = std::min(height, inner.y + inner.height + halo) - r.y;
        return r;
    }
};

} // namespace

struct Denoiser::State {
    Device device;
    Model model;
    ChannelPlan plan;
    Tiling tiling;
    Buffer parameters;
    std::unique_ptr<NeuralGrid> grid; // of the last tile's size, kept for the next frame
    BatchShape shape;
    std::size_t repaired = 0;

    State(const Device& d, const Model& m) : device(d), model(m), plan(m, false), tiling(m) {}

    std::size_t tile_bytes(const Region& outer, bool show) const {
        return NeuralGrid::bytes(device, model, {outer.width, outer.height, 1, show}) + plan.planes().size() * outer.pixels() * 4;
    }

    /// Rows and columns of a tile's inner part: the whole picture where it fits in the budget, else whole rows, then parts of rows.
    Region tile(int width, int height, bool show) const {
        const std::size_t mib = 1 << 20, tunable = static_cast<std::size_t>(device.tunable(tunables::denoise_mib)) * mib;
        const std::size_t kept = grid ? tile_bytes({0, 0, shape.width, shape.height}, shape.show) : 0;
        const std::size_t budget = std::min(tunable, (device.free_bytes() + kept) / 8 * 7);
        Region t{0, 0, width, height};
        const auto fits = [&] {
            const Region outer{0, 0, std::min(width, t.width + 2 * tiling.halo + tiling.align),
                               std::min(height, t.height + 2 * tiling.halo + tiling.align)};
            return tile_bytes(outer, show) <= budget &&
                   std::size_t{16} * NeuralGrid::params_of(device, model, outer.width, outer.height).cells <= device.max_alloc_bytes() &&
                   plan.planes().size() * outer.pixels() * 4 <= device.max_alloc_bytes();
        };
        for (int parts = 2; !fits() && t.height > tiling.align; ++parts) t.height = (height + parts - 1) / parts;
        for (int parts = 2; !fits() && t.width > tiling.align; ++parts) t.width = (width + parts - 1) / parts;
        return t;
    }

    /// A NeuralGrid of the size; the last one's memory is given back first.
    NeuralGrid& grid_of(const BatchShape& wanted) {
        if (!grid || wanted.width != shape.width || wanted.height != shape.height || wanted.show != shape.show) {
            grid.reset();
            grid = std::make_unique<NeuralGrid>(device, model, wanted);
            grid->set_parameters(parameters);
            shape = wanted;
        }
        return *grid;
    }

    /// Denoises a tile: copies what lies in `inner` to the frame's channels named so, one per plane of NeuralGrid::result and then of
    /// outputs().
    void denoise_tile(const Frame& frame, const std::optional<KnownLight>& known, const Region& inner, const shared::SourceParams& params,
                      bool show, const std::vector<std::vector<float>*>& results, const std::vector<std::vector<float>*>& outputs) {
        const Region outer = tiling.outer(inner, frame.width, frame.height);
        std::vector<float> planes;
        repaired += plan.gather(frame, nullptr, outer, known, planes);
        NeuralGrid& g = grid_of({outer.width, outer.height, 1, show});
        const Buffer source = device.upload(planes, "frame channels");
        g.assemble(source, outer.width, outer.height, params, 0, 0, 0, 0);
        g.forward(1);
        const auto copy = [&](const Buffer& from, int channels, int channel, std::vector<float>& to) {
            const std::vector<float> plane = g.download(from, channels, 0, channel);
            for (int y = 0; y < inner.height; ++y) {
                const auto row = plane.begin() + static_cast<std::ptrdiff_t>(inner.y + y - outer.y) * outer.width + inner.x - outer.x;
                std::copy(row, row + inner.width, to.begin() + static_cast<std::ptrdiff_t>(inner.y + y) * frame.width + inner.x);
            }
        };
        for (std::size_t c = 0; c < results.size(); ++c)
            copy(g.result(), static_cast<int>(results.size()), static_cast<int>(c), *results[c]);
        for (std::size_t c = 0; c < outputs.size(); ++c)
            if (outputs[c]) copy(g.outputs(), static_cast<int>(outputs.size()), static_cast<int>(c), *outputs[c]);
    }
};

namespace {

/// Takes the result back towards the noisy input where that has converged (kernels/denoise/blend_by_variance.cl), in bands of rows.
void blend_by_variance(Device& device, const Frame& noisy, Frame& done) {
    constexpr int band = 256;
    Kernel sum = device.kernel("denoise/blend_sums"), blend = device.kernel("denoise/blend_by_variance");
    const auto width = static_cast<std::size_t>(noisy.width);
    for (const char* c : colours) {
        std::vector<float>& to = done.channel(c);
        const std::vector<float> from = to;
        for (int y = 0; y < noisy.height; y += band) {
            const int low = std::max(0, y - CLVR_BLEND_RADIUS), count = std::min(band, noisy.height - y),
                      rows = std::min(noisy.height, y + count + CLVR_BLEND_RADIUS) - low;
            const auto upload = [&](const auto& value_of) {
                std::vector<float> values(rows * width);
                for (std::size_t i = 0; i < values.size(); ++i) {
                    const float v = value_of(low * width + i);
                    values[i] = std::isfinite(v) ? v : 0;
                }
                return device.upload(values, "rows to blend");
            };
            const std::vector<float>& variances = noisy.at(std::string("variance.") + c);
            const Buffer before = upload(BeautyWithoutBackground(noisy, c)), variance = upload([&](std::size_t i) { return variances[i]; }),
                         after = upload([&](std::size_t i) { return from[i]; }),
                         sums = device.buffer(rows * width * 16, "sums of rows to blend"),
                         result = device.buffer(count * width * 4, "blended rows");
            device.launch(sum, {width, static_cast<std::size_t>(rows)}, sum.group(64), {}, before, variance, after, noisy.width, rows,
                          sums);
            device.launch(blend, {width, static_cast<std::size_t>(count)}, blend.group(64), {}, before, after, sums, noisy.width, rows,
                          y - low, count, result);
            const std::vector<float> blended = device.download<float>(result, count * width);
            std::copy(blended.begin(), blended.end(), to.begin() + static_cast<std::ptrdiff_t>(y) * noisy.width);
        }
    }
}

/// Gives light back to pixels whose feature rays missed what the paths met: structures thinner than a pixel, where opacity.A is nearly 0
/// and so is the result. With d the difference to the input and v the input's variance, the share 1 - 4 v / d^2 of d comes back (the
/// positive-part James-Stein form, at two standard errors): nothing at few samples, all where the input has converged. The more the feature
/// rays saw, the less comes back: nothing once one ray of four saw something. A and the colours take the same share.
void give_back_missed_light(const Frame& noisy, Frame& done) {
    const std::vector<float>*opacity = noisy.find("opacity.A"), *alpha = noisy.find("A");
    if (!opacity || !alpha) return;
    const BeautyWithoutBackground beauty[] = {{noisy, "R"}, {noisy, "G"}, {noisy, "B"}};
    const std::vector<float>* const variance[] = {noisy.find("variance.R"), noisy.find("variance.G"), noisy.find("variance.B")};
    std::vector<float>* const to[] = {&done.channel("R"), &done.channel("G"), &done.channel("B")};
    for (std::size_t i = 0; i < noisy.pixels(); ++i) {
        const double missed = 1 - 4.0 * (*opacity)[i];
        if (!(missed > 0 && (*alpha)[i] > 0)) continue;
        double apart = 0, noise = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double d = static_cast<double>(beauty[c](i)) - (*to[c])[i];
            apart += d * d, noise += (*variance[c])[i];
        }
        const double share = apart > 0 ? missed * (1 - 4 * noise / apart) : 0;
        if (!(share > 0)) continue; // includes what is not finite
        for (std::size_t c = 0; c < 3; ++c) {
            float& v = (*to[c])[i];
            v = static_cast<float>(v + share * (static_cast<double>(beauty[c](i)) - v));
        }
        float& a = done.channels.at("A")[i];
        a = static_cast<float>(a + share * (static_cast<double>((*alpha)[i]) - a));
    }
}

} // namespace

Denoiser::Denoiser(const Device& device, const Model& model) : state_(std::make_unique<State>(device, model)) {
    validate(model);
    state_->parameters = state_->device.upload(model.flat(), "model");
}
Denoiser::~Denoiser() = default;

std::size_t Denoiser::repaired() const { return state_->repaired; }

Frame Denoiser::denoise(const Frame& frame, const DenoiserView& view) {
    State& s = *state_;
    s.plan.check(frame);
    s.repaired = 0;
    Frame done = frame;
    const int levels = static_cast<int>(s.model.levels.size());
    for (const char* c : colours) done.channels[std::string("noisy.") + c] = frame.at(c);
    std::vector<std::vector<float>*> results, outputs;
    for (const char* c : colours) results.push_back(&done.channel(c));
    for (int l = 1; view.levels && l <= levels; ++l)
        for (const char* c : colours) results.push_back(&done.channel(fmt::format("level{}.{}", l, c)));
    for (int l = 1; l <= levels; ++l) outputs.push_back(view.guides ? &done.channel(fmt::format("guide.{}", l)) : nullptr);
    for (int l = 1; l < levels; ++l) outputs.push_back(view.weights ? &done.channel(fmt::format("weight.{}", l)) : nullptr);

    const shared::SourceParams params = s.plan.params(s.model.exposure ? exposure_of(frame) : 1);
    const std::optional<KnownLight> known = s.plan.known_light(frame);
    const Region tile = s.tile(frame.width, frame.height, view.levels);
    for (int y = 0; y < frame.height; y += tile.height)
        for (int x = 0; x < frame.width; x += tile.width)
            s.denoise_tile(frame, known, {x, y, std::min(tile.width, frame.width - x), std::min(tile.height, frame.height - y)}, params,
                           view.levels, results, outputs);

    if (frame.has("opacity.A") && frame.has("A")) { // the path's alpha is as noisy as its colour
        done.channels["noisy.A"] = frame.at("A");
        done.channels["A"] = frame.at("opacity.A");
    }
    for (std::vector<float>* result : results)
        for (float& v : *result) v = std::max(v / params.exposure, 0.0f);
    if (frame.has("variance.R") && frame.has("variance.G") && frame.has("variance.B")) {
        give_back_missed_light(frame, done);
        blend_by_variance(s.device, frame, done);
    }
    const std::vector<float>* const opacity = done.has("A") ? done.find("A") : frame.opacity();
    for (const char* c : colours) {
        const std::vector<float>* const background = frame.find(std::string("background.") + c);
        if (!background || !opacity) continue;
        std::vector<float>& to = done.channel(c);
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += (1 - (*opacity)[i]) * (*background)[i];
    }
    done.attributes["clvr.denoised"] = "1";
    return done;
}

} // namespace clvr

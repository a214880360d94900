#include "host/denoise/denoiser.hpp"
#include "host/denoise/neural_grid.hpp"
#include "host/denoise/picture_light.hpp"
#include "host/denoise/tunables.hpp"
#include "runtime/error.hpp"
#include "runtime/schedule/scheduler.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <iterator>
#include <numeric>

namespace clvr {

namespace {

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
    /// No tile that gives a part of this size is larger.
    Region largest_outer(const Region& inner, int width, int height) const {
        return {0, 0, std::min(width, inner.width + 2 * halo + align), std::min(height, inner.height + 2 * halo + align)};
    }
};

/// Which part of a picture a film holds, and which part of that is wanted.
struct Part {
    int width, height; // of the picture
    Region region, inner;
};

/// `r` and as many pixels around it as the picture has.
Region grown(const Region& r, int by, int width, int height) {
    const int x = std::max(0, r.x - by), y = std::max(0, r.y - by);
    return {x, y, std::min(width, r.x + r.width + by) - x, std::min(height, r.y + r.height + by) - y};
}

/// The variance of a pixel's mean to reckon with, per variance.* of a frame, which is that of independent samples. Means of clvr's (Sobol
/// points) vary less: 0.65 times that at 64, 0.5 to 0.85 times at 8; but the variance of few samples is itself noise. 1 where the samples
/// are not known (0).
float noise_per_variance(int samples) { return samples == 0 ? 1 : static_cast<float>(0.6 + 3.2 / samples); }

const std::vector<std::string> beauty_planes{"R", "G", "B", "A"}, noisy_planes{"noisy.R", "noisy.G", "noisy.B", "noisy.A"},
    variance_planes{"variance.R", "variance.G", "variance.B"};

bool has_variances(const Frame& frame) {
    return std::all_of(variance_planes.begin(), variance_planes.end(), [&](const std::string& v) { return frame.has(v); });
}

} // namespace

struct Denoiser::State {
    Device device;
    Model model;
    ChannelPlan plan;
    Tiling tiling;
    PictureLight light;
    Buffer parameters;
    std::unique_ptr<NeuralGrid> grid; // of the last tile's size, kept for the next frame
    BatchShape shape;
    Kernel finish;
    std::size_t repaired = 0;
    const std::atomic<bool>* cancelled = nullptr; // of the picture that is filtered

    State(const Device& d, const Model& m)
        : device(d), model(m), plan(m, false), tiling(m), light(d, m), finish(device.kernel("denoise/finish")) {
        parameters = device.upload(m.flat(), "model");
    }

    /// Waits, where the picture can be cancelled, for what was launched, and throws when it is.
    void stop_if_cancelled() {
        if (!cancelled) return;
        device.finish();
        if (*cancelled) throw Error(ErrorKind::interrupted, "the picture was cancelled");
    }

    /// Bytes that a tile may take beside a film of `held` bytes.
    std::size_t tile_budget(std::size_t held) const {
        const std::size_t kept = grid ? grid->held_bytes() : 0, most = static_cast<std::size_t>(device.tunable(tunables::denoise_mib))
                                                                       << 20;
        return std::min(std::max(most > held ? most - held : 0, most / 2), (device.free_bytes() + kept) / 8 * 7);
    }

    /// Bytes that the part of a picture on the device may take.
    std::size_t window_budget() const {
        const std::size_t half = static_cast<std::size_t>(device.tunable(tunables::denoise_mib)) << 19, least = std::size_t{64} << 20;
        return std::min(std::max(half, least), device.free_bytes() / 16 * 7);
    }

    std::size_t tile_bytes(const Region& outer, bool show) const { return NeuralGrid::bytes(device, model, tile_shape(outer, show)); }
    static BatchShape tile_shape(const Region& outer, bool show) { return {outer.width, outer.height, 1, show, false, true}; }

    /// Cuts the picture's rows, then its columns, into ever more parts of at least `align` pixels, until one of that size fits.
    template <class Fits>
    Region part_of(int width, int height, const Fits& fits) const {
        Region t{0, 0, width, height};
        for (int parts = 2; !fits(t) && t.height > tiling.align; ++parts) t.height = (height + parts - 1) / parts;
        for (int parts = 2; !fits(t) && t.width > tiling.align; ++parts) t.width = (width + parts - 1) / parts;
        return t;
    }

    /// Size of the parts of `wanted` that a tile gives, within `bytes`; the picture is width x height.
    Region tile(const Region& wanted, int width, int height, bool show, std::size_t bytes) const {
        return part_of(wanted.width, wanted.height, [&](const Region& t) {
            const Region outer = tiling.largest_outer(t, width, height);
            return tile_bytes(outer, show) <= bytes &&
                   std::size_t{16} * NeuralGrid::params_of(device, model, outer.width, outer.height).cells <= device.max_alloc_bytes();
        });
    }

    /// A NeuralGrid of the size, in the last one's memory or in such for `largest`.
    NeuralGrid& grid_of(const BatchShape& wanted, const BatchShape& largest) {
        if (!grid || wanted.width != shape.width || wanted.height != shape.height || wanted.show != shape.show) {
            const std::unique_ptr<NeuralGrid> former = std::move(grid);
            grid = std::make_unique<NeuralGrid>(device, model, wanted, former.get(), largest);
            grid->set_parameters(parameters);
            shape = wanted;
        }
        return *grid;
    }

    using OnTile = std::function<void(NeuralGrid& grid, const Region& inner, const Region& outer)>;

    /// Denoises the wanted part of a picture whose exposure is known: R G B A of the film, where the noisy beauty lies, become the result,
    /// the noisy ones stay in noisy.R G B A. `alpha`: whether A holds one. `on_tile` sees each tile of the network (its parts of the
    /// picture).
    void run(Film& film, const Part& part, double exposure, bool alpha, bool show, const OnTile& on_tile) {
        const std::size_t plane_bytes = film.pixels() * sizeof(float);
        const bool with_variance = film.samples != 1 && film.find("variance.R") >= 0, with_opacity = alpha && film.find("opacity.A") >= 0;
        const int noisy = film.require(noisy_planes), out = film.require(beauty_planes);
        copy(device, film.planes(), film.planes(), 4 * plane_bytes, out * plane_bytes, noisy * plane_bytes);
        // Alpha of the paths is as noisy as their colour.
        if (with_opacity)
            copy(device, film.planes(), film.planes(), plane_bytes, film.find("opacity.A") * plane_bytes, (out + 3) * plane_bytes);

        const shared::SourceParams params = plan.params(exposure, std::max(film.samples, 1), film);
        const Buffer channels = device.upload(plan.channels(film), "channel list");
        const auto size = static_cast<cl_uint>(film.pixels());
        // Blending sums over pixels beside the inner part.
        const Region wanted = with_variance ? grown(part.inner, CLVR_BLEND_RADIUS + 1, part.width, part.height) : part.inner;
        const Region tile_size = tile(wanted, part.width, part.height, show, tile_budget(film.planes().bytes())),
                     largest = tiling.largest_outer(tile_size, part.width, part.height);
        for (int y = wanted.y; y < wanted.y + wanted.height; y += tile_size.height)
            for (int x = wanted.x; x < wanted.x + wanted.width; x += tile_size.width) {
                const Region inner{x, y, std::min(tile_size.width, wanted.x + wanted.width - x),
                                   std::min(tile_size.height, wanted.y + wanted.height - y)},
                    outer = tiling.outer(inner, part.width, part.height);
                NeuralGrid& g = grid_of(tile_shape(outer, show), tile_shape(largest, show));
                g.picture(film.planes(), film.width(), film.height(), params, outer.x - part.region.x, outer.y - part.region.y, channels,
                          [&] { stop_if_cancelled(); });
                const shared::int4 from{inner.x - outer.x, inner.y - outer.y, inner.width, inner.height};
                const auto to = static_cast<cl_uint>((inner.y - part.region.y) * film.width() + inner.x - part.region.x);
                device.launch(finish, {static_cast<std::size_t>(inner.width), static_cast<std::size_t>(inner.height)}, finish.group(64), {},
                              g.params(), g.result(), 3 + (show ? 3 * static_cast<int>(model.levels.size()) : 0), from, params.exposure,
                              film.planes(), static_cast<cl_uint>(out), size, film.width(), to);
                if (on_tile) on_tile(g, inner, outer);
            }
        if (with_variance) go_back(film, out, noisy, with_opacity);
        device.finish(); // before `channels` goes
    }

    /// Takes the result back towards the noisy input where that has converged.
    void go_back(Film& film, int out, int noisy, bool with_opacity) {
        const auto size = static_cast<cl_uint>(film.pixels()), to = static_cast<cl_uint>(out), from = static_cast<cl_uint>(noisy),
                   variance = static_cast<cl_uint>(film.find("variance.R"));
        // Loaded here: a picture of one sample does without, and each takes about 50 ms the first time.
        Kernel give_back = device.kernel("denoise/give_back"), blend_bands = device.kernel("denoise/blend_bands"),
               blend_sums = device.kernel("denoise/blend_sums"), blend = device.kernel("denoise/blend_by_variance");
        if (with_opacity)
            device.launch(give_back, {film.pixels()}, give_back.group(64), {}, film.planes(), size, to, from, variance,
                          static_cast<cl_uint>(film.find("opacity.A")));
        constexpr int most_rows = 256, reach = CLVR_BLEND_RADIUS + 1;
        const std::size_t width = static_cast<std::size_t>(film.width()),
                          band_pixels = width * static_cast<std::size_t>(std::min(film.height(), most_rows + 2 * reach));
        const Buffer bands = device.buffer(band_pixels * 16, "bands to blend"),
                     weights = device.buffer(band_pixels * 4, "weights to blend"), sums = device.buffer(band_pixels * 32, "sums to blend");
        Buffer blended = device.buffer(film.pixels() * 4, "blended colour");
        const float noise = noise_per_variance(film.samples);
        for (cl_uint c = 0; c < 3; ++c) {
            for (int y = 0; y < film.height(); y += most_rows) {
                const int low = std::max(0, y - reach), count = std::min(most_rows, film.height() - y),
                          rows = std::min(film.height(), y + count + reach) - low;
                const Range all{width, static_cast<std::size_t>(rows)};
                device.launch(blend_bands, all, blend_bands.group(64), {}, film.planes(), size, from + c, variance + c, to + c, noise,
                              film.width(), low, rows, bands, weights);
                device.launch(blend_sums, all, blend_sums.group(64), {}, bands, weights, film.width(), rows, sums);
                device.launch(blend, {width, static_cast<std::size_t>(count)}, blend.group(64), {}, bands, film.planes(), size, to + c,
                              sums, film.width(), low, rows, y - low, count, blended);
            }
            copy(device, blended, film.planes(), film.pixels() * 4, 0, (to + c) * film.pixels() * 4);
            stop_if_cancelled();
        }
        device.finish(); // before the buffers go
    }

    /// Size of the parts in which a picture on the host goes through: all of it where the budget holds its planes.
    Region window_size(const Frame& frame) const {
        const std::size_t planes = names_to_upload(frame, true).size();
        const std::size_t bytes = planes * 4 + (has_variances(frame) ? 4 + 52 : 0), most = window_budget();
        return part_of(frame.width, frame.height, [&](const Region& t) {
            const int more = 2 * (tiling.halo + CLVR_BLEND_RADIUS + 1) + tiling.align;
            const std::size_t pixels =
                static_cast<std::size_t>(std::min(frame.width, t.width + more)) * std::min(frame.height, t.height + more);
            return pixels * bytes <= most && pixels * planes * 4 <= device.max_alloc_bytes();
        });
    }

    /// The planes that a film of a frame has for filtering it, or for what must be known of the whole picture before.
    std::vector<std::string> names_to_upload(const Frame& frame, bool to_filter) const {
        std::vector<std::string> names = beauty_planes;
        const auto add = [&](const std::vector<std::string>& more) {
            std::copy_if(more.begin(), more.end(), std::back_inserter(names),
                         [&](const std::string& name) { return std::find(names.begin(), names.end(), name) == names.end(); });
        };
        if (to_filter) {
            add(noisy_planes);
            if (has_variances(frame)) add(variance_planes);
            add(plan.planes());
        }
        if (plan.reads_known_light()) add(known_light_channels());
        if (frame.has("opacity.A")) add({"opacity.A"});
        return names;
    }

    /// `region` of a frame on a film. Its planes without values, which are made there, hold anything.
    Film upload(const Frame& frame, const Region& region, const std::vector<std::string>& names) {
        Film film(device, region.width, region.height, names.size());
        film.require(names);
        if (frame.attributes.count("clvr.spp")) film.samples = static_cast<int>(samples_of(frame));
        std::vector<float> plane;
        for (const std::string& name : names) {
            if (!frame.has(name) || name.rfind("noisy.", 0) == 0) continue;
            plane.clear();
            const std::size_t bad = plan.gather_plane(name, frame, region, std::nullopt, plane);
            if (std::find(plan.planes().begin(), plan.planes().end(), name) != plan.planes().end()) repaired += bad;
            film.upload(name, plane);
        }
        return film;
    }

    /// Exposure and known light of a frame that goes through in parts of `size`.
    void look_at(const Frame& frame, const Region& size) {
        const auto side = [&](int most) { return std::max(light.block(), most / light.block() * light.block()); };
        const int width = side(size.width), height = side(size.height);
        const std::vector<std::string> names = names_to_upload(frame, false);
        for (int y = 0; y < frame.height; y += height)
            for (int x = 0; x < frame.width; x += width) {
                const Region region{x, y, std::min(width, frame.width - x), std::min(height, frame.height - y)};
                Film film = upload(frame, region, names);
                light.add(film, region);
            }
        repaired = 0; // they are counted when they are filtered
    }
};

Denoiser::Denoiser(const Device& device, const Model& model) {
    validate(model);
    state_ = std::make_unique<State>(device, model);
}
Denoiser::~Denoiser() = default;

void Denoiser::prepare(int width, int height, bool variances, bool show_levels) {
    Device& device = state_->device;
    state_->light.prepare();
    NeuralGrid::prepare(device, state_->model, width, height, show_levels);
    if (!variances) return;
    for (const char* stage : {"denoise/give_back", "denoise/blend_bands", "denoise/blend_sums", "denoise/blend_by_variance"})
        device.prepare(stage);
}

std::size_t Denoiser::repaired() const { return state_->repaired; }

namespace {

/// A frame with the film's channels and attributes, without values.
Frame outline_of(const Film& film) {
    Frame frame;
    for (const std::string& name : film.names()) frame.channels[name] = {};
    if (film.samples > 0) frame.attributes["clvr.spp"] = std::to_string(film.samples);
    return frame;
}

} // namespace

void Denoiser::denoise(Film& film, const std::atomic<bool>* cancelled) {
    State& s = *state_;
    if (!film.is_on(s.device)) throw Error(ErrorKind::internal, "the picture lies on another device", "Denoiser");
    s.plan.check(outline_of(film));
    s.repaired = 0;
    const Region whole{0, 0, film.width(), film.height()};
    s.light.begin(whole.width, whole.height, true);
    s.light.add(film, whole);
    s.light.make_known(film, 0, 0);
    film.denoised = true; // also when it is cancelled: R G B A are not the samples' any more
    s.cancelled = cancelled;
    s.run(film, {whole.width, whole.height, whole, whole}, s.light.exposure(), true, false, {});
}

Frame Denoiser::denoise(const Frame& frame, const DenoiserView& view) {
    State& s = *state_;
    s.cancelled = nullptr;
    s.plan.check(frame);
    prepare(frame.width, frame.height, has_variances(frame), view.levels);
    s.repaired = 0;
    Frame done = frame;
    const int levels = static_cast<int>(s.model.levels.size());
    for (const char* c : colour_channels) done.channels[std::string("noisy.") + c] = frame.at(c);
    const bool alpha = frame.has("opacity.A") && frame.has("A");
    if (alpha) done.channels["noisy.A"] = frame.at("A");
    std::vector<std::vector<float>*> shown, outputs; // one per plane of NeuralGrid::result() after the third, of outputs()
    for (int l = 1; view.levels && l <= levels; ++l)
        for (const char* c : colour_channels) shown.push_back(&done.channel(fmt::format("level{}.{}", l, c)));
    for (int l = 1; l <= levels; ++l) outputs.push_back(view.guides ? &done.channel(fmt::format("guide.{}", l)) : nullptr);
    for (int l = 1; l < levels; ++l) outputs.push_back(view.weights ? &done.channel(fmt::format("weight.{}", l)) : nullptr);

    double exposure = 1;
    const auto on_tile = [&](NeuralGrid& g, const Region& inner, const Region& outer) {
        const auto put = [&](const Buffer& from, std::size_t channels, std::size_t channel, std::vector<float>& to, float divisor) {
            const std::vector<float> plane = g.download(from, static_cast<int>(channels), 0, static_cast<int>(channel));
            for (int y = 0; y < inner.height; ++y)
                for (int x = 0; x < inner.width; ++x)
                    to[static_cast<std::size_t>(inner.y + y) * frame.width + inner.x + x] = std::max(
                        plane[static_cast<std::size_t>(inner.y + y - outer.y) * outer.width + inner.x + x - outer.x] / divisor, 0.0f);
        };
        for (std::size_t c = 0; c < shown.size(); ++c) put(g.result(), 3 + shown.size(), 3 + c, *shown[c], static_cast<float>(exposure));
        for (std::size_t c = 0; c < outputs.size(); ++c)
            if (outputs[c]) put(g.outputs(), outputs.size(), c, *outputs[c], 1);
    };
    const Region size = s.window_size(frame);
    const std::vector<std::string> names = s.names_to_upload(frame, true);
    const bool at_once = size.pixels() == frame.pixels();
    s.light.begin(frame.width, frame.height, frame.has("A"));
    if (!at_once && s.light.is_wanted()) s.look_at(frame, size);
    for (int y = 0; y < frame.height; y += size.height)
        for (int x = 0; x < frame.width; x += size.width) {
            const Region inner{x, y, std::min(size.width, frame.width - x), std::min(size.height, frame.height - y)},
                region = s.tiling.outer(grown(inner, CLVR_BLEND_RADIUS + 1, frame.width, frame.height), frame.width, frame.height);
            if (inner.pixels() != frame.pixels()) s.grid.reset(); // it may have taken the room of this part
            Film film = s.upload(frame, region, names);
            if (at_once) s.light.add(film, region);
            exposure = s.light.exposure();
            s.light.make_known(film, region.x, region.y);
            s.run(film, {frame.width, frame.height, region, inner}, exposure, alpha, view.levels, on_tile);
            for (const std::string& name : beauty_planes) {
                if (name == "A" && !alpha) continue;
                const std::vector<float> plane = film.download(name);
                std::vector<float>& to = done.channel(name);
                for (int row = y; row < y + inner.height; ++row) {
                    const auto from = plane.begin() + static_cast<std::ptrdiff_t>(row - region.y) * region.width + x - region.x;
                    std::copy(from, from + inner.width, to.begin() + static_cast<std::ptrdiff_t>(row) * frame.width + x);
                }
            }
        }

    const std::vector<float>* const opacity = done.has("A") ? done.find("A") : frame.opacity();
    for (const char* c : colour_channels) {
        const std::vector<float>* const background = frame.find(std::string("background.") + c);
        if (!background || !opacity) continue;
        std::vector<float>& to = done.channel(c);
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += (1 - (*opacity)[i]) * (*background)[i];
    }
    done.attributes["clvr.denoised"] = "1";
    return done;
}

} // namespace clvr

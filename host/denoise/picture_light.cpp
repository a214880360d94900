#include "host/denoise/picture_light.hpp"
#include "host/denoise/neural_grid.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace clvr {

namespace {

constexpr int usual_edge = 32; // of cells whose sums one fit takes together

int blocks_of(int pixels, int edge) { return (pixels + edge - 1) / edge; }
std::size_t area(int across, int down) { return static_cast<std::size_t>(across) * static_cast<std::size_t>(down); }

shared::LightPlanes light_planes(const Film& film) {
    return {film.find("R"), film.find("light.key.R"), film.find("light.sky.R"), film.find("albedo.R"), film.find("opacity.A")};
}

} // namespace

PictureLight::PictureLight(const Device& device, const Model& model)
    : device_(device), wants_exposure_(model.exposure), wants_known_(ChannelPlan(model, false).reads_known_light()),
      varying_(model.control_variate_cell > 0), edge_(varying_ ? model.control_variate_cell : usual_edge),
      block_(std::lcm(exposure_block, edge_)), lanes_(NeuralGrid::pixel_width(device)) {}

Defines PictureLight::defines(bool of_exposure) const {
    Defines defines{{"CLVR_WIDTH", std::to_string(lanes_)}};
    if (of_exposure) defines["CLVR_BLOCK"] = std::to_string(exposure_block);
    return defines;
}

void PictureLight::prepare() {
    if (wants_exposure_) device_.prepare("denoise/exposure_columns", defines(true));
    if (wants_known_)
        for (const char* stage : {"denoise/light_columns", "denoise/known_light"}) device_.prepare(stage, defines(false));
    if (is_wanted()) device_.prepare("denoise/block_sums");
}

void PictureLight::begin(int width, int height, bool alpha) {
    width_ = width, height_ = height, alpha_ = alpha;
    blocks_.assign(area(blocks_of(width, exposure_block), blocks_of(height, exposure_block)), {});
    for (auto& cells : cells_) cells.assign(area(blocks_of(width, edge_), blocks_of(height, edge_)), {});
    shares_across_ = shares_down_ = 0;
    if (std::exchange(loaded_, true)) return;
    if (wants_exposure_) exposure_columns_ = device_.kernel("denoise/exposure_columns", defines(true));
    if (wants_known_) {
        light_columns_ = device_.kernel("denoise/light_columns", defines(false));
        known_light_ = device_.kernel("denoise/known_light", defines(false));
    }
    if (is_wanted()) block_sums_ = device_.kernel("denoise/block_sums");
}

std::vector<float> PictureLight::folded(int width, int rows, int edge) {
    const int across = blocks_of(width, edge);
    const std::size_t count = area(across, rows);
    if (sums_.bytes() < count * sizeof(float)) sums_ = device_.buffer(count * sizeof(float), "sums of blocks");
    device_.launch(block_sums_, {static_cast<std::size_t>(across), static_cast<std::size_t>(rows)}, block_sums_.group(32),
                   {4.0 * static_cast<double>(area(width, rows)), 0}, columns_, width, rows, edge, sums_);
    return device_.download<float>(sums_, count);
}

void PictureLight::add(Film& film, const Region& region) {
    const int width = film.width(), height = film.height();
    const auto columns_for = [&](int rows) {
        const std::size_t bytes = area(width, rows) * sizeof(float);
        if (columns_.bytes() < bytes) columns_ = device_.buffer(bytes, "sums of columns");
    };
    const auto vectors = static_cast<std::size_t>(blocks_of(width, lanes_));
    if (wants_exposure_) {
        const int rows = blocks_of(height, exposure_block), across = blocks_of(width, exposure_block);
        columns_for(2 * rows);
        const int opacity = film.find("opacity.A") >= 0 ? film.find("opacity.A") : alpha_ ? film.find("A") : -1;
        device_.launch(exposure_columns_, {vectors, static_cast<std::size_t>(rows)}, exposure_columns_.group(4),
                       {16.0 * static_cast<double>(film.pixels()), 0}, film.planes(), width, height, static_cast<cl_uint>(film.find("R")),
                       opacity, columns_);
        const std::vector<float> sums = folded(width, 2 * rows, exposure_block);
        const int picture_across = blocks_of(width_, exposure_block), left = region.x / exposure_block, top = region.y / exposure_block;
        for (int y = 0; y < rows; ++y)
            for (int x = 0; x < across; ++x)
                blocks_[area(top + y, picture_across) + static_cast<std::size_t>(left + x)] = {
                    sums[area(2 * y, across) + static_cast<std::size_t>(x)], sums[area(2 * y + 1, across) + static_cast<std::size_t>(x)],
                    std::min(exposure_block, width - x * exposure_block) * std::min(exposure_block, height - y * exposure_block)};
    }
    if (wants_known_) {
        const int rows = blocks_of(height, edge_), across = blocks_of(width, edge_);
        columns_for(rows * 3 * CLVR_FIT_SUMS);
        device_.launch(light_columns_, {vectors, static_cast<std::size_t>(rows), 3}, light_columns_.group(4),
                       {60.0 * static_cast<double>(film.pixels()), 0}, film.planes(), width, height, light_planes(film), edge_, columns_);
        const std::vector<float> sums = folded(width, rows * 3 * CLVR_FIT_SUMS, edge_);
        const int picture_across = blocks_of(width_, edge_), left = region.x / edge_, top = region.y / edge_;
        for (int y = 0; y < rows; ++y)
            for (int c = 0; c < 3; ++c)
                for (int k = 0; k < CLVR_FIT_SUMS; ++k)
                    for (int x = 0; x < across; ++x)
                        cells_[static_cast<std::size_t>(c)][area(top + y, picture_across) + static_cast<std::size_t>(left + x)]
                              [static_cast<std::size_t>(k)] =
                                  sums[area((y * 3 + c) * CLVR_FIT_SUMS + k, across) + static_cast<std::size_t>(x)];
    }
}

/// From the sums to shares_: [colour][down][across][3].
void PictureLight::fit() {
    const int across = blocks_of(width_, edge_);
    shares_across_ = varying_ ? across : 1, shares_down_ = varying_ ? blocks_of(height_, edge_) : 1;
    std::vector<float> all;
    for (auto& cells : cells_) {
        FittedShares fitted = fit_shares(std::move(cells), across, varying_);
        if (!varying_) fitted.cells = {fitted.whole};
        for (const LightShares& s : fitted.cells)
            for (const double share : {s.key, s.sky, s.ambient}) all.push_back(static_cast<float>(share));
    }
    const std::size_t bytes = all.size() * sizeof(float);
    if (shares_.bytes() < bytes) shares_ = device_.buffer(bytes, "shares of known light");
    device_.write(shares_, all.data(), bytes);
}

void PictureLight::make_known(Film& film, int left, int top) {
    if (!wants_known_) return;
    if (shares_across_ == 0) fit();
    const int known = film.require({"known.R", "known.G", "known.B"});
    device_.launch(known_light_, {static_cast<std::size_t>(blocks_of(film.width(), lanes_)), static_cast<std::size_t>(film.height()), 3},
                   known_light_.group(4), {20.0 * static_cast<double>(film.pixels()), 0}, film.planes(), film.width(), film.height(),
                   light_planes(film), left, top, shares_, shares_across_, shares_down_, edge_, static_cast<cl_uint>(known));
}

} // namespace clvr

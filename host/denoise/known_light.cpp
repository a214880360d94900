#include "host/denoise/known_light.hpp"
#include "host/denoise/channels.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

constexpr double least_opacity = 1.0 / 256;
constexpr double faith = 0.02; ///< weight of the prior (shares of 1, 1 and 0) relative to the pixels
constexpr double spread = 0.2; ///< expected deviation of a cell's shares from the whole frame's

/// Solves the positive definite system A x = b of three unknowns by Cholesky's decomposition; A's lower half is read.
std::array<double, 3> solve(std::array<std::array<double, 3>, 3> a, std::array<double, 3> b) {
    for (int j = 0; j < 3; ++j) {
        for (int k = 0; k < j; ++k) a[j][j] -= a[j][k] * a[j][k];
        a[j][j] = std::sqrt(a[j][j]);
        for (int i = j + 1; i < 3; ++i) {
            for (int k = 0; k < j; ++k) a[i][j] -= a[i][k] * a[j][k];
            a[i][j] /= a[j][j];
        }
    }
    for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
        b[i] /= a[i][i];
    }
    for (int i = 2; i >= 0; --i) {
        for (int k = i + 1; k < 3; ++k) b[i] -= a[k][i] * b[k];
        b[i] /= a[i][i];
    }
    return b;
}

// Places in a LightFit.
constexpr std::size_t right_side = 6, squares = 9, pixels = 10;
constexpr std::size_t of_matrix(std::size_t r, std::size_t k) { return r * (r + 1) / 2 + k; }

void add(LightFit& fit, const std::array<double, 3>& v, double value, double weight) {
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t k = 0; k <= r; ++k) fit[of_matrix(r, k)] += weight * v[r] * v[k];
        fit[right_side + r] += weight * v[r] * value;
    }
    fit[squares] += weight * value * value;
    fit[pixels] += 1;
}

/// Mean square of what the shares leave unexplained.
double left(const LightFit& fit, const LightShares& s) {
    const double x[3] = {s.key, s.sky, s.ambient};
    double sum = fit[squares];
    for (std::size_t r = 0; r < 3; ++r) {
        sum += x[r] * (x[r] * fit[of_matrix(r, r)] - 2 * fit[right_side + r]);
        for (std::size_t k = 0; k < r; ++k) sum += 2 * x[r] * x[k] * fit[of_matrix(r, k)];
    }
    return std::max(sum, 0.0) / std::max(fit[pixels], 1.0);
}

/// The shares of least squares, with `expected` as a prior of the weights `extra`.
LightShares solved(const LightFit& fit, const LightShares& expected, const std::array<double, 3>& extra) {
    std::array<std::array<double, 3>, 3> matrix{};
    std::array<double, 3> right{};
    const double x[3] = {expected.key, expected.sky, expected.ambient};
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t k = 0; k <= r; ++k) matrix[r][k] = fit[of_matrix(r, k)];
        matrix[r][r] += extra[r], right[r] = fit[right_side + r] + extra[r] * x[r];
    }
    const auto found = solve(matrix, right);
    return {std::clamp(found[0], 0.0, 4.0), std::clamp(found[1], 0.0, 4.0), std::clamp(found[2], -1.0, 1.0)};
}

/// Each cell becomes the sum of itself and half of its two neighbours `stride` apart in lines of n cells.
void tent(std::vector<LightFit>& cells, std::size_t n, std::size_t stride) {
    const std::vector<LightFit> before = cells;
    const auto add_half = [](LightFit& to, const LightFit& from) {
        for (std::size_t k = 0; k < squares; ++k) to[k] += 0.5 * from[k];
    };
    for (std::size_t c = 0; c < cells.size(); ++c) {
        const std::size_t i = c / stride % n;
        if (i > 0) add_half(cells[c], before[c - stride]);
        if (i + 1 < n) add_half(cells[c], before[c + stride]);
    }
}

} // namespace

const std::vector<std::string>& known_light_channels() {
    static const std::vector<std::string> names{"light.key.R", "light.key.G", "light.key.B", "light.sky.R", "light.sky.G",
                                                "light.sky.B", "albedo.R",    "albedo.G",    "albedo.B",    "opacity.A"};
    return names;
}

KnownLight::KnownLight(const Frame& frame, int cell) : opacity_(frame.at("opacity.A").data()), width_(frame.width), cell_(cell) {
    if (cell > 0) across_ = (frame.width + cell - 1) / cell, down_ = (frame.height + cell - 1) / cell;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string name = colour_channels[c];
        colours_[c] = {frame.at("light.key." + name).data(), frame.at("light.sky." + name).data(), frame.at("albedo." + name).data(), {}};
        colours_[c].shares = fit(colours_[c], frame, name);
    }
}

FittedShares KnownLight::fit(const Colour& colour, const Frame& frame, const std::string& name) const {
    const BeautyWithoutBackground beauty(frame, name);
    std::vector<LightFit> cells(static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_));
    for (std::size_t i = 0; i < frame.pixels(); ++i) {
        const double opacity = finite(opacity_[i]), key = finite(colour.key[i]), sky = finite(colour.sky[i]),
                     ambient = finite(colour.albedo[i]) * opacity, noisy = finite(beauty(i));
        if (!(opacity > least_opacity)) continue;
        // Noise grows with light, so relative errors count; those of very dark pixels count less.
        const double scale = key + sky + 0.05 * ambient + 1e-6, weight = opacity / (scale * scale);
        // One path that is a hundred times as bright as what is known must not decide.
        const double value = std::min(noisy, 100 * scale);
        const std::size_t edge = static_cast<std::size_t>(cell_), width = static_cast<std::size_t>(width_);
        add(cells[cell_ == 0 ? 0 : i / width / edge * static_cast<std::size_t>(across_) + i % width / edge], {key, sky, ambient}, value,
            weight);
    }
    return fit_shares(std::move(cells), across_, cell_ > 0);
}

FittedShares fit_shares(std::vector<LightFit> cells, int across, bool varying) {
    LightFit all{};
    for (const LightFit& cell : cells)
        for (std::size_t k = 0; k < all.size(); ++k) all[k] += cell[k];
    const double total = all[of_matrix(0, 0)] + all[of_matrix(1, 1)] + all[of_matrix(2, 2)];
    std::array<double, 3> extra{};
    for (std::size_t r = 0; r < 3; ++r) extra[r] = faith * all[of_matrix(r, r)] + 1e-9 * total + 1e-30;
    FittedShares shares{solved(all, {}, extra), {}};
    if (!varying) return shares;
    // A prior: a cell's shares deviate from the whole frame's by `spread`, its values by what the frame's fit left over.
    const double trust = left(all, shares.whole) / (spread * spread) / std::max(all[pixels], 1.0);
    for (std::size_t r = 0; r < 3; ++r) extra[r] = trust * all[of_matrix(r, r)] + 1e-9 * total + 1e-30;
    const std::size_t columns = static_cast<std::size_t>(across);
    tent(cells, columns, 1);
    tent(cells, cells.size() / columns, columns);
    for (const LightFit& cell : cells) shares.cells.push_back(solved(cell, shares.whole, extra));
    return shares;
}

KnownLight::Shares KnownLight::shares_at(int colour, std::size_t pixel) const {
    const FittedShares& c = colours_[static_cast<std::size_t>(colour)].shares;
    if (cell_ == 0) return c.whole;
    // The two cells whose centres lie on either side of the pixel's, along an axis.
    struct Between {
        std::size_t low, high;
        double t;
    };
    const auto between = [this](std::size_t at, int cells) {
        const double place = (static_cast<double>(at) + 0.5) / cell_ - 0.5, last = cells - 1;
        const double held = std::clamp(place, 0.0, last), low = std::floor(held);
        return Between{static_cast<std::size_t>(low), static_cast<std::size_t>(std::min(low + 1, last)), held - low};
    };
    const std::size_t width = static_cast<std::size_t>(width_), across = static_cast<std::size_t>(across_);
    const Between x = between(pixel % width, across_), y = between(pixel / width, down_);
    Shares sum{0, 0, 0};
    const auto add = [&](std::size_t column, std::size_t row, double weight) {
        const Shares& s = c.cells[row * across + column];
        sum.key += weight * s.key, sum.sky += weight * s.sky, sum.ambient += weight * s.ambient;
    };
    add(x.low, y.low, (1 - x.t) * (1 - y.t));
    add(x.high, y.low, x.t * (1 - y.t));
    add(x.low, y.high, (1 - x.t) * y.t);
    add(x.high, y.high, x.t * y.t);
    return sum;
}

float KnownLight::operator()(int colour, std::size_t pixel) const {
    const Colour& c = colours_[static_cast<std::size_t>(colour)];
    const Shares s = shares_at(colour, pixel);
    return static_cast<float>(s.key * finite(c.key[pixel]) + s.sky * finite(c.sky[pixel]) +
                              s.ambient * finite(c.albedo[pixel]) * finite(opacity_[pixel]));
}

} // namespace clvr

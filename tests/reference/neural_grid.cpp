#include "tests/reference/neural_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace clvr::reference {

namespace {

using Plane = std::vector<double>;
using Rgb = std::array<double, 3>;

/// Where a layer's tensors begin among the parameters.
struct Layer {
    int in, out;
    std::size_t weight, bias;
};

Layer layer(const Network& n, int which) {
    const std::size_t taps = static_cast<std::size_t>(n.kernel) * n.kernel, conv1 = taps * n.channels * n.hidden;
    if (which == 0) return {n.channels, n.hidden, 0, conv1};
    const std::size_t weight = conv1 + n.hidden;
    return {n.hidden, n.outputs(), weight, weight + taps * n.hidden * n.outputs()};
}

/// f(weight's number, input's number, output's number) for every product of a convolution with zeros around.
template <class F>
void products(const Network& n, const Layer& l, int height, int width, F f) {
    const int half = n.kernel / 2;
    for (int o = 0; o < l.out; ++o)
        for (int i = 0; i < l.in; ++i)
            for (int u = 0; u < n.kernel; ++u)
                for (int v = 0; v < n.kernel; ++v)
                    for (int y = std::max(0, half - u); y < std::min(height, height + half - u); ++y)
                        for (int x = std::max(0, half - v); x < std::min(width, width + half - v); ++x)
                            f(l.weight + ((static_cast<std::size_t>(o) * l.in + i) * n.kernel + u) * n.kernel + v,
                              (static_cast<std::size_t>(i) * height + y + u - half) * width + x + v - half,
                              (static_cast<std::size_t>(o) * height + y) * width + x);
}

Plane convolve(const Network& n, const Layer& l, int height, int width, const Plane& in) {
    const std::size_t pixels = static_cast<std::size_t>(height) * width;
    Plane out(pixels * l.out);
    for (int o = 0; o < l.out; ++o) std::fill_n(out.begin() + static_cast<std::ptrdiff_t>(o * pixels), pixels, n.parameters[l.bias + o]);
    products(n, l, height, width, [&](std::size_t w, std::size_t from, std::size_t to) { out[to] += n.parameters[w] * in[from]; });
    return out;
}

/// Adds the gradients of a layer's parameters, and gives that of its input.
Plane convolve_back(const Network& n, const Layer& l, int height, int width, const Plane& in, const Plane& gradient, Plane& parameters) {
    const std::size_t pixels = static_cast<std::size_t>(height) * width;
    Plane by_input(pixels * l.in);
    for (int o = 0; o < l.out; ++o)
        for (std::size_t p = 0; p < pixels; ++p) parameters[l.bias + o] += gradient[o * pixels + p];
    products(n, l, height, width, [&](std::size_t w, std::size_t from, std::size_t to) {
        parameters[w] += gradient[to] * in[from];
        by_input[from] += gradient[to] * n.parameters[w];
    });
    return by_input;
}

/// A bilateral grid of one level over an image.
class Grid {
public:
    Grid(int height, int width, std::pair<int, int> level, const double* guide)
        : width_(width), pixels_per_cell_(level.first), codes_(level.second), rows_((height + level.first - 1) / level.first),
          columns_((width + level.first - 1) / level.first), depth_((256 + level.second - 1) / level.second), guide_(guide) {}

    std::size_t cells() const { return static_cast<std::size_t>(rows_) * columns_ * depth_; }
    int lower_depth(std::size_t p) const { return static_cast<int>(std::floor(depth_at(p) - 0.5)); }
    /// dz/d(guide).
    double slope() const { return 255.0 / codes_; }

    /// f(cell, weight, d weight / dz) for the cells around pixel p.
    template <class F>
    void around(std::size_t p, F f) const {
        const double v = (static_cast<double>(p / width_) + 0.5) / pixels_per_cell_,
                     u = (static_cast<double>(p % width_) + 0.5) / pixels_per_cell_;
        const auto axis = [](double at, int count) { // (cell, weight, slope) of both
            const int lower = static_cast<int>(std::floor(at - 0.5));
            const double t = at - 0.5 - lower;
            std::array<std::tuple<int, double, double>, 2> taps{{{lower, 1 - t, -1}, {lower + 1, t, 1}}};
            for (auto& [cell, weight, slope] : taps)
                if (cell < 0 || cell >= count) cell = weight = slope = 0;
            return taps;
        };
        for (const auto& [row, wy, sy] : axis(v, rows_))
            for (const auto& [column, wx, sx] : axis(u, columns_))
                for (const auto& [bin, wz, sz] : axis(depth_at(p), depth_))
                    f((static_cast<std::size_t>(row) * columns_ + column) * depth_ + bin, wy * wx * wz, wy * wx * sz);
    }

private:
    int width_, pixels_per_cell_, codes_, rows_, columns_, depth_;
    const double* guide_;
    double depth_at(std::size_t p) const { return (255 * guide_[p] + 0.5) / codes_; }
};

struct Level {
    Plane cells; ///< [cells][3]
    Plane weight;
    std::vector<Rgb> sliced;
    Plane share; ///< S of each pixel
};

Level splat_and_slice(const Grid& grid, const GridImage& image) {
    const std::size_t pixels = static_cast<std::size_t>(image.height) * image.width;
    Level l{Plane(3 * grid.cells()), Plane(grid.cells()), std::vector<Rgb>(pixels), Plane(pixels)};
    for (std::size_t p = 0; p < pixels; ++p)
        grid.around(p, [&](std::size_t k, double w, double) {
            for (int c = 0; c < 3; ++c) l.cells[3 * k + c] += w * image.splatted[4 * p + c];
            l.weight[k] += w * image.splatted[4 * p + 3];
        });
    for (std::size_t k = 0; k < grid.cells(); ++k)
        for (int c = 0; c < 3; ++c) l.cells[3 * k + c] = l.weight[k] > 0 ? l.cells[3 * k + c] / l.weight[k] : 0;
    for (std::size_t p = 0; p < pixels; ++p) {
        grid.around(p, [&](std::size_t k, double w, double) {
            if (l.weight[k] <= 0) return;
            l.share[p] += w;
            for (int c = 0; c < 3; ++c) l.sliced[p][c] += w * l.cells[3 * k + c];
        });
        for (double& c : l.sliced[p]) c = l.share[p] > 0 ? c / l.share[p] : 0;
    }
    return l;
}

/// dL/d(guide) of a level for upstream dL/d(sliced) (kernels/denoise/README.md, "Backward").
Plane by_guide(const Grid& grid, const GridImage& image, const Level& l, const std::vector<Rgb>& upstream) {
    const std::size_t pixels = static_cast<std::size_t>(image.height) * image.width;
    Plane q(3 * grid.cells()), b(grid.cells()), gradient(pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        grid.around(p, [&](std::size_t k, double w, double) {
            if (l.weight[k] <= 0 || l.share[p] <= 0) return;
            for (int c = 0; c < 3; ++c) q[3 * k + c] += w * upstream[p][c] / l.share[p];
        });
    for (std::size_t k = 0; k < grid.cells(); ++k)
        for (int c = 0; c < 3; ++c) {
            q[3 * k + c] = l.weight[k] > 0 ? q[3 * k + c] / l.weight[k] : 0;
            b[k] += q[3 * k + c] * l.cells[3 * k + c];
        }
    for (std::size_t p = 0; p < pixels; ++p) {
        grid.around(p, [&](std::size_t k, double, double slope) {
            double toward = -b[k] * image.splatted[4 * p + 3];
            for (int c = 0; c < 3; ++c) {
                toward += q[3 * k + c] * image.splatted[4 * p + c];
                if (l.weight[k] > 0 && l.share[p] > 0) toward += upstream[p][c] / l.share[p] * (l.cells[3 * k + c] - l.sliced[p][c]);
            }
            gradient[p] += slope * toward;
        });
        gradient[p] *= grid.slope();
    }
    return gradient;
}

constexpr double gamma = 0.454545;

/// (v + 0.01)^gamma - 0.01^gamma, a straight line below 0, and its slope.
struct Shifted {
    double value, slope;
};

Shifted shifted(double v) {
    const double low = std::pow(0.01, gamma), steep = gamma * std::pow(0.01, gamma - 1);
    if (v < 0) return {steep * v, steep};
    return {std::pow(v + 0.01, gamma) - low, gamma * std::pow(v + 0.01, gamma - 1)};
}

/// Value and slope of the loss of one colour, and which smooth branch it lies on.
struct LossValue {
    double value, slope;
    int side;
};

int sign(double v) { return (v > 0) - (v < 0); }

LossValue loss_of(GridLoss loss, double out, double target) {
    if (loss == GridLoss::shifted_gamma || loss == GridLoss::shifted_gamma_l2 || loss == GridLoss::shifted_gamma_bands) {
        const double e = shifted(out).value - shifted(target).value, slope = shifted(out).slope;
        if (loss != GridLoss::shifted_gamma) return {e * e, 2 * e * slope, out >= 0};
        return {std::abs(e), sign(e) * slope, 2 * sign(e) + (out >= 0)};
    }
    if (loss == GridLoss::reference) {
        const auto tm = [](double v) { return std::clamp(std::pow(std::max(v, 0.0), gamma), 0.0, 1.0); };
        const double e = tm(out) - tm(target);
        return {std::abs(e), out > 0 && out <= 1 ? sign(e) * gamma * std::pow(out, gamma - 1) : 0, 4 * sign(e) + (out > 0) + (out > 1)};
    }
    const double e = out - target;
    if (loss == GridLoss::smape) {
        const double scale = std::abs(out) + std::abs(target) + 0.01;
        return {std::abs(e) / scale, sign(e) / scale - std::abs(e) * sign(out) / (scale * scale), 3 * sign(e) + sign(out)};
    }
    const double scale = loss == GridLoss::relative_l2 ? target * target + 0.01 : (out + 0.01) * (out + 0.01);
    return {e * e / scale, 2 * e / scale, 0};
}

/// What loss `shifted_gamma_bands` adds: 4 b^2, b the mean of a block of 8x8 errors about the mean of the 32x32 around it, as a function of
/// each pixel's colour. As the means of e cover every pixel once, d/de of the sum of 4 b^2 is 8 b.
std::vector<LossValue> band_losses(const std::vector<double>& result, const std::vector<double>& target, int width, int height) {
    std::vector<double> errors;
    std::vector<LossValue> out(result.size());
    for (std::size_t i = 0; i < result.size(); ++i) errors.push_back(shifted(result[i]).value - shifted(target[i]).value);
    const auto mean = [&](int x, int y, int edge, int c) { // of the block of this edge around the pixel
        double sum = 0;
        int count = 0;
        for (int j = y / edge * edge; j < std::min(height, y / edge * edge + edge); ++j)
            for (int i = x / edge * edge; i < std::min(width, x / edge * edge + edge); ++i, ++count) sum += errors[3 * (j * width + i) + c];
        return sum / count;
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c) {
                const int i = 3 * (y * width + x) + c;
                const double band = mean(x, y, 8, c) - mean(x, y, 32, c);
                out[i] = {4 * band * band, 8 * band * shifted(result[i]).slope, 0};
            }
    return out;
}

GridPass run(const Network& n, const GridImage& image, GridLoss kind, bool backwards) {
    const int height = image.height, width = image.width, levels = static_cast<int>(n.levels.size());
    const std::size_t pixels = static_cast<std::size_t>(height) * width;
    const Layer first = layer(n, 0), second = layer(n, 1);
    GridPass pass;

    Plane before = convolve(n, first, height, width, image.input), hidden = before;
    for (double& v : hidden) {
        pass.sides.push_back(v > 0);
        if (v <= 0) v *= 0.2;
    }
    pass.outputs = convolve(n, second, height, width, hidden);
    for (double& v : pass.outputs) v = 1 / (1 + std::exp(-v));

    std::vector<Grid> grids;
    std::vector<Level> sliced;
    for (int l = 0; l < levels; ++l) {
        grids.emplace_back(height, width, n.levels[l], &pass.outputs[l * pixels]);
        sliced.push_back(splat_and_slice(grids[l], image));
        for (std::size_t p = 0; p < pixels; ++p) pass.sides.push_back(grids[l].lower_depth(p));
    }
    const auto share = [&](int l, std::size_t p) {
        if (l < levels - 1) return pass.outputs[(levels + l) * pixels + p];
        double rest = 1;
        for (int k = 0; k < levels - 1; ++k) rest -= pass.outputs[(levels + k) * pixels + p];
        return rest;
    };
    pass.result.resize(3 * pixels);
    for (std::size_t p = 0; p < pixels; ++p)
        for (int c = 0; c < 3; ++c) {
            double blend = 0;
            for (int l = 0; l < levels; ++l) blend += share(l, p) * sliced[l].sliced[p][c];
            pass.result[3 * p + c] = blend * image.remodulation[3 * p + c] + (image.known.empty() ? 0 : image.known[3 * p + c]);
        }
    std::vector<LossValue> banded(3 * pixels, {0, 0, 0});
    if (kind == GridLoss::shifted_gamma_bands) banded = band_losses(pass.result, image.target, width, height);
    std::vector<Rgb> upstream(pixels); // dL/d(blend before remodulation)
    for (std::size_t p = 0; p < pixels; ++p)
        for (int c = 0; c < 3; ++c) {
            LossValue v = loss_of(kind, pass.result[3 * p + c], image.target[3 * p + c]);
            v.value += banded[3 * p + c].value, v.slope += banded[3 * p + c].slope;
            pass.loss += v.value / (3.0 * static_cast<double>(pixels));
            upstream[p][c] = v.slope / (3.0 * static_cast<double>(pixels)) * image.remodulation[3 * p + c];
            pass.sides.push_back(v.side);
        }
    if (!backwards) return pass;

    Plane by_output(pass.outputs.size());
    for (int l = 0; l < levels; ++l) {
        std::vector<Rgb> by_level = upstream;
        for (std::size_t p = 0; p < pixels; ++p)
            for (int c = 0; c < 3; ++c) {
                if (l < levels - 1)
                    by_output[(levels + l) * pixels + p] += upstream[p][c] * (sliced[l].sliced[p][c] - sliced.back().sliced[p][c]);
                by_level[p][c] *= share(l, p);
            }
        const Plane g = by_guide(grids[l], image, sliced[l], by_level);
        std::copy(g.begin(), g.end(), by_output.begin() + static_cast<std::ptrdiff_t>(l * pixels));
    }
    for (std::size_t i = 0; i < by_output.size(); ++i) by_output[i] *= pass.outputs[i] * (1 - pass.outputs[i]);
    pass.gradient.resize(n.parameters.size());
    Plane by_hidden = convolve_back(n, second, height, width, hidden, by_output, pass.gradient);
    for (std::size_t i = 0; i < by_hidden.size(); ++i)
        if (before[i] <= 0) by_hidden[i] *= 0.2;
    convolve_back(n, first, height, width, image.input, by_hidden, pass.gradient);
    return pass;
}

} // namespace

GridPass forward(const Network& network, const GridImage& image, GridLoss loss) { return run(network, image, loss, false); }
GridPass backward(const Network& network, const GridImage& image, GridLoss loss) { return run(network, image, loss, true); }

} // namespace clvr::reference

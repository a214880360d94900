#include "host/denoise/known_light.hpp"
#include "host/denoise/channels.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

constexpr const char* colours[] = {"R", "G", "B"};
constexpr double least_opacity = 1.0 / 256;
constexpr double faith = 0.02; ///< what shares of 1, 1 and 0 weigh beside the pixels

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

float finite(float v) { return std::isfinite(v) ? v : 0; }

} // namespace

const std::vector<std::string>& known_light_channels() {
    static const std::vector<std::string> names{"light.key.R", "light.key.G", "light.key.B", "light.sky.R", "light.sky.G",
                                                "light.sky.B", "albedo.R",    "albedo.G",    "albedo.B",    "opacity.A"};
    return names;
}

KnownLight::KnownLight(const Frame& frame) : opacity_(frame.at("opacity.A").data()) {
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string colour = colours[c];
        colours_[c] = {frame.at("light.key." + colour).data(), frame.at("light.sky." + colour).data(), frame.at("albedo." + colour).data()};
        const BeautyWithoutBackground beauty(frame, colour);
        std::array<std::array<double, 3>, 3> a{};
        std::array<double, 3> b{};
        for (std::size_t i = 0; i < frame.pixels(); ++i) {
            const double opacity = finite(opacity_[i]), key = finite(colours_[c].key[i]), sky = finite(colours_[c].sky[i]),
                         ambient = finite(colours_[c].albedo[i]) * opacity, noisy = finite(beauty(i));
            if (!(opacity > least_opacity)) continue;
            // Noise grows with light: relative errors count, of very dark pixels less.
            const double scale = key + sky + 0.05 * ambient + 1e-6, weight = opacity / (scale * scale);
            // One path that is a hundred times as bright as what is known must not decide.
            const double v[3] = {key, sky, ambient}, value = std::min(noisy, 100 * scale);
            for (int r = 0; r < 3; ++r) {
                for (int k = 0; k <= r; ++k) a[r][k] += weight * v[r] * v[k];
                b[r] += weight * v[r] * value;
            }
        }
        const double expected[3] = {1, 1, 0}, all = a[0][0] + a[1][1] + a[2][2];
        for (int r = 0; r < 3; ++r) {
            const double extra = faith * a[r][r] + 1e-9 * all + 1e-30;
            a[r][r] += extra;
            b[r] += extra * expected[r];
        }
        const std::array<double, 3> x = solve(a, b);
        shares_[c] = {std::clamp(x[0], 0.0, 4.0), std::clamp(x[1], 0.0, 4.0), std::clamp(x[2], -1.0, 1.0)};
    }
}

float KnownLight::operator()(int colour, std::size_t pixel) const {
    const Colour& c = colours_[static_cast<std::size_t>(colour)];
    const Shares& s = shares_[static_cast<std::size_t>(colour)];
    return static_cast<float>(s.key * finite(c.key[pixel]) + s.sky * finite(c.sky[pixel]) +
                              s.ambient * finite(c.albedo[pixel]) * finite(opacity_[pixel]));
}

} // namespace clvr

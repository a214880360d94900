#include "tests/reference/flip.hpp"
#include "host/volume/vec.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace clvr::reference {

namespace {

using V = std::array<double, 3>;
using Image = std::vector<V>;
const double ppd = 3840 * pi / 180;
const V white{0.95047, 1.0, 1.08883}; // of R = G = B = 1

V xyz(const V& c) {
    return {0.4124564 * c[0] + 0.3575761 * c[1] + 0.1804375 * c[2], 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2],
            0.0193339 * c[0] + 0.1191920 * c[1] + 0.9503041 * c[2]};
}
V rgb(const V& c) {
    return {3.2404542 * c[0] - 1.5371385 * c[1] - 0.4985314 * c[2], -0.9692660 * c[0] + 1.8760108 * c[1] + 0.0415560 * c[2],
            0.0556434 * c[0] - 0.2040259 * c[1] + 1.0572252 * c[2]};
}
V lab(const V& c) {
    V f = xyz(c);
    for (int k = 0; k < 3; ++k) {
        f[k] /= white[k];
        f[k] = f[k] > 0.008856 ? std::cbrt(f[k]) : 7.787 * f[k] + 16.0 / 116;
    }
    const double l = 116 * f[1] - 16;
    return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}
double hyab(const V& a, const V& b) {
    return std::abs(a[0] - b[0]) + std::sqrt((a[1] - b[1]) * (a[1] - b[1]) + (a[2] - b[2]) * (a[2] - b[2]));
}

using Kernel = std::function<double(int, int)>;

/// Sum of kernel times channel around each pixel, the border repeated; the kernel's positive and negative parts are each normalised.
std::vector<double> convolve(const std::vector<double>& p, int width, int height, int radius, const Kernel& kernel) {
    double positive = 0, negative = 0;
    for (int y = -radius; y <= radius; ++y)
        for (int x = -radius; x <= radius; ++x) (kernel(x, y) > 0 ? positive : negative) += kernel(x, y);
    std::vector<double> out(p.size());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int j = -radius; j <= radius; ++j)
                for (int i = -radius; i <= radius; ++i) {
                    const double k = kernel(i, j);
                    out[y * width + x] +=
                        p[std::clamp(y + j, 0, height - 1) * width + std::clamp(x + i, 0, width - 1)] * k / (k > 0 ? positive : -negative);
                }
    return out;
}

struct Eye {
    Image colours;
    std::vector<double> edges, points;
};

Eye eye(const Image& image, int width, int height) {
    const std::size_t n = image.size();
    std::vector<double> planes[3], grey(n);
    for (auto& p : planes) p.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const V c = xyz(image[i]);
        const double x = c[0] / white[0], y = c[1], z = c[2] / white[2];
        planes[0][i] = 116 * y - 16, planes[1][i] = 500 * (x - y), planes[2][i] = 200 * (y - z), grey[i] = y;
    }
    const double constants[3][4] = {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}};
    for (int c = 0; c < 3; ++c) {
        const double a1 = constants[c][0], b1 = constants[c][1], a2 = constants[c][2], b2 = constants[c][3];
        const auto g = [&](int x, int y) {
            const double d = (x * x + y * y) / (ppd * ppd);
            return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * d / b1) + a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * d / b2);
        };
        planes[c] = convolve(planes[c], width, height, static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd)), g);
    }
    Eye e;
    for (std::size_t i = 0; i < n; ++i) {
        const double y = (planes[0][i] + 16) / 116;
        V c = rgb({(y + planes[1][i] / 500) * white[0], y, (y - planes[2][i] / 200) * white[2]});
        for (double& v : c) v = std::clamp(v, 0.0, 1.0);
        e.colours.push_back(lab(c));
    }
    const double s = 0.5 * 0.082 * ppd;
    const int radius = static_cast<int>(std::ceil(3 * s));
    const auto g = [s](int x, int y) { return std::exp(-(x * x + y * y) / (2 * s * s)); };
    const auto magnitude = [&](const Kernel& across, const Kernel& down) {
        std::vector<double> m = convolve(grey, width, height, radius, across);
        const std::vector<double> v = convolve(grey, width, height, radius, down);
        for (std::size_t i = 0; i < n; ++i) m[i] = std::sqrt(m[i] * m[i] + v[i] * v[i]);
        return m;
    };
    e.edges = magnitude([&](int x, int y) { return -x * g(x, y); }, [&](int x, int y) { return -y * g(x, y); });
    e.points = magnitude([&](int x, int y) { return (x * x / (s * s) - 1) * g(x, y); },
                         [&](int x, int y) { return (y * y / (s * s) - 1) * g(x, y); });
    return e;
}

} // namespace

std::vector<double> flip(const Image& image, const Image& reference, int width, int height) {
    const Eye a = eye(image, width, height), b = eye(reference, width, height);
    const double greatest = std::pow(hyab(lab({0, 1, 0}), lab({0, 0, 1})), 0.7);
    std::vector<double> map(image.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
        double c = std::pow(hyab(a.colours[i], b.colours[i]), 0.7);
        c = c < 0.4 * greatest ? 0.95 * c / (0.4 * greatest) : 0.95 + 0.05 * (c - 0.4 * greatest) / (0.6 * greatest);
        const double f = std::max(std::abs(a.edges[i] - b.edges[i]), std::abs(a.points[i] - b.points[i])) / std::sqrt(2.0);
        map[i] = std::pow(c, 1 - std::sqrt(f));
    }
    return map;
}

} // namespace clvr::reference

#include "host/frame/metrics.hpp"
#include "host/frame/flip.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <tuple>

namespace clvr {

namespace {

double display(double v) { return std::pow(std::clamp(v, 0.0, 1.0), 1 / 2.2); }

void check(const Frame& image, const Frame& reference) {
    if (image.width != reference.width || image.height != reference.height)
        throw Error(ErrorKind::input, fmt::format("{} x {} pixels against {} x {}: the sizes differ", image.width, image.height,
                                                  reference.width, reference.height));
    if (image.x != reference.x || image.y != reference.y)
        throw Error(ErrorKind::input,
                    fmt::format("the pixels begin at ({}, {}) against ({}, {}) of the whole picture: cut both to the same part", image.x,
                                image.y, reference.x, reference.y));
    for (const Frame* f : {&image, &reference})
        for (const char* c : colour_channels) {
            if (!f->has(c))
                throw Error(ErrorKind::input, fmt::format("{} lacks channel {}", f == &image ? "the picture" : "the reference", c));
            for (const float v : f->at(c))
                if (!std::isfinite(v))
                    throw Error(ErrorKind::input,
                                fmt::format("{} holds values that are not finite", f == &image ? "the picture" : "the reference"));
        }
}

using Plane = std::vector<double>;

Plane displayed(const std::vector<float>& linear) {
    Plane p(linear.size());
    std::transform(linear.begin(), linear.end(), p.begin(), [](float v) { return display(v); });
    return p;
}

constexpr int window = 11;

/// The Gaussian mean of every whole window: [(height - 10) * (width - 10)].
Plane window_means(const Plane& p, int width, int height) {
    std::array<double, window> g{};
    double sum = 0;
    for (int k = 0; k < window; ++k) sum += g[k] = std::exp(-0.5 * (k - 5) * (k - 5) / (1.5 * 1.5));
    for (double& v : g) v /= sum;
    const int w = width - window + 1, h = height - window + 1;
    Plane rows(static_cast<std::size_t>(w) * height), means(static_cast<std::size_t>(w) * h);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < w; ++x)
            for (int k = 0; k < window; ++k)
                rows[static_cast<std::size_t>(y) * w + x] += g[k] * p[static_cast<std::size_t>(y) * width + x + k];
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x)
            for (int k = 0; k < window; ++k)
                means[static_cast<std::size_t>(y) * w + x] += g[k] * rows[static_cast<std::size_t>(y + k) * w + x];
    return means;
}

Plane product(const Plane& a, const Plane& b) {
    Plane p(a.size());
    std::transform(a.begin(), a.end(), b.begin(), p.begin(), [](double x, double y) { return x * y; });
    return p;
}

/// SSIM over all windows, and over those whose centre is opaque.
std::pair<double, double> ssim_of(const Frame& image, const Frame& reference) {
    constexpr double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const int width = image.width, height = image.height, w = width - window + 1, h = height - window + 1;
    if (w < 1 || h < 1) throw Error(ErrorKind::input, fmt::format("{} x {} pixels are too few; SSIM needs 11 x 11", width, height));
    const std::vector<float>* const opacity = reference.opacity();
    double all = 0, opaque = 0;
    std::size_t count = 0, opaque_count = 0;
    for (const char* c : colour_channels) {
        const Plane a = displayed(image.at(c)), b = displayed(reference.at(c));
        const Plane ma = window_means(a, width, height), mb = window_means(b, width, height),
                    aa = window_means(product(a, a), width, height), bb = window_means(product(b, b), width, height),
                    ab = window_means(product(a, b), width, height);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * w + x;
                const double va = aa[i] - ma[i] * ma[i], vb = bb[i] - mb[i] * mb[i], cov = ab[i] - ma[i] * mb[i];
                const double s = (2 * ma[i] * mb[i] + c1) * (2 * cov + c2) / ((ma[i] * ma[i] + mb[i] * mb[i] + c1) * (va + vb + c2));
                all += s, ++count;
                if (opacity && (*opacity)[static_cast<std::size_t>(y + 5) * width + x + 5] > 0.01f) opaque += s, ++opaque_count;
            }
    }
    all /= static_cast<double>(count);
    return {all, opaque_count > 0 ? opaque / static_cast<double>(opaque_count) : all};
}

} // namespace

double psnr(const Frame& image, const Frame& reference) {
    check(image, reference);
    double sum = 0;
    for (const char* c : colour_channels) {
        const std::vector<float>&a = image.at(c), &b = reference.at(c);
        for (std::size_t i = 0; i < a.size(); ++i) {
            const double d = display(a[i]) - display(b[i]);
            sum += d * d;
        }
    }
    const double mse = sum / (3.0 * static_cast<double>(image.pixels()));
    return mse > 0 ? -10 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

Metrics compare_frames(const Frame& image, const Frame& reference) {
    Metrics m;
    m.psnr = psnr(image, reference);
    std::tie(m.ssim, m.ssim_opaque) = ssim_of(image, reference);
    const double n = 3.0 * static_cast<double>(image.pixels());
    for (const char* c : colour_channels) {
        const std::vector<float>&of_image = image.at(c), &of_reference = reference.at(c);
        for (std::size_t i = 0; i < of_image.size(); ++i) {
            const double a = of_image[i], b = of_reference[i], d = a - b;
            m.rmse += d * d / n;
            m.smape += std::abs(d) / (std::abs(a) + std::abs(b) + 0.01) / n;
            m.relmse += d * d / (b * b + 0.01) / n;
        }
    }
    m.rmse = std::sqrt(m.rmse);
    const std::vector<double> flip = flip_map(image, reference);
    m.flip = std::accumulate(flip.begin(), flip.end(), 0.0) / static_cast<double>(flip.size());
    return m;
}

std::array<std::pair<const char*, double>, 7> named(const Metrics& m) {
    return {{{"psnr", m.psnr},
             {"ssim", m.ssim},
             {"ssim_opaque", m.ssim_opaque},
             {"rmse", m.rmse},
             {"smape", m.smape},
             {"relmse", m.relmse},
             {"flip", m.flip}}};
}

} // namespace clvr

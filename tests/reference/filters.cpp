#include "tests/reference/filters.hpp"

#include <algorithm>
#include <cmath>

namespace clvr::reference {

namespace {

double luminance(const FilterPixel& p) { return 0.2126 * p.colour[0] + 0.7152 * p.colour[1] + 0.0722 * p.colour[2]; }

double similarity(const FilterPixel& a, const FilterPixel& b, double sigma) {
    double distance = 0;
    for (int k = 0; k < 7; ++k) distance += (a.features[k] - b.features[k]) * (a.features[k] - b.features[k]);
    return std::exp(-distance / (2 * sigma * sigma));
}

/// f(pixel at an offset, dx, dy) for all offsets of a window that lie in the picture.
template <class F>
void window(const FilterImage& image, int x, int y, int radius, int step, F f) {
    for (int j = -radius; j <= radius; ++j)
        for (int i = -radius; i <= radius; ++i) {
            const int px = x + i * step, py = y + j * step;
            if (px >= 0 && py >= 0 && px < image.width && py < image.height) f(image.pixels[py * image.width + px], i, j);
        }
}

} // namespace

FilterImage cross_bilateral(const FilterImage& image, double spatial_sigma, double feature_sigma, int radius) {
    FilterImage out = image;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            FilterPixel& to = out.pixels[y * image.width + x];
            const FilterPixel& here = image.pixels[y * image.width + x];
            double weights = 0;
            to.colour = {};
            window(image, x, y, radius, 1, [&](const FilterPixel& q, int i, int j) {
                const double w =
                    q.opacity * similarity(here, q, feature_sigma) * std::exp(-(i * i + j * j) / (2 * spatial_sigma * spatial_sigma));
                weights += w;
                for (int c = 0; c < 3; ++c) to.colour[c] += w * q.colour[c];
            });
            for (double& c : to.colour) c = weights > 0 ? c / weights : 0;
        }
    return out;
}

FilterImage wavelet(const FilterImage& image, double colour_sigma, double feature_sigma, int levels, bool estimate) {
    FilterImage now = image;
    for (int y = 0; estimate && y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            double weights = 0, first = 0, second = 0;
            window(image, x, y, 3, 1, [&](const FilterPixel& q, int, int) {
                const double w = q.opacity * similarity(image.pixels[y * image.width + x], q, feature_sigma), l = luminance(q);
                weights += w, first += w * l, second += w * l * l;
            });
            now.pixels[y * image.width + x].variance = weights > 0 ? std::max(0.0, second / weights - std::pow(first / weights, 2)) : 0;
        }
    constexpr double spline[] = {3.0 / 8, 1.0 / 4, 1.0 / 16};
    for (int level = 0; level < levels; ++level) {
        FilterImage next = now;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                const FilterPixel& here = now.pixels[y * image.width + x];
                FilterPixel& to = next.pixels[y * image.width + x];
                double smooth = 0, share = 0;
                window(now, x, y, 1, 1, [&](const FilterPixel& q, int i, int j) {
                    const double w = q.opacity * (2 - std::abs(i)) * (2 - std::abs(j));
                    smooth += w * q.variance, share += w;
                });
                const double deviation = share > 0 ? std::sqrt(smooth / share) : 0;
                double weights = 0, variance = 0;
                to.colour = {};
                window(now, x, y, 2, 1 << level, [&](const FilterPixel& q, int i, int j) {
                    const double apart = std::abs(luminance(q) - luminance(here)) / (colour_sigma * (deviation + 1e-4));
                    const double w =
                        q.opacity * spline[std::abs(i)] * spline[std::abs(j)] * similarity(here, q, feature_sigma) * std::exp(-apart);
                    weights += w, variance += w * w * q.variance;
                    for (int c = 0; c < 3; ++c) to.colour[c] += w * q.colour[c];
                });
                for (double& c : to.colour) c = weights > 0 ? c / weights : 0;
                to.variance = weights > 0 ? variance / weights / weights : 0;
            }
        now = next;
    }
    return now;
}

} // namespace clvr::reference

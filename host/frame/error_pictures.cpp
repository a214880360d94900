#include "host/frame/error_pictures.hpp"
#include "host/frame/flip.hpp"
#include "host/frame/srgb.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

/// sRGB stations of matplotlib's "magma" (S. van der Walt, N. Smith; CC0), linear between them.
constexpr double stations[][3] = {{0, 0, 4},      {28, 16, 68},   {79, 18, 123},   {129, 37, 129}, {181, 54, 122},
                                  {229, 80, 100}, {251, 135, 97}, {254, 194, 135}, {252, 253, 191}};
constexpr int intervals = 8;

/// Component c of the colour of v, 0..1, as linear light.
double magma(double v, int c) {
    const double at = std::clamp(v, 0.0, 1.0) * intervals;
    const int k = std::min(static_cast<int>(at), intervals - 1);
    return srgb_decode((stations[k][c] + (at - k) * (stations[k + 1][c] - stations[k][c])) / 255);
}

} // namespace

Frame flip_picture(const Frame& image, const Frame& reference) {
    const std::vector<double> map = flip_map(image, reference);
    Frame picture = image.blank();
    for (int c = 0; c < 3; ++c) {
        std::vector<float>& plane = picture.channel(colour_channels[c]);
        for (std::size_t i = 0; i < map.size(); ++i) plane[i] = static_cast<float>(magma(map[i], c));
    }
    return picture;
}

Frame difference_picture(const Frame& image, const Frame& reference) {
    const auto display = [](double v) { return std::pow(std::clamp(v, 0.0, 1.0), 1 / 2.2); };
    Frame picture = image.blank();
    for (const char* c : colour_channels) {
        std::vector<float>& plane = picture.channel(c);
        const std::vector<float>&a = image.at(c), &b = reference.at(c);
        for (std::size_t i = 0; i < plane.size(); ++i)
            plane[i] = static_cast<float>(std::pow(std::abs(display(a[i]) - display(b[i])), 2.2));
    }
    return picture;
}

} // namespace clvr

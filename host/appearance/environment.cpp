#include "host/appearance/environment.hpp"
#include "host/volume/vec.hpp"

#include <algorithm>

namespace clvr {

double cos_half_turns(double x) {
    const bool flip = x > 0.5;
    if (flip) x = 1 - x;
    const double t = 3.14159265358979323846 * x, z = t * t; // t <= pi/2: 13 Taylor terms reach double precision
    double sum = 0;
    for (int k = 12; k > 0; --k) sum = (1 + sum) * -z / ((2.0 * k) * (2.0 * k - 1));
    return flip ? -(1 + sum) : 1 + sum;
}

EnvironmentTables environment_tables(int width, int height, const std::vector<float>& rgb, double level) {
    EnvironmentTables e;
    e.width = width, e.height = height;
    e.texel.resize(static_cast<std::size_t>(width) * height);
    e.row_cdf.assign(height + 1, 0);
    e.column_cdf.assign(static_cast<std::size_t>(height) * (width + 1), 0);
    e.row_cos.resize(height + 1);
    for (int r = 0; r <= height; ++r) e.row_cos[r] = static_cast<float>(cos_half_turns(static_cast<double>(r) / height));

    const auto luminance = [&](std::size_t t) { return level * (0.2126 * rgb[3 * t] + 0.7152 * rgb[3 * t + 1] + 0.0722 * rgb[3 * t + 2]); };
    const auto solid_angle = [&](int r) { // of one texel of the row [sr]
        return 2 * pi / width * (static_cast<double>(e.row_cos[r]) - e.row_cos[r + 1]);
    };
    std::vector<double> row(height, 0);
    double all = 0;
    for (int r = 0; r < height; ++r) {
        for (int c = 0; c < width; ++c) row[r] += luminance(static_cast<std::size_t>(r) * width + c);
        all += row[r] * solid_angle(r);
    }
    e.mean_luminance = all / (4 * pi);
    const bool black = !(all > 0);
    const double whole = black ? 4 * pi / (2 * pi / width) : all;

    double above = 0;
    for (int r = 0; r < height; ++r) {
        const double row_share =
            black ? (static_cast<double>(e.row_cos[r]) - e.row_cos[r + 1]) * width / whole : row[r] * solid_angle(r) / whole;
        above += row_share;
        e.row_cdf[r + 1] = r + 1 == height ? 1.0f : static_cast<float>(std::min(above, 1.0));
        float* cdf = &e.column_cdf[static_cast<std::size_t>(r) * (width + 1)];
        double left = 0;
        for (int c = 0; c < width; ++c) {
            left += black || !(row[r] > 0) ? 1.0 / width : luminance(static_cast<std::size_t>(r) * width + c) / row[r];
            cdf[c + 1] = c + 1 == width ? 1.0f : static_cast<float>(std::min(left, 1.0));
        }
        for (int c = 0; c < width; ++c) {
            const std::size_t t = static_cast<std::size_t>(r) * width + c;
            const double chance = (static_cast<double>(e.row_cdf[r + 1]) - e.row_cdf[r]) * (static_cast<double>(cdf[c + 1]) - cdf[c]);
            e.texel[t] = {static_cast<float>(level * rgb[3 * t]), static_cast<float>(level * rgb[3 * t + 1]),
                          static_cast<float>(level * rgb[3 * t + 2]), static_cast<float>(chance / solid_angle(r))};
        }
    }
    return e;
}

} // namespace clvr

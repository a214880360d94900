#include "host/appearance/sky_split.hpp"
#include "host/volume/vec.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clvr {

namespace {

constexpr int most_suns = 4;
constexpr double sun_cosine = 0.99756405, least_share = 0.05, least_contrast = 20; // 4 degrees

shared::float4 float4_of(const Double3& v) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]), 0}; }

/// Cosine and sine of an angle in turns.
std::array<double, 2> circle(double turns) {
    const auto cosine = [](double t) {
        t = std::abs(t - std::floor(t + 0.5)); // 0 .. 1/2
        return cos_half_turns(2 * t);
    };
    return {cosine(turns), cosine(turns - 0.25)};
}

/// Points of the spherical Fibonacci lattice (Keinert et al.: "Spherical Fibonacci mapping", 2015).
std::vector<Double3> even_directions() {
    constexpr double golden = 0.61803398874989484820;
    std::vector<Double3> directions;
    for (int k = 0; k < CLVR_SKY_DIRECTIONS; ++k) {
        const double z = 1 - (2 * k + 1.0) / CLVR_SKY_DIRECTIONS, r = std::sqrt(1 - z * z);
        const auto [cosine, sine] = circle(k * golden);
        directions.push_back({r * cosine, r * sine, z});
    }
    return directions;
}

/// The image's texels that are not yet spoken for.
class Texels {
public:
    Texels(const shared::RenderParams& p, const EnvironmentTables& e) : environment_(e), taken_(e.texel.size(), false) {
        for (int c = 0; c < e.width; ++c) { // kernels/lib/light.clh environment_sample: from +y towards +x, then the image's rotation
            const auto [cosine, sine] = circle((c + 0.5) / e.width - 0.5);
            across_.push_back({p.sky.z * sine - p.sky.w * cosine, p.sky.z * cosine + p.sky.w * sine, 0});
        }
    }
    Double3 direction(std::size_t t) const {
        const std::size_t row = t / environment_.width;
        const double z = (static_cast<double>(environment_.row_cos[row]) + environment_.row_cos[row + 1]) / 2;
        Double3 d = across_[t % environment_.width] * std::sqrt(1 - z * z);
        d[2] = z;
        return d;
    }
    /// Linear RGB times solid angle.
    Double3 power(std::size_t t) const {
        const std::size_t row = t / environment_.width;
        const double solid_angle =
            2 * pi / environment_.width * (static_cast<double>(environment_.row_cos[row]) - environment_.row_cos[row + 1]);
        const shared::float4& l = environment_.texel[t];
        return Double3{l.x, l.y, l.z} * solid_angle;
    }
    double luminance(std::size_t t) const {
        const shared::float4& l = environment_.texel[t];
        return 0.2126 * l.x + 0.7152 * l.y + 0.0722 * l.z;
    }
    std::size_t brightest() const {
        std::size_t best = 0;
        double most = -1;
        for (std::size_t t = 0; t < taken_.size(); ++t)
            if (!taken_[t] && luminance(t) > most) most = luminance(t), best = t;
        return best;
    }
    template <class F>
    void each_left(F&& visit) const {
        for (std::size_t t = 0; t < taken_.size(); ++t)
            if (!taken_[t]) visit(t);
    }
    void take(const std::vector<std::size_t>& texels) {
        for (const std::size_t t : texels) taken_[t] = true;
    }

private:
    const EnvironmentTables& environment_;
    std::vector<Double3> across_; // by column
    std::vector<bool> taken_;
};

/// Takes the next sun out of the image; false where there is none.
bool take_sun(Texels& texels, double mean_luminance, std::vector<shared::KeyLight>& suns) {
    const std::size_t peak = texels.brightest();
    if (!(texels.luminance(peak) >= least_contrast * mean_luminance)) return false;
    const Double3 centre = texels.direction(peak);
    Double3 power{}, towards{};
    double luminous = 0;
    std::vector<std::size_t> spot;
    texels.each_left([&](std::size_t t) {
        const Double3 d = texels.direction(t);
        if (inner(d, centre) < sun_cosine || texels.luminance(t) < 4 * mean_luminance) return;
        const Double3 p = texels.power(t);
        const double l = 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
        power = power + p, towards = towards + d * l, luminous += l;
        spot.push_back(t);
    });
    if (!(luminous >= least_share * 4 * pi * mean_luminance)) return false;
    texels.take(spot);
    shared::KeyLight sun{};
    sun.direction = float4_of(unit(towards));
    sun.irradiance = float4_of(power);
    suns.push_back(sun);
    return true;
}

} // namespace

SkySplit split_sky(const shared::RenderParams& params, const EnvironmentTables& environment) {
    SkySplit s;
    const std::vector<Double3> directions = even_directions();
    std::vector<Double3> radiance(directions.size());
    if (params.environment_width == 0) {
        for (std::size_t k = 0; k < directions.size(); ++k) {
            const double l = (params.sky.x + params.sky.y * directions[k][2]) * 4 * pi / CLVR_SKY_DIRECTIONS;
            radiance[k] = {l, l, l};
        }
    } else {
        Texels texels(params, environment);
        for (int k = 0; k < most_suns && take_sun(texels, environment.mean_luminance, s.suns); ++k) {
        }
        texels.each_left([&](std::size_t t) {
            const Double3 d = texels.direction(t);
            std::size_t nearest = 0;
            double most = -2;
            for (std::size_t k = 0; k < directions.size(); ++k) {
                const double cosine = inner(d, directions[k]);
                if (cosine > most) most = cosine, nearest = k;
            }
            radiance[nearest] = radiance[nearest] + texels.power(t);
        });
    }
    for (const Double3& d : directions) s.directions.push_back(float4_of(d));
    for (const Double3& l : radiance) s.radiance.push_back(float4_of(l));
    return s;
}

} // namespace clvr

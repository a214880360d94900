#include "host/volume/value_statistics.hpp"
#include "host/volume/stored_counts.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <type_traits>

namespace clvr {

namespace {

constexpr std::size_t float_bins = 65536;

/// Equal bins from low to high, all empty.
ValueCounts empty_counts(double low, double high, std::size_t bins) {
    ValueCounts counts;
    counts.low = low;
    counts.width = bins > 1 ? (high - low) / static_cast<double>(bins - 1) : 1;
    counts.all.resize(bins);
    counts.border.resize(bins);
    return counts;
}

/// The bin of a value; those beyond the ends are in the end bins.
class BinOf {
public:
    BinOf(double low, double high, std::size_t bins)
        : low_(low), last_(static_cast<double>(bins - 1)), scale_(bins > 1 ? last_ / (high - low) : 0) {}
    std::size_t operator()(double value) const { return static_cast<std::size_t>(std::clamp((value - low_) * scale_ + 0.5, 0.0, last_)); }

private:
    double low_, last_, scale_;
};

/// A bin a value.
ValueCounts count_integers(const StoredCounts& stored, double least, double low, double high) {
    ValueCounts counts = empty_counts(low, high, static_cast<std::size_t>(high - low) + 1);
    const BinOf bin(low, high, counts.bins());
    for (std::size_t i = 0; i < stored.all.size(); ++i) {
        if (stored.all[i] == 0) continue;
        const std::size_t to = bin(least + static_cast<double>(i));
        counts.all[to] += stored.all[i];
        counts.border[to] += stored.border[i];
    }
    return counts;
}

ValueCounts count_floats(const Voxels& v, double low, double high) {
    ValueCounts counts = empty_counts(low, high, high > low ? float_bins : 1);
    const BinOf bin(low, high, counts.bins());
    std::mutex merging;
    for_parts(static_cast<std::size_t>(v.dims[2]), [&](std::size_t, std::size_t first, std::size_t last) {
        std::vector<std::uint64_t> all(counts.bins()), border(counts.bins());
        for_each_run<float>(v, first, last, [&](const float* values, std::size_t n, bool is_border) {
            auto& to = is_border ? border : all;
            for (std::size_t i = 0; i < n; ++i) ++to[bin(double{values[i]})];
        });
        const std::lock_guard lock(merging);
        for (std::size_t b = 0; b < counts.bins(); ++b) {
            counts.all[b] += all[b] + border[b];
            counts.border[b] += border[b];
        }
    });
    return counts;
}

std::uint64_t total(const std::vector<std::uint64_t>& counts) { return std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}); }
std::size_t mode(const std::vector<std::uint64_t>& counts) {
    return static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

/// First bin at which the running sum reaches the share q of the whole, without bin `except`.
std::size_t quantile(const std::vector<std::uint64_t>& counts, double q, std::size_t except) {
    const double wanted = q * static_cast<double>(total(counts) - counts[except]);
    double sum = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (i != except) sum += static_cast<double>(counts[i]);
        if (sum > wanted || (sum == wanted && sum > 0)) return i;
    }
    return counts.size() - 1;
}

/// Robust ends of the values: all but one in a thousand of the voxels beside the most frequent value, and that value.
std::pair<std::size_t, std::size_t> robust_ends(const std::vector<std::uint64_t>& counts) {
    const std::size_t most = mode(counts);
    if (total(counts) == counts[most]) return {most, most};
    return {std::min(most, quantile(counts, 0.001, most)), std::max(most, quantile(counts, 0.999, most))};
}

constexpr int coarse = 64;
using Coarse = std::array<double, coarse>;

/// N. Otsu, "A Threshold Selection Method from Gray-Level Histograms", 1979: first bin of the upper class.
int otsu(const Coarse& h) {
    double n = 0, sum = 0;
    for (int b = 0; b < coarse; ++b) n += h[b], sum += b * h[b];
    double below = 0, below_sum = 0, best = -1;
    int first = 1;
    for (int b = 0; b + 1 < coarse; ++b) {
        below += h[b], below_sum += b * h[b];
        if (below == 0 || below == n) continue;
        const double difference = below_sum / below - (sum - below_sum) / (n - below);
        const double between = below * (n - below) * difference * difference;
        if (between > best) best = between, first = b + 1;
    }
    return first;
}

/// The first peak at or after `from` that stands 1.5 times above the valley before it, and that valley; {from, from} when the counts only
/// fall. Counts are smoothed (binomial, 5 taps); the last bins are left out, since saturated values gather there.
std::pair<int, int> first_peak(const Coarse& h, int from) {
    const auto smooth = [&](int b) {
        const auto tap = [&](int i) { return h[static_cast<std::size_t>(std::clamp(i, from, coarse - 1))]; };
        return (tap(b - 2) + 4 * tap(b - 1) + 6 * tap(b) + 4 * tap(b + 1) + tap(b + 2)) / 16;
    };
    int valley = from, peak = from, valley_of_peak = from;
    for (int b = from; b < coarse - 3; ++b) {
        if (smooth(b) < smooth(valley)) valley = b;
        if (peak == from ? smooth(b) > 1.5 * smooth(valley) : smooth(b) > smooth(peak)) peak = b, valley_of_peak = valley;
        if (peak != from && smooth(b) * 1.3 < smooth(peak)) break; // over the top
    }
    return {valley_of_peak, peak};
}

} // namespace

ValueCounts value_counts(const Voxels& v, const Histogram& h) {
    return with_voxel_type(v.type, [&](auto t) {
        using T = decltype(t);
        if constexpr (std::is_integral_v<T>) {
            const bool counted = !h.stored.all.empty();
            return count_integers(counted ? h.stored : stored_counts(v), double{std::numeric_limits<T>::min()}, h.low, h.high);
        } else {
            ValueCounts counts = count_floats(v, h.low, h.high);
            for (int zoom = 0; zoom < 8; ++zoom) {
                // Outliers: beyond the robust ends the range is mostly empty. One bin that holds nearly everything hides structure, too.
                const auto [first, last] = robust_ends(counts.all);
                const std::size_t most = mode(counts.all);
                const bool one_bin = counts.all[most] * 1e4 > (1e4 - 1) * static_cast<double>(v.count());
                const std::size_t from = one_bin ? most : first, to = one_bin ? most : last;
                if ((to - from + 1) * 4 > counts.bins()) break;
                const double finer_low = std::max(h.low, counts.value(double(from) - 0.5)),
                             finer_high = std::min(h.high, counts.value(double(to) + 0.5));
                if (!(finer_high - finer_low > 1e-6 * std::max(std::fabs(finer_low), std::fabs(finer_high))))
                    break; // float itself has no finer values
                counts = count_floats(v, finer_low, finer_high);
            }
            return counts;
        }
    });
}

namespace {

ValueSide side(const ValueCounts& counts, std::size_t background, std::size_t end, int sign) {
    ValueSide s;
    s.sign = sign;
    s.top = counts.value(double(end));
    const double length = std::fabs(double(end) - double(background));
    if (length == 0) return s;

    Coarse all{}, border{};
    for (std::size_t i = background; i != end + sign; i += sign) {
        const int b = std::min(static_cast<int>(std::fabs(double(i) - double(background)) / (length + 1) * coarse), coarse - 1);
        all[b] += static_cast<double>(counts.all[i]);
        border[b] += static_cast<double>(counts.border[i]);
    }
    // Background is spread evenly over the volume or gathers at its border; structure stays away from the border.
    const double border_share = static_cast<double>(total(counts.border)) / static_cast<double>(total(counts.all));
    const int limit = otsu(all);
    int threshold = 1;
    for (int b = 1; b < limit; ++b)
        if (border[b] > 0.9 * border_share * all[b]) threshold = b + 1;
    const double step = length / coarse;
    const auto at = [&](double bin) { return counts.value(double(background) + sign * bin * step); };

    int occupied = threshold;
    while (occupied < coarse - 1 && all[occupied] == 0) ++occupied;
    const int gap = occupied - threshold;
    const auto [valley, peak] = first_peak(all, occupied);
    double structure = 0, beyond_valley = 0;
    for (int b = threshold; b < coarse; ++b) structure += all[b], beyond_valley += b >= valley ? all[b] : 0;
    const bool mode_apart = peak > occupied + 2 && beyond_valley > 0.5 * structure;
    s.active = structure > 0;
    s.surfaces = gap >= 4 || mode_apart;
    s.cut = gap >= 4 && !mode_apart;
    const double first = gap >= 4 ? threshold + 0.5 * gap : mode_apart ? 0.5 * (threshold + valley) : threshold;
    s.threshold = at(first);
    s.solid = at(std::max(first + 2, first + 0.4 * ((mode_apart ? peak : occupied) - first)));
    s.common = at((mode_apart ? peak : occupied) + 0.5);
    Coarse beyond{};
    std::copy(all.begin() + threshold, all.end(), beyond.begin() + threshold);
    const int dense = otsu(beyond);
    s.dense = at(std::max(dense, peak + 1));
    s.dense_share = std::accumulate(all.begin() + dense, all.end(), 0.0) / std::max(structure, 1.0);

    s.rank.assign(65, 0);
    std::vector<double> fine(65, 0);
    for (int k = 0; k < 64; ++k) {
        const double from = first + (coarse - first) * k / 64.0, to = first + (coarse - first) * (k + 1) / 64.0;
        for (int b = static_cast<int>(from); b < coarse && b < to; ++b)
            fine[k + 1] += all[b] * (std::min(to, b + 1.0) - std::max(from, double(b)));
        s.rank[k + 1] = s.rank[k] + fine[k + 1];
    }
    if (s.rank[64] > 0)
        for (double& r : s.rank) r /= s.rank[64];
    return s;
}

} // namespace

ValueShape value_shape(const ValueCounts& counts) {
    ValueShape shape;
    const auto [first, last] = robust_ends(counts.all);
    shape.low = counts.value(double(first));
    shape.high = counts.value(double(last));
    std::size_t background = std::clamp(mode(counts.border), first, last);

    // A border without a prevailing value shows structure that was cut off: then the low end is taken as the background.
    const std::size_t reach = std::max<std::size_t>((last - first) / 20, 1);
    double near = 0;
    for (std::size_t i = background - std::min(background, reach); i <= background + reach && i < counts.bins(); ++i)
        near += static_cast<double>(counts.border[i]);
    if (near < 0.25 * static_cast<double>(total(counts.border))) background = first;

    shape.background = counts.value(double(background));
    shape.above = side(counts, background, last, 1);
    shape.below = side(counts, background, first, -1);
    // A side with a small range is only the noise around the background.
    const double range = shape.high - shape.low;
    shape.above.active = shape.above.active && shape.high - shape.background >= 0.2 * range;
    shape.below.active = shape.below.active && shape.background - shape.low >= 0.2 * range;
    return shape;
}

double dense_outside(const Voxels& v, const ValueSide& side) {
    return with_voxel_type(v.type, [&](auto t) {
        using T = decltype(t);
        constexpr int reach = 3, rays = 128;
        const T* values = v.data<T>();
        const std::ptrdiff_t n[3] = {v.dims[0], v.dims[1], v.dims[2]}, stride[3] = {1, n[0], n[0] * n[1]};
        const auto beyond = [&](T value, double limit) { return side.sign > 0 ? value > limit : value < limit; };
        std::size_t met = 0, dense = 0;
        const auto walk = [&](std::ptrdiff_t start, std::ptrdiff_t step, std::ptrdiff_t length) {
            std::ptrdiff_t i = 0;
            while (i < length && !beyond(values[start + i * step], side.solid)) ++i;
            if (i == length) return;
            ++met;
            bool found = false;
            for (std::ptrdiff_t k = i; k < std::min(i + reach + 1, length); ++k)
                found = found || beyond(values[start + k * step], side.dense);
            dense += found;
        };
        for (int axis = 0; axis < 3; ++axis) {
            const int u = (axis + 1) % 3, w = (axis + 2) % 3;
            for (std::ptrdiff_t a = 0; a < n[u]; a += (n[u] + rays - 1) / rays)
                for (std::ptrdiff_t b = 0; b < n[w]; b += (n[w] + rays - 1) / rays) {
                    const std::ptrdiff_t start = a * stride[u] + b * stride[w];
                    walk(start, stride[axis], n[axis]);
                    walk(start + (n[axis] - 1) * stride[axis], -stride[axis], n[axis]);
                }
        }
        return met ? static_cast<double>(dense) / static_cast<double>(met) : 0.0;
    });
}

} // namespace clvr

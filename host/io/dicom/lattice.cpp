#include "host/io/dicom/lattice.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace clvr {

namespace {

/// A slice is where it should be when it is within this share of the slice distance.
constexpr double tolerance = 0.1;

/// The distance of neighbours: the mean of the largest group of distances that are alike (others are gaps or slices out of step).
double usual_step(const std::vector<double>& along, double rounding) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < along.size(); ++k) steps.push_back(along[k] - along[k - 1]);
    std::sort(steps.begin(), steps.end());
    auto first = steps.begin(), last = first;
    for (auto begin = steps.begin(); begin != steps.end(); ++begin) {
        const double alike = *begin * (1 + tolerance) + std::min(rounding, 0.5 * *begin);
        if (const auto end = std::upper_bound(begin, steps.end(), alike); end - begin > last - first) first = begin, last = end;
    }
    return std::accumulate(first, last, 0.0) / static_cast<double>(last - first);
}

/// How far each place lies above the best line through all places as a function of their index.
std::vector<double> residuals(const std::vector<double>& along, const std::vector<std::size_t>& index) {
    const auto n = static_cast<double>(along.size());
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < along.size(); ++k) mean_x += static_cast<double>(index[k]) / n, mean_y += along[k] / n;
    for (std::size_t k = 0; k < along.size(); ++k) {
        const double x = static_cast<double>(index[k]) - mean_x;
        xx += x * x;
        xy += x * (along[k] - mean_y);
    }
    const double slope = xx > 0 ? xy / xx : 0;
    std::vector<double> off;
    for (std::size_t k = 0; k < along.size(); ++k) off.push_back(along[k] - mean_y - slope * (static_cast<double>(index[k]) - mean_x));
    return off;
}

/// The regular place of each given place; each gap is counted by itself.
std::vector<std::size_t> count_steps(const std::vector<double>& along, double usual) {
    constexpr double most_steps = 1e9;
    std::vector<std::size_t> index{0};
    for (std::size_t k = 1; k < along.size(); ++k)
        index.push_back(index.back() + static_cast<std::size_t>(std::lround(std::min((along[k] - along[k - 1]) / usual, most_steps))));
    return index;
}

/// Whether rounding alone explains that single distances look like gaps, as when 1.25 mm is written without decimals: 0, 1, 3, 4, 5.
bool rounding_explains(const std::vector<double>& along, const std::vector<std::size_t>& counted, double rounding) {
    constexpr std::size_t least_places = 8, least_gaps = 2;
    std::vector<std::size_t> plain(along.size());
    std::iota(plain.begin(), plain.end(), std::size_t{0});
    if (counted == plain || along.size() < least_places || counted.back() == plain.back() + least_gaps - 1) return false;
    const std::vector<double> off = residuals(along, plain);
    const auto [lowest, highest] = std::minmax_element(off.begin(), off.end());
    return *highest - *lowest <= 1.2 * rounding; // half of it to each side, and a little for the line
}

} // namespace

SliceLattice lattice_of(const std::vector<double>& along, double rounding) {
    SliceLattice l;
    l.index = count_steps(along, usual_step(along, rounding));
    const bool explained = rounding_explains(along, l.index, rounding);
    if (explained) std::iota(l.index.begin(), l.index.end(), std::size_t{0});
    const double span = along.back() - along.front();
    l.count = l.index.back() + 1;
    l.step = span / static_cast<double>(l.index.back());
    // Rounding moves a place by half of it, and the ends of the line a little.
    const double allowed = explained ? rounding : std::max(tolerance * l.step, std::min(0.75 * rounding, 0.3 * l.step));
    const std::vector<double> fitted = residuals(along, l.index);
    for (std::size_t k = 0; k < along.size(); ++k) {
        const double plain = std::abs(along[k] - along.front() - l.step * static_cast<double>(l.index[k]));
        l.in_step.push_back(std::min(plain, std::abs(fitted[k])) <= allowed);
    }
    return l;
}

} // namespace clvr

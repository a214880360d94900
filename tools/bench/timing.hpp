// Timing for the benchmarks: warmed up, the two sides in turn (a shared machine changes speed by the minute), medians.
#pragma once
#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

namespace clvr::bench {

inline double seconds_of(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Median seconds of each side over `repeats` rounds, after one that does not count.
inline std::vector<double> in_turn(const std::vector<std::function<void()>>& sides, int repeats) {
    std::vector<std::vector<double>> times(sides.size());
    for (int k = 0; k <= repeats; ++k)
        for (std::size_t s = 0; s < sides.size(); ++s) {
            const double t = seconds_of(sides[s]);
            if (k > 0) times[s].push_back(t);
        }
    std::vector<double> medians;
    for (auto& t : times) {
        std::sort(t.begin(), t.end());
        medians.push_back(t[t.size() / 2]);
    }
    return medians;
}

} // namespace clvr::bench

// Comparing samples with what they should be.
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace clvr::testing {

/// Mean of values and its standard error.
struct Estimate {
    double mean = 0, sigma = 0;
};

inline Estimate estimate(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (double x : values) sum += x;
    for (double x : values) squares += (x - sum / n) * (x - sum / n);
    return {sum / n, std::sqrt(squares / n / (n - 1))};
}

/// Pearson's chi-square of counts against expected ones; bins of fewer than 10 expected go together. Passes below its mean plus 4 sigma.
inline void expect_counts(const std::vector<double>& counts, const std::vector<double>& expected, const std::string& what) {
    double chi2 = 0, few = 0, few_expected = 0;
    int bins = 0;
    const auto add = [&](double c, double e) { chi2 += (c - e) * (c - e) / e, ++bins; };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] >= 10)
            add(counts[i], expected[i]);
        else
            few += counts[i], few_expected += expected[i];
    }
    if (few_expected >= 10)
        add(few, few_expected);
    else
        EXPECT_LE(few, few_expected + 4 * std::sqrt(few_expected) + 4) << what << ": counts where none are expected";
    ASSERT_GE(bins, 2) << what;
    EXPECT_LE(chi2, bins - 1 + 4 * std::sqrt(2.0 * (bins - 1))) << what << ": chi-square over " << bins << " bins";
}

/// Uniform numbers in [0, 1) as the device makes them: 23 bits.
inline float uniform_float(std::mt19937& random) { return static_cast<float>(random() >> 9) * 0x1p-23f; }

} // namespace clvr::testing

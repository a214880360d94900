#include "tools/bench/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace clvr::bench {

double steady_seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

double median(std::vector<double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double spread(std::vector<double> values) {
    if (values.size() < 3) return 0;
    std::sort(values.begin(), values.end());
    const auto quartile = [&](double share) {
        const double at = share * static_cast<double>(values.size() - 1);
        const auto low = static_cast<std::size_t>(at);
        const double high = values[std::min(low + 1, values.size() - 1)];
        return values[low] + (at - static_cast<double>(low)) * (high - values[low]);
    };
    const double middle = median(values);
    return middle > 0 ? (quartile(0.75) - quartile(0.25)) / 2 / middle : 0;
}

Pace::Pace(Clock clock, std::function<void()> loop, double best) : clock_(std::move(clock)), loop_(std::move(loop)), best_(best) {
    if (loop_) loop_(); // warm
    for (int k = 0; k < 5 && loop_; ++k) now();
}

double Pace::now() {
    if (!loop_) return 0;
    const double begin = clock_();
    loop_();
    const double seconds = clock_() - begin;
    if (seconds > 0 && (best_ <= 0 || seconds < best_)) best_ = seconds;
    return seconds;
}

namespace {

struct Batch {
    double work, beside, pace;
};

/// Seconds of one run within a batch that is no jump of the clock: NaN where it ran backwards, stood still or leapt.
double believable(double seconds, double expected) {
    constexpr double leap = 1000;
    return seconds * leap > expected && seconds < leap * std::max(expected, 1e-6) ? seconds : std::numeric_limits<double>::quiet_NaN();
}

} // namespace

Timing measure(const Clock& clock, Pace& pace, const std::function<void()>& work, const Plan& plan, const std::function<void()>& beside) {
    const auto seconds_of = [&](const std::function<void()>& f, int repetitions) {
        const double begin = clock();
        for (int k = 0; k < repetitions; ++k) f();
        return (clock() - begin) / repetitions;
    };
    std::vector<double> probes;
    for (int k = 0; k < 3; ++k) probes.push_back(seconds_of(work, 1));
    if (beside) beside();
    const double probe = std::max(median(probes), 1e-9);
    const int repetitions = static_cast<int>(std::clamp(plan.batch_seconds / probe, 1.0, 10000.0));

    std::vector<Batch> good, slow;
    Timing timing;
    double spent = 0;
    const auto wanted = static_cast<std::size_t>(plan.batches);
    for (int tries = 0; good.size() < wanted && tries < 3 * plan.batches; ++tries) {
        if (spent > plan.limit_seconds && good.size() + slow.size() >= 3) break;
        const double before = pace.now();
        const double t = believable(seconds_of(work, repetitions), probe);
        const double other = beside ? seconds_of(beside, 1) : 0;
        const double after = pace.now();
        if (std::isnan(t) || other < 0 || before < 0 || after < 0) {
            ++timing.repeated;
            continue;
        }
        spent += t * repetitions + other;
        const double slower = std::max(before, after), faster = std::min(before, after);
        const bool disturbed = pace.slow_phase(slower) || slower > Pace::slow * faster;
        (disturbed ? slow : good).push_back({t, other, (before + after) / 2});
        timing.repeated += disturbed;
    }
    if (good.size() < std::min<std::size_t>(3, wanted)) {
        if (!slow.empty()) timing.note = "the machine ran slow while this was measured";
        good.insert(good.end(), slow.begin(), slow.end());
    }
    if (good.empty()) {
        timing.note = "the clock jumped in every batch";
        return timing;
    }
    std::vector<double> works, besides, ratios, paces;
    for (const Batch& b : good)
        works.push_back(b.work), besides.push_back(b.beside), ratios.push_back(b.beside / b.work), paces.push_back(b.pace);
    timing.median_s = median(works);
    timing.spread = spread(works);
    timing.beside_s = median(besides);
    timing.ratio = median(ratios);
    timing.pace_s = median(paces);
    timing.batches = static_cast<int>(good.size());
    return timing;
}

Comparison compare(const Clock& clock, const std::function<void()>& base, const std::function<void()>& candidate, int rounds,
                   double limit_seconds, double hopeless) {
    const auto seconds_of = [&](const std::function<void()>& f) {
        const double begin = clock();
        f();
        return clock() - begin;
    };
    Comparison result;
    std::vector<double> ratios;
    double spent = 0;
    for (int k = 0; k < rounds && (k < 2 || spent < limit_seconds); ++k) {
        const bool base_first = k % 2 == 0;
        double ours = 0, theirs = 0;
        if (base_first) theirs = seconds_of(base);
        ours = seconds_of(candidate);
        if (!base_first) theirs = seconds_of(base);
        if (ours > 0 && theirs > 0) ratios.push_back(theirs / ours), spent += ours + theirs;
        if (k == 1 && ratios.size() == 2 && std::max(ratios[0], ratios[1]) * hopeless < 1) {
            result.pruned = true;
            break;
        }
    }
    result.rounds = static_cast<int>(ratios.size());
    if (ratios.empty()) return result;
    result.speedup = median(ratios);
    result.spread = spread(ratios);
    return result;
}

} // namespace clvr::bench

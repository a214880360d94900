// The tuning of a device: every tunable, by measurement, with pruning, within a time.
#pragma once
#include "runtime/drivers/facts.hpp"
#include "runtime/tune/tuning.hpp"
#include "tools/bench/jobs.hpp"
#include "tools/bench/statistics.hpp"

#include <functional>
#include <string>
#include <vector>

namespace clvr::bench {

/// A tunable of clvr on a device: where it counts and what may be tried.
struct Knob {
    std::string name;
    std::vector<std::string> stages;             ///< that it may speed up; their geometric mean decides
    std::vector<int> values;                     ///< in order; a walk goes to neighbours and stops where it gets slower
    std::function<int(const Tunables&)> current; ///< its value, set or by default, where these are set
};

/// All tunables that a tuning tries on this device, those that promise most first; `quick`: those alone that promise much.
std::vector<Knob> knobs_for(const DeviceFacts& device, bool quick);

/// Holds a candidate against a base on some stages.
using Evaluate = std::function<Verdict(const Tunables& base, const Tunables& candidate, const std::vector<std::string>& stages)>;

struct TunedDevice {
    Tuning tuning; ///< the values to keep and a line for each candidate tried
    int tried = 0, refused = 0;
    std::vector<std::string> left_out; ///< knobs for which no time was left
};

/// Walks each knob from its value in `start` to its neighbours while they are faster by more than noise; then holds all winners together
/// against `start` once more per stage, and drops those of a stage that lost. A candidate that is wrong, crashes or hangs is refused and
/// ends the walk that way. No new candidate begins after `limit_seconds`.
TunedDevice tune(const std::vector<Knob>& knobs, const Tunables& start, const Evaluate& evaluate, const Clock& clock, double limit_seconds);

} // namespace clvr::bench

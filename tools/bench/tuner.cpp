#include "tools/bench/tuner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace clvr::bench {
namespace {

constexpr double worthwhile = 1.02; // faster than this, and by more than the spread, or it is noise
constexpr double a_gain = 1.01;     // in the end something of a tunable's stages must be faster by so much
constexpr double no_loss = 0.99;    // in the end nothing may be slower than this

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

/// The line of evidence of a candidate.
std::string line_of(const std::string& name, int value, const Knob& knob, const Verdict& v, int base) {
    if (v.status != Status::ok) return fmt::format("{} {}: {}: {}", name, value, status_name(v.status), v.reason);
    return fmt::format("{} {}: {:.3f} x as fast as {} in {} (+-{:.1f} %){}", name, value, v.speedup, base, joined(knob.stages),
                       100 * v.spread, v.pruned ? ", given up early" : "");
}

class Walk {
public:
    Walk(const Evaluate& evaluate, const Clock& clock, double limit, TunedDevice& result)
        : evaluate_(evaluate), clock_(clock), deadline_(clock() + limit), result_(result) {}

    bool out_of_time() const { return clock_() >= deadline_; }

    /// Moves best[knob] to the fastest value reached.
    void along(const Knob& knob, Tunables& best) {
        const int start = knob.current(best);
        const auto above = std::upper_bound(knob.values.begin(), knob.values.end(), start);
        const auto below = std::lower_bound(knob.values.begin(), knob.values.end(), start);
        const bool better = one_way(knob, std::vector<int>(std::make_reverse_iterator(below), knob.values.rend()), start, best);
        if (!better) one_way(knob, std::vector<int>(above, knob.values.end()), start, best);
    }

private:
    const Evaluate& evaluate_;
    const Clock& clock_;
    double deadline_;
    TunedDevice& result_;

    bool one_way(const Knob& knob, const std::vector<int>& values, int start, Tunables& best) {
        bool better = false;
        int base = start, idle = 0; // values in a row that were no better
        for (const int value : values) {
            if (out_of_time()) {
                if (result_.left_out.empty() || result_.left_out.back() != knob.name) result_.left_out.push_back(knob.name);
                break;
            }
            Tunables candidate = best;
            candidate[knob.name] = value;
            const Verdict v = evaluate_(best, candidate, knob.stages);
            ++result_.tried;
            result_.refused += v.status != Status::ok;
            result_.tuning.evidence.push_back(line_of(knob.name, value, knob, v, base));
            if (v.status != Status::ok) break;
            if (v.speedup < worthwhile + v.spread) {
                if (v.speedup < 1 / worthwhile || ++idle == 2) break; // it gets slower that way, or stays as it is
                continue;
            }
            best = candidate;
            base = value;
            idle = 0;
            better = true;
        }
        return better;
    }
};

} // namespace

std::vector<Knob> knobs_for(const DeviceFacts& device, bool quick) {
    std::vector<Knob> knobs;
    for (const Tunable* t : declared_tunables()) {
        const FewNumbers& tried = t->tried(device);
        if (tried.empty() || (quick && !t->quick)) continue;
        knobs.push_back({t->name, {t->stages.begin(), t->stages.end()}, {tried.begin(), tried.end()}, [t, device](const Tunables& set) {
                             return value_of(*t, device, set);
                         }});
    }
    return knobs;
}

TunedDevice tune(const std::vector<Knob>& knobs, const Tunables& start, const Evaluate& evaluate, const Clock& clock,
                 double limit_seconds) {
    TunedDevice result;
    Walk walk(evaluate, clock, limit_seconds, result);
    Tunables best = start;
    for (const Knob& knob : knobs) walk.along(knob, best);

    // What came of it stage by stage, each change of one at a time having been held against noise only.
    std::set<std::string> stages;
    const auto changed = [&](const Knob& knob) {
        const auto before = start.find(knob.name);
        const auto now = best.find(knob.name);
        return now != best.end() && (before == start.end() || before->second != now->second);
    };
    for (const Knob& knob : knobs)
        if (changed(knob)) stages.insert(knob.stages.begin(), knob.stages.end());
    std::map<std::string, double> gained;
    const auto put_back = [&](const Knob& knob, const std::string& why) {
        result.tuning.evidence.push_back(fmt::format("{} goes back: {}", knob.name, why));
        best.erase(knob.name);
        const auto before = start.find(knob.name);
        if (before != start.end()) best.insert(*before);
    };
    for (const std::string& stage : stages) {
        if (best == start) break;
        const Verdict v = evaluate(start, best, {stage});
        result.tuning.evidence.push_back(
            v.status == Status::ok
                ? fmt::format("in the end: {:.3f} x as fast as before in {} (+-{:.1f} %)", v.speedup, stage, 100 * v.spread)
                : fmt::format("in the end: {} in {}: {}", status_name(v.status), stage, v.reason));
        gained[stage] = v.speedup;
        if (v.status == Status::ok && v.speedup >= no_loss) continue;
        for (const Knob& knob : knobs)
            if (changed(knob) && std::find(knob.stages.begin(), knob.stages.end(), stage) != knob.stages.end())
                put_back(knob, stage + " lost");
    }
    for (const Knob& knob : knobs)
        if (changed(knob) &&
            std::none_of(knob.stages.begin(), knob.stages.end(), [&](const std::string& stage) { return gained[stage] >= a_gain; }))
            put_back(knob, "nothing was gained");
    result.tuning.values = best;
    return result;
}

} // namespace clvr::bench

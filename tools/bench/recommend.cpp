#include "tools/bench/recommend.hpp"

#include "tools/bench/stage.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clvr::bench {
namespace {

constexpr double worth_a_second_device = 1.1;

std::string called(const DeviceRows& d) { return fmt::format("device {} \"{}\"", d.facts.index, d.facts.name); }

const Row* row_of(const DeviceRows& d, const std::string& stage) {
    const auto found = std::find_if(d.rows.begin(), d.rows.end(), [&](const Row& r) { return r.stage == stage; });
    return found == d.rows.end() ? nullptr : &*found;
}

/// Why the device is not taken for a task; empty when it may be.
std::string why_not(const DeviceRows& d, const std::string& stage) {
    if (const std::string why = why_unusable(d.facts); !why.empty()) return why;
    if (d.facts.simulator) return "it is a simulator";
    for (const Row& row : d.rows)
        if (row.status == Status::wrong_result) return fmt::format("wrong result in \"{}\"", row.stage);
    const Row* row = row_of(d, stage);
    if (!row) return fmt::format("\"{}\" was not measured", stage);
    if (row->status != Status::ok) return fmt::format("\"{}\": {}: {}", stage, status_name(row->status), row->reason);
    return {};
}

/// Positions of the able, fastest first.
std::vector<std::size_t> ranked(const std::vector<DeviceRows>& devices, const std::string& stage) {
    std::vector<std::size_t> able;
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (why_not(devices[i], stage).empty()) able.push_back(i);
    std::stable_sort(able.begin(), able.end(),
                     [&](std::size_t a, std::size_t b) { return row_of(devices[a], stage)->rate > row_of(devices[b], stage)->rate; });
    return able;
}

} // namespace

const std::vector<std::string>& task_names() {
    static const std::vector<std::string> names{"render", "denoise", "train"};
    return names;
}

std::string stage_of_task(const std::string& task) {
    const auto found = std::find_if(stages().begin(), stages().end(), [&](const Stage& s) { return s.task == task; });
    return found == stages().end() ? "" : found->name;
}

std::vector<std::size_t> worth_joining(const std::vector<DeviceRows>& devices) {
    const std::string stage = stage_of_task("render");
    std::vector<std::size_t> best = ranked(devices, stage);
    if (best.size() < 2) return {};
    best.resize(2);
    const double first = row_of(devices[best[0]], stage)->rate, second = row_of(devices[best[1]], stage)->rate;
    return second >= (worth_a_second_device - 1) * first ? best : std::vector<std::size_t>();
}

Recommendation recommend(const std::string& task, const std::vector<DeviceRows>& devices, const std::vector<Joined>& joined) {
    const std::string stage = stage_of_task(task);
    Recommendation r{task, {}, {}, {}};
    for (const DeviceRows& d : devices) {
        const std::string why = why_not(d, stage);
        const Row* row = row_of(d, stage);
        r.evidence.push_back(why.empty() ? fmt::format("{}: {:.3g} {} (+-{:.1f} %)", called(d), row->rate, row->unit, 100 * row->spread)
                                         : fmt::format("{}: not taken, {}", called(d), why));
    }
    const std::vector<std::size_t> best = ranked(devices, stage);
    if (best.empty()) {
        r.reason = "no device here does it right";
        return r;
    }
    const Row& first = *row_of(devices[best[0]], stage);
    r.devices = {best[0]};
    if (best.size() == 1) {
        r.reason = devices.size() == 1 ? "it is the only device here, and right in every stage"
                                       : fmt::format("it is the only one of {} devices that may be taken: {:.3g} {}", devices.size(),
                                                     first.rate, first.unit);
    } else {
        const Row& second = *row_of(devices[best[1]], stage);
        r.reason = fmt::format("it does {:.3g} {}, {:.2f} times as many as the next, {}", first.rate, first.unit, first.rate / second.rate,
                               called(devices[best[1]]));
    }
    for (const Joined& j : joined) {
        if (task != "render") break; // the other tasks run on one device, or gain nothing that was measured
        std::string names;
        for (const std::size_t d : j.devices) names += fmt::format("{}{}", names.empty() ? "" : "+", devices[d].facts.index);
        if (j.row.status != Status::ok) {
            r.evidence.push_back(fmt::format("{} joined: {}: {}", names, status_name(j.row.status), j.row.reason));
            continue;
        }
        const double gain = j.row.rate / first.rate;
        r.evidence.push_back(fmt::format("{} joined: {:.3g} {}, {:.2f} x the best alone", names, j.row.rate, j.row.unit, gain));
        if (gain < worth_a_second_device) continue;
        r.devices = j.devices;
        r.reason = fmt::format("together they do {:.3g} {}, {:.2f} times as many as the best alone", j.row.rate, j.row.unit, gain);
    }
    return r;
}

} // namespace clvr::bench

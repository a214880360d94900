#include "tools/bench/jobs.hpp"

#include "runtime/error.hpp"
#include "runtime/tune/tuning.hpp"
#include "tools/bench/ceiling.hpp"
#include "tools/bench/stage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <unistd.h>

namespace clvr::bench {
namespace {

using nlohmann::json;

json to_json(const DeviceName& d) {
    return {{"index", d.index}, {"sub_device", d.sub_device}, {"sub_devices", d.sub_devices}, {"name", d.name}};
}

DeviceName device_from(const json& j) { return {j.at("index"), j.at("sub_device"), j.at("sub_devices"), j.at("name")}; }

DeviceFacts find_device(const DeviceName& wanted) {
    static const std::vector<DeviceFacts> all = list_devices();
    static std::map<std::pair<int, int>, std::vector<DeviceFacts>> divided;
    const auto index = static_cast<std::size_t>(wanted.index);
    if (wanted.index < 0 || index >= all.size()) throw Error(ErrorKind::device, "is gone", wanted.name);
    if (wanted.sub_devices == 0) {
        if (all[index].name != wanted.name) throw Error(ErrorKind::device, "is no longer where it was in the list", wanted.name);
        return all[index];
    }
    auto& parts = divided[{wanted.index, wanted.sub_devices}];
    if (parts.empty()) parts = divide(all[index], wanted.sub_devices);
    return parts.at(static_cast<std::size_t>(wanted.sub_device));
}

Size size_for(const DeviceFacts& facts) { return facts.simulator ? Size::tiny : Size::standard; }

/// Empty, or what is wrong with the last run's result.
std::string wrongness(const Stage& stage, Size size, const StageRun& run, std::string* found = nullptr) {
    const std::string hash = run.hash(), golden = golden_hash(stage.name, size);
    if (found) *found = hash;
    if (golden.empty()) return "there is no golden hash to hold the result against";
    return hash == golden
               ? ""
               : fmt::format("its bits differ from the golden ones ({} instead of {})", hash.substr(0, 16), golden.substr(0, 16));
}

Status status_of(const Error& error) {
    const std::string what = error.what();
    const bool build = what.find("does not build") != std::string::npos;
    return error.kind() == ErrorKind::device && !build ? Status::unsupported : Status::error;
}

constexpr long pace_rounds = 300000; // about 2 ms at full speed

/// The pace of this process' processor; even for other devices.
Pace& pace_of(const DeviceFacts& facts, double best) {
    static std::map<unsigned, Pace> known;
    const bool processor = facts.type == DeviceType::cpu && !facts.simulator;
    const unsigned threads = processor ? facts.compute_units : 0;
    const auto found = known.find(threads);
    if (found != known.end()) return found->second;
    const auto loop = processor ? std::function<void()>([threads] { native::fma_chains(pace_rounds, threads); }) : std::function<void()>();
    return known.emplace(threads, Pace(steady_seconds, loop, best)).first->second;
}

void fill(Row& row, const Stage& stage, const StageRun& run, const Timing& t, double native_amount) {
    row.seconds = t.median_s;
    row.spread = t.spread;
    row.pace_s = t.pace_s;
    row.batches = t.batches;
    row.repeated = t.repeated;
    row.reason = t.note;
    if (!(t.median_s > 0)) {
        row.status = Status::error;
        return;
    }
    const double scale = stage.unit == "us" ? 1e6 : 1e3;
    row.rate = stage.unit_items > 0 ? run.items / stage.unit_items / t.median_s : t.median_s * scale;
    row.flops = run.flops / t.median_s;
    row.bytes = run.bytes / t.median_s;
    row.intensity = run.bytes > 0 ? run.flops / run.bytes : 0;
    if (native_amount > 0) row.native_share = (run.flops > 0 ? run.flops : run.bytes) * t.ratio / native_amount;
}

json measure_stage(const json& request) {
    const Stage& stage = stage_named(request.at("stage").get_ref<const std::string&>());
    Row row;
    row.stage = stage.name;
    row.unit = stage.unit;
    try {
        std::vector<Device> devices;
        for (const json& name : request.at("devices")) devices.push_back(Device::open_untested(find_device(device_from(name))));
        const DeviceFacts& facts = devices.front().facts();
        const Size size = request.at("tiny") ? Size::tiny : size_for(facts);
        row.size = size_name(size);
        if (facts.simulator && !stage.on_simulators) {
            row.status = Status::unsupported;
            row.reason = stage.without;
            return to_json(row);
        }
        StageRun run = stage.prepare(devices, size);
        row.note = run.note;
        run.run();
        if (const std::string wrong = wrongness(stage, size, run, &row.hash); !wrong.empty()) {
            row.status = Status::wrong_result;
            row.reason = wrong;
            return to_json(row);
        }
        Timing t;
        double native_amount = run.native_amount;
        if (run.timed_inside) {
            t.median_s = run.seconds;
            t.batches = 1;
        } else {
            const bool quick = request.at("quick");
            const Plan plan = facts.simulator ? Plan{1, 0, 1} : quick ? Plan{5, 0.01, 1} : Plan{9, 0.02, 4};
            Pace& pace = pace_of(facts, request.at("best_pace"));
            if (!run.native && run.flops > 0 && stage.ceiling != Ceiling::bandwidth && facts.type == DeviceType::cpu && !facts.simulator)
                run.native = [&] { native_amount = native::fma_chains(10 * pace_rounds, facts.compute_units); };
            t = measure(steady_seconds, pace, run.run, plan, run.native);
        }
        fill(row, stage, run, t, native_amount);
        if (facts.simulator) row.reason = "tiny size, run once: a simulator's speed says nothing of it";
        if (const std::string wrong = wrongness(stage, size, run); !wrong.empty()) {
            row.status = Status::wrong_result;
            row.reason = "right at first, but after the measurement " + wrong;
        }
    } catch (const Error& error) {
        row.status = status_of(error);
        row.reason = error.line();
    }
    return to_json(row);
}

/// A stage with given tunables, kept while the next candidates are held against it.
struct Prepared {
    std::string device, stage;
    Tunables tunables;
    StageRun run;
};

StageRun prepare_with(const DeviceFacts& facts, const Stage& stage, const Tunables& tunables) {
    std::vector<Device> devices{Device::open_untested(facts)};
    devices.front().set_tunables(tunables);
    StageRun run = stage.prepare(devices, size_for(facts));
    run.run();
    return run;
}

json compare_candidate(const json& request) {
    static std::vector<Prepared> bases;
    json answer{{"status", status_name(Status::ok)}, {"reason", ""}, {"speedup", 0.0}, {"spread", 0.0}, {"pruned", false}};
    const auto refuse = [&](Status status, const std::string& reason) {
        answer["status"] = status_name(status);
        answer["reason"] = reason;
        return answer;
    };
    try {
        const DeviceFacts facts = find_device(device_from(request.at("device")));
        const Tunables base = request.at("base"), candidate = request.at("candidate");
        double product = 1, most_spread = 0;
        for (const json& name : request.at("stages")) {
            const Stage& stage = stage_named(name.get_ref<const std::string&>());
            const std::string device = request.at("device").dump();
            if (bases.size() > 3) bases.erase(bases.begin());
            auto found = std::find_if(bases.begin(), bases.end(),
                                      [&](const Prepared& p) { return p.device == device && p.stage == stage.name && p.tunables == base; });
            if (found == bases.end()) {
                bases.push_back({device, stage.name, base, prepare_with(facts, stage, base)});
                found = bases.end() - 1;
                if (const std::string wrong = wrongness(stage, size_for(facts), found->run); !wrong.empty()) {
                    bases.pop_back();
                    return refuse(Status::wrong_result, "already before: " + wrong);
                }
            }
            const StageRun run = prepare_with(facts, stage, candidate);
            if (const std::string wrong = wrongness(stage, size_for(facts), run); !wrong.empty())
                return refuse(Status::wrong_result, wrong);
            const Comparison c = compare(steady_seconds, found->run.run, run.run, request.at("rounds"), request.at("limit_seconds"));
            if (!(c.speedup > 0)) return refuse(Status::error, "the clock jumped in every round");
            product *= std::pow(c.speedup, 1.0 / static_cast<double>(request.at("stages").size()));
            most_spread = std::max(most_spread, c.spread);
            if (c.pruned) answer["pruned"] = true;
            if (const std::string wrong = wrongness(stage, size_for(facts), run); !wrong.empty())
                return refuse(Status::wrong_result, wrong);
            if (c.pruned) break;
        }
        answer["speedup"] = product;
        answer["spread"] = most_spread;
    } catch (const Error& error) {
        return refuse(status_of(error), error.line());
    }
    return answer;
}

} // namespace

DeviceName name_of(const DeviceFacts& f) { return {f.index, f.sub_device, f.sub_devices, f.name}; }

std::string request_of(const MeasureJob& job) {
    json devices = json::array();
    for (const DeviceName& d : job.devices) devices.push_back(to_json(d));
    return json{{"do", "measure"},    {"devices", devices},         {"stage", job.stage},
                {"quick", job.quick}, {"best_pace", job.best_pace}, {"tiny", job.tiny}}
        .dump();
}

std::string request_of(const CompareJob& job) {
    return json{{"do", "compare"},
                {"device", to_json(job.device)},
                {"stages", job.stages},
                {"base", job.base},
                {"candidate", job.candidate},
                {"rounds", job.rounds},
                {"limit_seconds", job.limit_seconds}}
        .dump();
}

Verdict verdict_from(const std::string& answer) {
    const json j = json::parse(answer);
    Verdict v{Status::error, j.at("reason"), j.at("speedup"), j.at("spread"), j.at("pruned")};
    const std::string status = j.at("status");
    for (const Status s : {Status::ok, Status::unsupported, Status::wrong_result})
        if (status == status_name(s)) v.status = s;
    return v;
}

int serve() {
    const int answers = dup(STDOUT_FILENO); // drivers print to stdout what they like
    if (answers < 0 || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return exit_code(ErrorKind::internal);
    for (std::string line; std::getline(std::cin, line);) {
        const json request = json::parse(line);
        const json answer = request.at("do") == "measure" ? measure_stage(request) : compare_candidate(request);
        const std::string text = answer.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
        for (std::size_t sent = 0; sent < text.size();) {
            const ssize_t n = write(answers, text.data() + sent, text.size() - sent);
            if (n <= 0) return exit_code(ErrorKind::internal);
            sent += static_cast<std::size_t>(n);
        }
    }
    return 0;
}

} // namespace clvr::bench

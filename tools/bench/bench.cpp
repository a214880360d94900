#include "tools/bench/bench.hpp"

#include "runtime/trust/trust.hpp"
#include "tools/bench/stage.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clvr::bench {
namespace {

// Seconds. A tuning's last candidate ends before 300 or 60, the final checks included.
constexpr double row_limit = 120, quick_row_limit = 60, candidate_limit = 60, quick_candidate_limit = 20;
constexpr double tuning_limit = 220, quick_tuning_limit = 38, whole_tuning_limit = 290, whole_quick_tuning_limit = 58;

bool wanted(const BenchOptions& options, const Stage& stage) {
    return options.stages.empty() || std::find(options.stages.begin(), options.stages.end(), stage.name) != options.stages.end();
}

DeviceRows measure_device(const DeviceFacts& facts, const BenchOptions& options, Child& child) {
    DeviceRows d{facts, tuning_in_force(facts).rule, {}};
    const std::string unusable = why_unusable(facts);
    std::string distrust;
    if (unusable.empty()) {
        try {
            if (const Trust trust = trust_of(facts); !trust.ok()) distrust = trust.text() + " in the trust probe";
        } catch (const Error& error) {
            distrust = error.line();
        }
    }
    double best_pace = 0;
    const auto measured = [&](const Stage& stage) {
        Row row = ask_row(child, {{name_of(facts)}, stage.name, options.quick, best_pace, options.tiny},
                          options.quick ? quick_row_limit : row_limit);
        if (row.pace_s > 0 && (best_pace <= 0 || row.pace_s < best_pace)) best_pace = row.pace_s;
        if (!distrust.empty() && row.status == Status::ok) row.status = Status::wrong_result, row.reason = distrust;
        return row;
    };
    for (const Stage& stage : stages()) {
        if (!wanted(options, stage)) continue;
        Row row;
        row.stage = stage.name, row.unit = stage.unit;
        row.status = Status::unsupported, row.reason = unusable;
        d.rows.push_back(unusable.empty() ? measured(stage) : row);
    }
    for (Row& row : d.rows) // what the best pace shows to have been a slow phase from beginning to end
        if (row.status == Status::ok && best_pace > 0 && row.pace_s > Pace::slow * best_pace) {
            const int before = row.repeated;
            Row again = measured(stage_named(row.stage));
            if (again.status != Status::ok || again.pace_s < row.pace_s) row = again;
            row.repeated += before + 1;
            if (row.status == Status::ok && row.reason.empty() && row.pace_s > Pace::slow * best_pace)
                row.reason = "the machine ran slow while this was measured";
        }
    fill_shares(d);
    return d;
}

TunedDevice tune_device(const DeviceFacts& facts, bool quick, Child& child) {
    // What a user without a file of his own has: the shipped values.
    const auto shipped = shipped_tuning(facts);
    const double end = steady_seconds() + (quick ? whole_quick_tuning_limit : whole_tuning_limit);
    const Evaluate evaluate = [&](const Tunables& base, const Tunables& candidate, const std::vector<std::string>& on) {
        const double left = end - steady_seconds();
        if (left < 1) return Verdict{Status::error, "no time was left", 0, 0, false};
        return ask_verdict(child, {name_of(facts), on, base, candidate, quick ? 5 : 9, quick ? 2.0 : 6.0},
                           std::min(left, quick ? quick_candidate_limit : candidate_limit));
    };
    return tune(knobs_for(facts, quick), shipped ? shipped->tuning.values : Tunables(), evaluate, steady_seconds,
                quick ? quick_tuning_limit : tuning_limit);
}

std::string tuned_text(const TunedDevice& t) {
    std::string text = fmt::format("  tuned: {} candidates tried, {} refused", t.tried, t.refused);
    if (!t.left_out.empty()) text += fmt::format(", no time left for {}", fmt::join(t.left_out, ", "));
    std::string values;
    for (const auto& [name, value] : t.tuning.values) values += fmt::format("{}{}={}", values.empty() ? "" : ", ", name, value);
    return text + fmt::format("; kept: {}\n", values.empty() ? "what the code takes by itself" : values);
}

} // namespace

Row ask_row(Child& child, const MeasureJob& job, double limit_seconds) {
    Row row;
    row.stage = job.stage;
    row.status = Status::error;
    const Answer answer = child.ask(request_of(job), limit_seconds);
    row.reason = "the driver's process " + answer.why;
    if (!answer.ok) return row;
    try {
        return row_from_json(nlohmann::json::parse(answer.text));
    } catch (const nlohmann::json::exception&) {
        row.reason = "the driver's process gave no sensible answer";
        return row;
    }
}

Verdict ask_verdict(Child& child, const CompareJob& job, double limit_seconds) {
    const Answer answer = child.ask(request_of(job), limit_seconds);
    if (!answer.ok) return {Status::error, answer.why, 0, 0, false};
    try {
        return verdict_from(answer.text);
    } catch (const nlohmann::json::exception&) {
        return {Status::error, "gave no sensible answer", 0, 0, false};
    }
}

Report run_bench(const std::vector<DeviceFacts>& devices, const BenchOptions& options, Child& child,
                 const std::function<void(const std::string&)>& say) {
    Report report;
    report.quick = options.quick;
    for (const DeviceFacts& facts : devices) {
        const std::size_t position = report.devices.size();
        // Tuning first, so that the table shows what the tuned device does.
        if (options.tune && !facts.simulator && why_unusable(facts).empty()) {
            const TunedDevice tuned = tune_device(facts, options.quick, child);
            save_tuning(facts, tuned.tuning);
            report.tuned.emplace(position, tuned);
        }
        report.devices.push_back(measure_device(facts, options, child));
        say(table_text(report.devices.back()));
        if (report.tuned.count(position)) say(tuned_text(report.tuned.at(position)));
        say("\n");
    }
    if (const std::vector<std::size_t> pair = worth_joining(report.devices); !pair.empty()) {
        MeasureJob job{{}, stage_of_task("render"), options.quick, 0, options.tiny};
        for (const std::size_t d : pair) job.devices.push_back(name_of(report.devices[d].facts));
        report.joined.push_back({pair, ask_row(child, job, row_limit)});
    }
    for (const std::string& task : task_names()) report.recommendations.push_back(recommend(task, report.devices, report.joined));
    return report;
}

} // namespace clvr::bench

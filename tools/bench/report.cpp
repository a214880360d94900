#include "tools/bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clvr::bench {
namespace {

std::string percent(double share) { return share > 0 ? fmt::format("{:.0f} %", 100 * share) : std::string("-"); }

nlohmann::json to_json(const DeviceRows& d) {
    nlohmann::json rows = nlohmann::json::array();
    for (const Row& row : d.rows) rows.push_back(to_json(row));
    return {{"index", d.facts.index},
            {"name", d.facts.name},
            {"platform", d.facts.platform},
            {"platform_version", d.facts.platform_version},
            {"driver_version", d.facts.driver_version},
            {"type", type_name(d.facts.type)},
            {"simulator", d.facts.simulator},
            {"sub_device", d.facts.sub_device},
            {"sub_devices", d.facts.sub_devices},
            {"compute_units", d.facts.compute_units},
            {"native_float_width", d.facts.native_float_width},
            {"tuning", d.tuning},
            {"rows", rows}};
}

DeviceRows device_from_json(const nlohmann::json& j) {
    DeviceRows d;
    for (const auto& [name, to] : {std::pair("name", &d.facts.name),
                                   {"platform", &d.facts.platform},
                                   {"platform_version", &d.facts.platform_version},
                                   {"driver_version", &d.facts.driver_version},
                                   {"tuning", &d.tuning}})
        *to = j.at(name).get<std::string>();
    for (const auto& [name, to] :
         {std::pair("index", &d.facts.index), {"sub_device", &d.facts.sub_device}, {"sub_devices", &d.facts.sub_devices}})
        *to = j.at(name).get<int>();
    d.facts.simulator = j.at("simulator");
    d.facts.compute_units = j.at("compute_units");
    d.facts.native_float_width = j.at("native_float_width");
    const std::string type = j.at("type");
    for (const DeviceType t : {DeviceType::cpu, DeviceType::gpu, DeviceType::accelerator})
        if (type == type_name(t)) d.facts.type = t;
    for (const auto& row : j.at("rows")) d.rows.push_back(row_from_json(row));
    return d;
}

} // namespace

std::string time_text(double seconds) {
    if (!(seconds > 0)) return "-";
    return seconds < 1e-3 ? fmt::format("{:.3g} us", seconds * 1e6)
           : seconds < 1  ? fmt::format("{:.3g} ms", seconds * 1e3)
                          : fmt::format("{:.3g} s", seconds);
}

std::string table_text(const DeviceRows& d) {
    std::string text = fmt::format("device {} \"{}\"{} ({}, {}, driver {})\n  tuning: {}\n", d.facts.index, d.facts.name,
                                   d.facts.sub_devices ? fmt::format(", part {} of {}", d.facts.sub_device + 1, d.facts.sub_devices) : "",
                                   type_name(d.facts.type), d.facts.platform, d.facts.driver_version, d.tuning);
    text += fmt::format("  {:<16}  {:>9}  {:>7}  {:>10} {:<10}  {:>9}  {:>10}  {}\n", "stage", "time", "spread", "rate", "", "of native",
                        "of ceiling", "status");
    for (const Row& r : d.rows) {
        std::string said = status_name(r.status);
        if (!r.reason.empty()) said += ": " + r.reason;
        if (!r.note.empty() && r.status == Status::ok) said += fmt::format(" ({})", r.note);
        if (r.repeated > 0 && r.status == Status::ok) said += fmt::format(", {} batches again", r.repeated);
        const bool known = r.status == Status::ok;
        text +=
            fmt::format("  {:<16}  {:>9}  {:>7}  {:>10} {:<10}  {:>9}  {:>10}  {}\n", r.stage, known ? time_text(r.seconds) : "-",
                        known && r.batches > 2 ? fmt::format("{:.1f} %", 100 * r.spread) : "-", known ? fmt::format("{:.3g}", r.rate) : "-",
                        known ? r.unit : "", known ? percent(r.native_share) : "-", known ? percent(r.share) : "-", said);
    }
    return text;
}

nlohmann::json report_json(const Report& report) {
    nlohmann::json devices = nlohmann::json::array(), joined = nlohmann::json::array(), recommendations = nlohmann::json::object();
    for (std::size_t i = 0; i < report.devices.size(); ++i) {
        devices.push_back(to_json(report.devices[i]));
        if (const auto t = report.tuned.find(i); t != report.tuned.end())
            devices.back()["tuned"] = {{"tunables", t->second.tuning.values},
                                       {"evidence", t->second.tuning.evidence},
                                       {"tried", t->second.tried},
                                       {"refused", t->second.refused},
                                       {"left_out", t->second.left_out}};
    }
    const auto indices = [&](const std::vector<std::size_t>& positions) {
        nlohmann::json list = nlohmann::json::array();
        for (const std::size_t p : positions) list.push_back(report.devices[p].facts.index);
        return list;
    };
    for (const Joined& j : report.joined) joined.push_back({{"devices", indices(j.devices)}, {"row", to_json(j.row)}});
    for (const Recommendation& r : report.recommendations)
        recommendations[r.task] = {{"devices", indices(r.devices)}, {"reason", r.reason}, {"evidence", r.evidence}};
    return {
        {"clvr", CLVR_VERSION}, {"quick", report.quick}, {"devices", devices}, {"joined", joined}, {"recommendations", recommendations}};
}

Report report_from_json(const nlohmann::json& json) {
    Report report;
    report.quick = json.at("quick");
    for (const auto& j : json.at("devices")) {
        if (j.contains("tuned")) {
            TunedDevice& tuned = report.tuned[report.devices.size()];
            const auto& from = j.at("tuned");
            from.at("tunables").get_to(tuned.tuning.values);
            from.at("evidence").get_to(tuned.tuning.evidence);
            from.at("tried").get_to(tuned.tried);
            from.at("refused").get_to(tuned.refused);
            from.at("left_out").get_to(tuned.left_out);
        }
        report.devices.push_back(device_from_json(j));
    }
    const auto positions = [&](const nlohmann::json& indices) {
        std::vector<std::size_t> found;
        for (const int index : indices.get<std::vector<int>>())
            for (std::size_t p = 0; p < report.devices.size(); ++p)
                if (report.devices[p].facts.index == index) {
                    found.push_back(p);
                    break;
                }
        return found;
    };
    for (const auto& j : json.at("joined")) report.joined.push_back({positions(j.at("devices")), row_from_json(j.at("row"))});
    for (const std::string& task : task_names()) {
        const auto& j = json.at("recommendations");
        if (!j.contains(task)) continue;
        report.recommendations.push_back({task, positions(j.at(task).at("devices")), j.at(task).at("reason").get<std::string>(),
                                          j.at(task).at("evidence").get<std::vector<std::string>>()});
    }
    return report;
}

} // namespace clvr::bench

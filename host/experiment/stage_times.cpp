#include "host/experiment/stage_times.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {

using nlohmann::ordered_json;

StageTimes::StageTimes(std::string path) : path_(std::move(path)) {
    if (!std::filesystem::exists(path_)) return;
    try {
        const auto j = ordered_json::parse(read_text(path_));
        for (const auto& [stage, seconds] : j.at("seconds").items()) seconds_.emplace_back(stage, seconds.get<double>());
        j.at("finished").get_to(finished_);
    } catch (const nlohmann::json::exception& e) {
        throw Error(ErrorKind::input, fmt::format("is damaged ({}); remove it, nothing but times is lost", e.what()), path_);
    }
}

void StageTimes::finish(const std::string& stage) {
    if (!finished(stage)) finished_.push_back(stage);
    write();
}

bool StageTimes::finished(const std::string& stage) const {
    return std::find(finished_.begin(), finished_.end(), stage) != finished_.end();
}

double StageTimes::seconds(const std::string& stage) const {
    for (const auto& [name, seconds] : seconds_)
        if (name == stage) return seconds;
    return 0;
}

void StageTimes::add(const std::string& stage, double seconds) {
    const auto at = std::find_if(seconds_.begin(), seconds_.end(), [&](const auto& s) { return s.first == stage; });
    if (at == seconds_.end())
        seconds_.emplace_back(stage, seconds);
    else
        at->second += seconds;
    write();
}

void StageTimes::write() const {
    ordered_json seconds = ordered_json::object();
    for (const auto& [stage, s] : seconds_) seconds[stage] = s;
    const std::string text = ordered_json{{"seconds", seconds}, {"finished", finished_}}.dump(1) + "\n";
    write_atomically(path_, text);
}

StageTimes::Adding::~Adding() {
    try {
        times.add(stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    } catch (const Error&) { // a full disk, say: the stage's own error is the one to show
    }
}

} // namespace clvr

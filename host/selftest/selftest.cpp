#include "host/selftest/selftest.hpp"

#include "runtime/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>

namespace clvr::selftest {
namespace {

/// Compilers' logs have many lines; the first says what is wrong.
std::string first_line(const std::string& text) {
    std::string line = text.substr(0, text.find('\n'));
    if (line.size() < text.size()) {
        const std::size_t error = text.find("error:", line.size());
        if (error != std::string::npos) line += " " + text.substr(error, text.find('\n', error) - error);
    }
    return line;
}

Outcome outcome_of(const Check& check, Device& device) {
    try {
        return check.run(device);
    } catch (const Error& error) {
        return {false, "to run", first_line(error.line())};
    } catch (const std::bad_alloc&) {
        return {false, "to run", "out of host memory"};
    }
}

} // namespace

const std::vector<Check>& checks() {
    static const std::vector<Check> list{
        {"trust", "arithmetic as IEEE 754 says", check_trust},
        {"layout", "structs shared with the host", check_layout},
        {"random", "Philox4x32-10, published vectors", check_random},
        {"functions", "bits of log, exp, sine, atan2, acos", check_functions},
        {"seams", "a ramp across bricks", check_seams},
        {"majorants", "bounds of the opacity along rays", check_majorants},
        {"slab", "Beer's law", check_slab},
        {"furnace", "a white medium in white light", check_furnace},
        {"picture", "render, features and denoised frame, small", check_picture},
        {"frame-mip", "golden frame, maximum intensity", check_frame_mip},
        {"frame-dvr", "golden frame, emission and absorption", check_frame_dvr},
        {"frame-phase", "golden frame, fog-like", check_frame_phase},
        {"frame-automatic", "golden frame, fog and surfaces", check_frame_automatic},
        {"frame-gradient", "golden frame, surfaces under an image", check_frame_gradient},
        {"denoised", "golden frame through the network", check_denoised},
        {"gradient", "slope of the loss", check_gradient},
        {"training", "a few steps", check_training},
    };
    return list;
}

std::vector<const Check*> chosen_checks(const std::vector<std::string>& names) {
    std::vector<const Check*> chosen;
    std::string all;
    for (const Check& check : checks()) {
        all += fmt::format("{}{}", all.empty() ? "" : ", ", check.name);
        if (names.empty() || std::find(names.begin(), names.end(), check.name) != names.end()) chosen.push_back(&check);
    }
    for (const std::string& name : names)
        if (std::none_of(chosen.begin(), chosen.end(), [&](const Check* c) { return c->name == name; }))
            throw Error(ErrorKind::usage, fmt::format("there is no check \"{}\"; there are {}", name, all), "--check");
    return chosen;
}

std::vector<Result> run_checks(const DeviceFacts& facts, const std::vector<const Check*>& wanted, const Listener& listener) {
    Device device = Device::open_untested(facts); // the trust probe is one of the checks
    std::vector<Result> results;
    for (const Check* check : wanted) {
        if (listener.starts) listener.starts(*check);
        const auto start = std::chrono::steady_clock::now();
        Result result{check, outcome_of(*check, device), 0};
        result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        if (listener.ends) listener.ends(result);
        results.push_back(std::move(result));
    }
    return results;
}

std::string failed_names(const std::vector<Result>& results) {
    std::string names;
    for (const Result& r : results)
        if (!r.outcome.ok) names += fmt::format("{}{}", names.empty() ? "" : ", ", r.check->name);
    return names;
}

} // namespace clvr::selftest

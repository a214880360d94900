// Is this device right? Runs the checks on it, also on one that fails the trust probe: the answer is the report.
#pragma once
#include "host/selftest/check.hpp"
#include "runtime/drivers/facts.hpp"

#include <functional>

namespace clvr::selftest {

struct Result {
    const Check* check = nullptr;
    Outcome outcome;
    double seconds = 0;
};

/// Called before a check runs and with its result.
struct Listener {
    std::function<void(const Check&)> starts;
    std::function<void(const Result&)> ends;
};

/// The checks of these names in their order, all when there are none. Throws Error{usage} for a name that is none, listing them.
std::vector<const Check*> chosen_checks(const std::vector<std::string>& names);

/// Runs the checks one after the other; what a check throws is its failure. Throws Error{device} when the device cannot be opened at all.
std::vector<Result> run_checks(const DeviceFacts& facts, const std::vector<const Check*>& wanted, const Listener& listener = {});

/// Names of the failed checks, joined by commas; empty when the device can be trusted.
std::string failed_names(const std::vector<Result>& results);

} // namespace clvr::selftest

#include "runtime/tune/tunables.hpp"

#include "runtime/system/nearest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace clvr {
namespace {

bool is_power_of_two(int value) { return value > 0 && (value & (value - 1)) == 0; }

} // namespace

bool AllowedValues::hold(int value) const {
    if (!range_) return std::find(values_.begin(), values_.end(), value) != values_.end();
    return value >= *values_.begin() && value <= values_.begin()[1] && (!powers_ || is_power_of_two(value));
}

std::vector<int> AllowedValues::samples() const {
    if (!range_) return {values_.begin(), values_.end()};
    constexpr int steps = 4; // of equal ratio
    const double low = std::log2(*values_.begin()), high = std::log2(values_.begin()[1]);
    std::vector<int> samples;
    for (int i = 0; i <= steps; ++i) {
        const double exponent = low + (high - low) * i / steps;
        samples.push_back(static_cast<int>(std::lround(std::exp2(powers_ ? std::round(exponent) : exponent))));
    }
    samples.erase(std::unique(samples.begin(), samples.end()), samples.end());
    return samples;
}

std::string AllowedValues::text() const {
    if (range_) return fmt::format("a {} from {} to {}", powers_ ? "power of two" : "whole number", *values_.begin(), values_.begin()[1]);
    std::string text;
    for (const int& value : values_) {
        const bool last = &value + 1 == values_.end();
        text += fmt::format("{}{}", text.empty() ? "" : last ? " or " : ", ", value);
    }
    return text;
}

int value_of(const Tunable& tunable, const DeviceFacts& device, const Tunables& set) {
    const auto found = set.find(tunable.name);
    return found == set.end() ? tunable.usual(device, set) : found->second;
}

std::string why_refused(const std::string& name, int value) {
    std::vector<std::string> names;
    for (const Tunable* tunable : declared_tunables()) {
        if (tunable->name == name)
            return tunable->allowed.hold(value) ? "" : fmt::format("\"{}\" is {}, but must be {}", name, value, tunable->allowed.text());
        names.push_back(tunable->name);
    }
    std::sort(names.begin(), names.end());
    const std::string near = nearest_name(name, names);
    return fmt::format("there is no tunable \"{}\"{}; there are {}", name, near.empty() ? "" : " (did you mean " + near + "?)",
                       fmt::join(names, ", "));
}

} // namespace clvr

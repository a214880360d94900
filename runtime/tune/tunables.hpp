// What a tunable is: a whole number that changes speed and never a bit. Each is declared once, beside the stage that reads it (tunables.hpp
// in a folder of host/), with its name, the values it may have and its default. CLVR_TUNE, tuning files, Device and the tuner of
// clvr-bench read the declarations.
#pragma once
#include "runtime/drivers/facts.hpp"

#include <array>
#include <cstddef>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

namespace clvr {

/// Name -> value; a name without a value has its default.
using Tunables = std::map<std::string, int>;

/// A few elements, for constants.
template <class T, std::size_t most>
class Few {
public:
    constexpr Few() = default;
    constexpr Few(std::initializer_list<T> list) {
        for (const T& element : list) elements_[count_++] = element;
    }
    constexpr const T* begin() const { return elements_.data(); }
    constexpr const T* end() const { return elements_.data() + count_; }
    constexpr std::size_t size() const { return count_; }
    constexpr bool empty() const { return count_ == 0; }

private:
    std::array<T, most> elements_{};
    std::size_t count_ = 0;
};
using FewNumbers = Few<int, 10>;

/// The values that a tunable may have: a list, or the whole numbers or powers of two of a range.
class AllowedValues {
public:
    static constexpr AllowedValues list(FewNumbers values) { return {values, false}; }
    static constexpr AllowedValues whole(int low, int high) { return {{low, high}, false, true}; }
    static constexpr AllowedValues powers_of_two(int low, int high) { return {{low, high}, true, true}; }
    bool hold(int value) const;
    /// In order; of a range, which begins above 0, its ends and three between.
    std::vector<int> samples() const;
    /// "1, 4, 8 or 16", "a power of two from 1 to 256", "a whole number from 1 to 64".
    std::string text() const;

private:
    constexpr AllowedValues(FewNumbers values, bool powers, bool range = false) : values_(values), powers_(powers), range_(range) {}
    FewNumbers values_; // of a range its ends
    bool powers_, range_;
};

struct Tunable {
    const char* name;
    AllowedValues allowed;
    /// The default on a device, where these values are set (one may depend on another). Where it depends on a shape as well, the stage
    /// gives its own to Device::tunable, and this is the usual one.
    int (*usual)(const DeviceFacts& device, const Tunables& set);
    Few<const char*, 3> stages; ///< of clvr-bench, that it may speed up
    /// What the tuner tries, in order; nothing: it does not try it.
    FewNumbers tried_on_cpu, tried_elsewhere;
    bool quick = false; ///< tried with --quick, too

    const FewNumbers& tried(const DeviceFacts& device) const { return device.type == DeviceType::cpu ? tried_on_cpu : tried_elsewhere; }
};

/// All tunables, those first of which a tuning promises most. The list is host/tunables.cpp.
const std::vector<const Tunable*>& declared_tunables();

/// What is set, else the default.
int value_of(const Tunable& tunable, const DeviceFacts& device, const Tunables& set);

/// Why a name cannot have this value, in one line that says which names or values there are; empty when it can.
std::string why_refused(const std::string& name, int value);

} // namespace clvr

// The values of tunables on a device, in this order: CLVR_TUNE, what `clvr-bench --tune` measured here ($XDG_CONFIG_HOME/clvr/tuning/, a
// file per device and driver), what clvr ships (datasets/tuning/, embedded), the declared defaults (runtime/tune/tunables.hpp).
#pragma once
#include "runtime/drivers/facts.hpp"
#include "runtime/tune/tunables.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// What a tuning file holds.
struct Tuning {
    Tunables values;
    std::vector<std::string> evidence; ///< a line a measurement, for people
};

/// "name=value,name=value" as CLVR_TUNE has it. Throws Error{usage} naming `where`, also for what is not declared.
Tunables parse_tunables(const std::string& text, const std::string& where);

/// What CLVR_TUNE says; nothing where it is not set. Throws Error{usage}.
Tunables tunables_from_environment();

/// The text of a tuning file. Throws Error{input} naming `where` when it is no such file, or a name or value is not declared.
Tuning parse_tuning(const std::string& text, const std::string& where);

/// Where the measured tuning of this device and driver is kept, there or not; nothing without a configuration folder.
std::optional<std::filesystem::path> tuning_path(const DeviceFacts& device);

/// The measured tuning; nothing where none is kept. A file that cannot be read or understood is ignored with a warning: no run should fail
/// because of a tuning.
std::optional<Tuning> measured_tuning(const DeviceFacts& device);

/// Keeps a measured tuning for the next runs. Throws Error{input} naming the file when it cannot be written.
void save_tuning(const DeviceFacts& device, const Tuning& tuning);

/// A tuning that clvr ships: for devices whose platform's name holds `platform`, of a type ("cpu", "gpu"), and of native vectors of so many
/// floats (0: any).
struct ShippedTuning {
    std::string name, platform, type;
    unsigned native_float_width = 0;
    Tuning tuning;
    bool fits(const DeviceFacts& device) const;
};

/// The text of a file under datasets/tuning/. Throws Error{input} naming `where`.
ShippedTuning parse_shipped_tuning(const std::string& text, const std::string& where);

/// The shipped tuning that fits the device, if any.
std::optional<ShippedTuning> shipped_tuning(const DeviceFacts& device);

/// The values in force on a device, and where they come from, in words.
struct TuningInForce {
    Tunables values;
    std::string rule;
};

/// Puts together what the environment, the user's file and the shipped one say, name by name: an earlier one wins.
TuningInForce tuning_in_force(const DeviceFacts& device);

} // namespace clvr

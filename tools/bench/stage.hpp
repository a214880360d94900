// What clvr-bench measures: one descriptor per stage drives both its correctness and its speed.
#pragma once
#include "runtime/opencl/device.hpp"
#include "tools/bench/statistics.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace clvr::bench {

/// Sizes with golden results: `standard` for devices, `tiny` for simulators, which interpret a thousand times slower.
enum class Size { standard, tiny };
const char* size_name(Size size);

/// A stage made ready on a device (or several). It holds its devices' buffers.
struct StageRun {
    std::function<void()> run;         ///< once, to its end
    std::function<std::string()> hash; ///< of what the last run left, equal on every device that is right
    double items = 0;                  ///< that a run does, in the stage's unit
    double flops = 0, bytes = 0;       ///< that a run computes and moves at least, where known
    std::string note;                  ///< which variant, such as "width 16"
    /// The same work by native code on the processor, for devices that are the processor; `native_amount` counts as `flops` where those are
    /// known, else as `bytes`.
    std::function<void()> native;
    double native_amount = 0;
    bool timed_inside = false; ///< `run` is no steady work: its own figure is in `seconds`
    double seconds = 0;
};

/// Which ceiling a stage is held against.
enum class Ceiling { none, arithmetic, bandwidth };

struct Stage {
    std::string name;    ///< shown, and the key of its golden hashes
    std::string unit;    ///< of items per second: "Mpaths/s" means 1e6 items
    double unit_items;   ///< items of a unit: 1e6 for "M..."; 0: the time itself is the result
    Ceiling ceiling;     ///< for the share of the device's own ceiling
    std::string task;    ///< whose figure it is: "render", "denoise", "train", or empty
    bool on_simulators;  ///< worth its time there, at `tiny`
    std::string without; ///< why not on simulators
    /// Throws Error{device} for what the device does not offer ("unsupported").
    std::function<StageRun(std::vector<Device>& devices, Size size)> prepare;
};

/// All stages, in the order of the table: the device's properties first, then clvr's own.
const std::vector<Stage>& stages();
/// Throws Error{usage} naming it when there is none of that name.
const Stage& stage_named(const std::string& name);

/// The golden hash of a stage at a size; empty where there is none, which is an error of this program. One table for all: stages.cpp.
std::string golden_hash(const std::string& stage, Size size);

/// Stages by file, put together by stages().
std::vector<Stage> probe_stages();
std::vector<Stage> transfer_stages();
std::vector<Stage> render_stages();
std::vector<Stage> network_stages();

/// SHA-256 (hex) of numbers.
std::string hash_of(const std::vector<float>& values);
/// 0 <= value < 1, the same everywhere.
float noise(std::uint32_t i);
std::vector<float> noise_values(std::size_t count);

} // namespace clvr::bench

// Which device for which task, from what was measured.
#pragma once
#include "runtime/choose/selector.hpp"
#include "tools/bench/row.hpp"

#include <string>
#include <vector>

namespace clvr::bench {

/// A measured combination of devices for a task.
struct Joined {
    std::vector<std::size_t> devices; ///< positions in the list of DeviceRows
    Row row;
};

struct Recommendation {
    std::string task;
    std::vector<std::size_t> devices; ///< positions; empty: none is able
    std::string reason;               ///< one sentence without its full stop
    std::vector<std::string> evidence;
};

/// The task's stage ("path trace" of "render").
std::string stage_of_task(const std::string& task);
/// "render", "denoise", "train".
const std::vector<std::string>& task_names();

/// The fastest device whose row of the task's stage is ok and whose other rows of clvr's own stages hold no wrong result; simulators never.
/// A joined measurement wins where it is at least a tenth faster than the best alone.
Recommendation recommend(const std::string& task, const std::vector<DeviceRows>& devices, const std::vector<Joined>& joined = {});

/// The two fastest devices for rendering, when joining them is worth measuring: both able, the slower at least a tenth of the faster.
std::vector<std::size_t> worth_joining(const std::vector<DeviceRows>& devices);

} // namespace clvr::bench

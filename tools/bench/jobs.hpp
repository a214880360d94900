// What the child process does: measures a stage, or compares a candidate of a tuning with what it may replace. Requests and answers are
// JSON, a line each.
#pragma once
#include "runtime/drivers/facts.hpp"
#include "runtime/tune/tuning.hpp"
#include "tools/bench/row.hpp"

#include <optional>
#include <string>
#include <vector>

namespace clvr::bench {

/// A device as another process finds it again.
struct DeviceName {
    int index = 0, sub_device = -1, sub_devices = 0;
    std::string name;
};
DeviceName name_of(const DeviceFacts& facts);

struct MeasureJob {
    std::vector<DeviceName> devices; ///< one; several joined
    std::string stage;
    bool quick = false;
    double best_pace = 0; ///< seconds, 0: unknown
    bool tiny = false;    ///< the size of simulators, on any device
};

struct CompareJob {
    DeviceName device;
    std::vector<std::string> stages;
    Tunables base, candidate; ///< all values in force, each
    int rounds = 5;
    double limit_seconds = 6; ///< of a stage's rounds
};

/// What a candidate is worth.
struct Verdict {
    Status status = Status::ok;
    std::string reason;
    double speedup = 0; ///< over the base: the geometric mean over the stages
    double spread = 0;  ///< the greatest of theirs
    bool pruned = false;
};

std::string request_of(const MeasureJob& job);
std::string request_of(const CompareJob& job);
/// Throws nlohmann::json::exception for what is no answer.
Verdict verdict_from(const std::string& answer);

/// The child: answers requests from stdin on stdout until that ends. What drivers print to stdout goes to stderr.
int serve();

} // namespace clvr::bench

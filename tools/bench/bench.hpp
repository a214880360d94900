// The program's course: measure every device in a child process, tune, recommend.
#pragma once
#include "tools/bench/child.hpp"
#include "tools/bench/report.hpp"

#include <functional>

namespace clvr::bench {

struct BenchOptions {
    bool quick = false, tune = false, tiny = false;
    std::vector<std::string> stages; ///< empty: all
};

/// Measures, tunes and recommends; calls `say` with each finished table and remark. Rows that were measured while the machine ran slow, by
/// the best pace seen in the end, are measured once more.
Report run_bench(const std::vector<DeviceFacts>& devices, const BenchOptions& options, Child& child,
                 const std::function<void(const std::string&)>& say);

/// One row from the child; what becomes of a crash or silence is a row with status error.
Row ask_row(Child& child, const MeasureJob& job, double limit_seconds);
Verdict ask_verdict(Child& child, const CompareJob& job, double limit_seconds);

} // namespace clvr::bench

// What clvr-bench finds out: a row per device and stage, each with a status and a reason.
#pragma once
#include "runtime/drivers/facts.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace clvr::bench {

enum class Status { ok, unsupported, wrong_result, error };
const char* status_name(Status s); ///< "ok", "unsupported", "wrong result", "error"

struct Row {
    std::string stage, unit, size;
    Status status = Status::ok;
    std::string reason;             ///< why the status is not ok, or why the numbers are to be doubted
    std::string note;               ///< which variant
    double seconds = 0, spread = 0; ///< of one run: median, and half the interquartile range over it
    double rate = 0;                ///< in `unit`; where that is a time, the time
    double flops = 0, bytes = 0;    ///< a second; 0 unknown
    double intensity = 0;           ///< flops a byte; 0 unknown
    double native_share = 0;        ///< of native code on the same processor, measured in turn; 0 unknown
    double share = 0;               ///< of the device's own ceiling (FMA rate, or the better of copy and triad); 0 unknown
    double pace_s = 0;              ///< of the machine while it was measured (statistics.hpp)
    int batches = 0, repeated = 0;
    std::string hash; ///< found
};

nlohmann::json to_json(const Row& row);
/// Throws nlohmann::json::exception for what is no row.
Row row_from_json(const nlohmann::json& json);

/// A device and what was measured of it.
struct DeviceRows {
    DeviceFacts facts;
    std::string tuning; ///< which rule gave the tunables
    std::vector<Row> rows;
    /// The row of a stage if it is ok; null else.
    const Row* ok_row(const std::string& stage) const;
};

/// Fills in each row's share of the device's own ceiling.
void fill_shares(DeviceRows& device);

} // namespace clvr::bench

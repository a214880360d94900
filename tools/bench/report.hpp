// What clvr-bench shows: a table, JSON, an HTML page.
#pragma once
#include "tools/bench/recommend.hpp"
#include "tools/bench/row.hpp"
#include "tools/bench/tuner.hpp"

#include <map>
#include <string>
#include <vector>

namespace clvr::bench {

struct Report {
    bool quick = false;
    std::vector<DeviceRows> devices;
    std::vector<Joined> joined;
    std::map<std::size_t, TunedDevice> tuned; ///< by position of the device
    std::vector<Recommendation> recommendations;
};

/// "12.3 ms", "4.56 us", "1.20 s".
std::string time_text(double seconds);

/// One device's header and rows, as lines.
std::string table_text(const DeviceRows& device);

nlohmann::json report_json(const Report& report);
/// What report_json() wrote, with those facts of the devices that it holds. Throws nlohmann::json::exception for what is none.
Report report_from_json(const nlohmann::json& json);

/// One page that needs nothing beside it: tables, bars per stage, a roofline of each device.
std::string report_html(const Report& report);

/// The roofline of a device as SVG: its ceilings by arithmetic intensity, and the stages whose arithmetic and bytes are known. Empty
/// without ceilings.
std::string roofline_svg(const DeviceRows& device);

} // namespace clvr::bench

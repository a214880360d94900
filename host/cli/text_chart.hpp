// Charts of Unicode blocks for terminals.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace clvr {

/// A bar chart of log(1 + count) over low .. high: at most 64 columns and 8 rows, with numbers below. `values`: how many different values
/// there can be; no more columns than that are drawn (0: any number).
std::string histogram_chart(const std::vector<std::uint64_t>& bins, double low, double high, double values);

} // namespace clvr

// Line charts as SVG text.
#pragma once
#include <string>
#include <vector>

namespace clvr {

struct Series {
    std::string name;
    std::vector<double> values; ///< at x = 1, 2, ...; what is not finite is left out
};

/// A chart of 560 x 300 units with axes, round ticks and a legend; text is escaped. An empty string when no value is finite. `logarithmic`:
/// of y, when all values are above 0. `x_names` stand below the values in place of 1, 2, ...
std::string line_chart(const std::string& title, const std::string& x_label, const std::vector<Series>& series, bool logarithmic = false,
                       const std::vector<std::string>& x_names = {});

/// Text as HTML or SVG shows it.
std::string escaped(const std::string& text);

} // namespace clvr

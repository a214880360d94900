#include "host/cli/text_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace clvr {

std::string histogram_chart(const std::vector<std::uint64_t>& bins, double low, double high, double values) {
    constexpr std::size_t rows = 8, most_columns = 64, label_columns = 16;
    constexpr std::array blocks{" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    constexpr const char* margin = "  ";
    const std::size_t columns = values >= 1 && values < most_columns ? static_cast<std::size_t>(values) : most_columns;
    const std::size_t repeat = most_columns / columns; // few values: wide bars
    std::vector<std::uint64_t> counts(columns);
    for (std::size_t b = 0; b < bins.size(); ++b) counts[b * columns / bins.size()] += bins[b];
    const std::uint64_t most = std::max<std::uint64_t>(*std::max_element(counts.begin(), counts.end()), 1);

    std::string chart = fmt::format("{}voxels, log scale, {} in the tallest bar\n", margin, most);
    for (std::size_t row = rows; row-- > 0;) {
        chart += margin;
        for (const std::uint64_t n : counts) {
            // Eighths of a row; whatever is there is seen.
            const double height =
                std::log1p(static_cast<double>(n)) / std::log1p(static_cast<double>(most)) * static_cast<double>(rows * 8);
            const auto eighths = n > 0 ? std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(height))) : 0;
            const std::size_t part = eighths > row * 8 ? std::min<std::size_t>(eighths - row * 8, 8) : 0;
            for (std::size_t i = 0; i < repeat; ++i) chart += blocks[part];
        }
        chart += '\n';
    }
    const std::size_t width = columns * repeat;
    const std::size_t labels = std::max<std::size_t>(width / label_columns, 1);
    chart += margin;
    for (std::size_t i = 0; i < labels; ++i)
        chart += fmt::format("{:<{}}", fmt::format("{:.4g}", low + (high - low) * static_cast<double>(i) / static_cast<double>(labels)),
                             width / labels);
    return chart + fmt::format("{:.4g}\n", high);
}

} // namespace clvr

#include "runtime/opencl/profile.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clvr {

void Profile::add(const std::string& label, double elapsed_ms, double bytes, double flops) {
    auto row = std::find_if(rows_.begin(), rows_.end(), [&](const ProfileRow& r) { return r.label == label; });
    if (row == rows_.end()) {
        rows_.push_back({label, 0, 0, 0, 0});
        row = rows_.end() - 1;
    }
    ++row->launches;
    row->elapsed_ms += elapsed_ms;
    row->bytes += bytes;
    row->flops += flops;
}

std::string Profile::table() const {
    std::size_t width = 5;
    double total_ms = 0;
    for (const ProfileRow& row : rows_) {
        width = std::max(width, row.label.size());
        total_ms += row.elapsed_ms;
    }
    // amount per ms / 1e6 = giga per second
    const auto rate = [](double amount, double ms) {
        return amount > 0 && ms > 0 ? fmt::format("{:.1f}", amount / ms / 1e6) : std::string("-");
    };
    std::string text =
        fmt::format("{:<{}}  {:>8}  {:>10}  {:>6}  {:>8}  {:>8}\n", "stage", width, "launches", "ms", "share", "GB/s", "GFLOP/s");
    for (const ProfileRow& row : rows_)
        text += fmt::format("{:<{}}  {:>8}  {:>10.2f}  {:>5.1f}%  {:>8}  {:>8}\n", row.label, width, row.launches, row.elapsed_ms,
                            total_ms > 0 ? 100 * row.elapsed_ms / total_ms : 0, rate(row.bytes, row.elapsed_ms),
                            rate(row.flops, row.elapsed_ms));
    text += fmt::format("{:<{}}  {:>8}  {:>10.2f}\n", "total", width, "", total_ms);
    return text;
}

} // namespace clvr

// Timing of launches and transfers, a row per label.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace clvr {

/// Sum over all launches of one label since the profile was cleared. Times are device times (start to end of the command).
struct ProfileRow {
    std::string label;
    std::size_t launches = 0;
    double elapsed_ms = 0, bytes = 0, flops = 0;
};

class Profile {
public:
    void add(const std::string& label, double elapsed_ms, double bytes, double flops);
    void clear() { rows_.clear(); }
    /// Rows in order of first use.
    const std::vector<ProfileRow>& rows() const { return rows_; }
    /// The table that `--profile` prints: stage, launches, ms, share, GB/s, GFLOP/s ("-" where unknown).
    std::string table() const;

private:
    std::vector<ProfileRow> rows_;
};

} // namespace clvr

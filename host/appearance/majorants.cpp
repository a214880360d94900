#include "host/appearance/majorants.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {
namespace {

/// Greatest opacity of any run of table entries in constant time: level k holds the maxima of all runs of 2^k entries.
class RunMaxima {
public:
    explicit RunMaxima(const std::vector<float>& entries) : levels_{entries} {
        const int n = static_cast<int>(entries.size());
        log2_.resize(n + 1, 0);
        for (int length = 2; length <= n; ++length) log2_[length] = static_cast<unsigned char>(log2_[length / 2] + 1);
        for (int run = 1; 2 * run <= n; run *= 2) {
            const std::vector<float>& half = levels_.back();
            std::vector<float> whole(n - 2 * run + 1);
            for (std::size_t e = 0; e < whole.size(); ++e) whole[e] = std::max(half[e], half[e + run]);
            levels_.push_back(std::move(whole));
        }
    }
    float operator()(int first, int last) const {
        const int k = log2_[last - first + 1];
        return std::max(levels_[k][first], levels_[k][last + 1 - (1 << k)]);
    }

private:
    std::vector<std::vector<float>> levels_;
    std::vector<unsigned char> log2_; ///< floor of the logarithm of each length
};

} // namespace

std::vector<float> majorants(const MajorantGrid& grid, const TransferTable& table) {
    const RunMaxima greatest(table.opacity);
    const TableIndex index(table);
    std::vector<float> result(grid.count());
    for_parts(grid.count(), [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t c = first; c < last; ++c)
            result[c] =
                greatest(static_cast<int>(std::floor(index(grid.range[2 * c]))), static_cast<int>(std::ceil(index(grid.range[2 * c + 1]))));
    });
    return result;
}

} // namespace clvr

#include "runtime/system/nearest.hpp"

#include <algorithm>

namespace clvr {

namespace {

/// How many changes make one word the other: optimal string alignment.
std::size_t changes(const std::string& a, const std::string& b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        for (std::size_t j = 0; j <= b.size(); ++j) {
            if (i == 0 || j == 0) {
                d[i][j] = i + j;
                continue;
            }
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

} // namespace

std::string nearest_name(const std::string& word, const std::vector<std::string>& names) {
    std::string nearest;
    const std::size_t letters = word.size() - std::min(word.size(), word.find_first_not_of('-'));
    std::size_t least = (letters > 2 ? 2 : 1) + 1;
    for (const auto& name : names) {
        if (word.size() + name.size() > 256) continue;
        const std::size_t n = letters > 2 && name.rfind(word, 0) == 0 ? 1 : changes(word, name);
        if (n < least) least = n, nearest = name;
    }
    return nearest;
}

} // namespace clvr

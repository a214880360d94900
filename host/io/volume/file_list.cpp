#include "host/io/volume/file_list.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>

namespace clvr {

namespace {

constexpr std::int64_t most_files = 1000000;

/// "%d", "%03d", "%5i", ... within a name.
struct Conversion {
    std::size_t at, size;
    bool zeros;
    std::size_t width;
};

/// The only conversion of a pattern; nothing when there is none, or more than one.
std::optional<Conversion> conversion_of(std::string_view pattern) {
    std::optional<Conversion> found;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%') continue;
        std::size_t end = i + 1, width = 0;
        const bool zeros = end < pattern.size() && pattern[end] == '0';
        while (end < pattern.size() && pattern[end] >= '0' && pattern[end] <= '9' && width < 100)
            width = 10 * width + static_cast<std::size_t>(pattern[end++] - '0');
        if (end == pattern.size() || width >= 100 || std::string_view("diu").find(pattern[end]) == std::string_view::npos) continue;
        if (found) return std::nullopt;
        found = Conversion{i, end + 1 - i, zeros, width};
        i = end;
    }
    return found;
}

} // namespace

std::optional<NumberedFiles> numbered_files(std::string_view value, std::size_t least) {
    NumberedFiles files;
    std::string_view name = trimmed(value);
    while (files.numbers.size() < 4) {
        const auto blank = name.find_last_of(" \t");
        const std::string_view word = blank == std::string_view::npos ? std::string_view{} : name.substr(blank + 1);
        std::int64_t n = 0;
        const auto [next, error] = std::from_chars(word.data(), word.data() + word.size(), n);
        if (word.empty() || error != std::errc() || next != word.data() + word.size()) break;
        files.numbers.insert(files.numbers.begin(), n);
        name = trimmed(name.substr(0, blank));
    }
    files.pattern = std::string(name);
    return files.numbers.size() < least || !conversion_of(name) ? std::nullopt : std::optional(files);
}

std::vector<std::string> names_of(const std::string& pattern, std::int64_t min, std::int64_t max, std::int64_t step,
                                  const std::string& header) {
    const Conversion c = conversion_of(pattern).value();
    constexpr std::int64_t far = std::int64_t{1} << 40;
    if (step == 0 || std::abs(step) > far || std::abs(min) > far || std::abs(max) > far || (max - min) / step < 0 ||
        (max - min) / step >= most_files)
        bad_file(header, "the numbers {} {} {} of its data files make no list: expected first, last and step", min, max, step);
    std::vector<std::string> names;
    for (std::int64_t n = min; step > 0 ? n <= max : n >= max; n += step) {
        std::string name = pattern;
        names.push_back(name.replace(c.at, c.size, c.zeros ? fmt::format("{:0{}}", n, c.width) : fmt::format("{:{}}", n, c.width)));
    }
    return names;
}

void check_file_count(std::size_t files, const std::vector<std::int64_t>& sizes, std::int64_t subdim, const std::string& header) {
    const auto axes = static_cast<std::int64_t>(sizes.size()), count = static_cast<std::int64_t>(files);
    if (subdim < 1 || subdim > axes) bad_file(header, "each data file has {} axes: expected 1 to {}", subdim, axes);
    if (subdim == axes) { // pieces of the slowest axis
        if (count < 1 || sizes.back() % count != 0)
            bad_file(header, "the header names {} data files: expected a number that divides {}", count, sizes.back());
        return;
    }
    std::int64_t expected = 1;
    for (std::int64_t i = subdim; i < axes && expected <= most_files; ++i)
        expected *= std::min(sizes[static_cast<std::size_t>(i)], most_files + 1);
    if (count != expected) bad_file(header, "the header names {} data files: expected {}", count, expected);
}

} // namespace clvr

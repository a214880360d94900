#include "host/io/volume/header_text.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace clvr {

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
    std::vector<double> values;
    const char *p = text.data(), *const end = p + text.size();
    while (true) {
        while (p != end && (std::isspace(static_cast<unsigned char>(*p)) || *p == ',' || *p == '(' || *p == ')')) ++p;
        if (p == end) return values;
        if (*p == '+' && p + 1 != end && p[1] != '-') ++p; // from_chars takes no plus
        double value = 0;
        const auto [next, error] = std::from_chars(p, end, value);
        if (error != std::errc() || (next != end && !std::isspace(static_cast<unsigned char>(*next)) && *next != ',' && *next != ')'))
            return std::nullopt;
        values.push_back(value);
        p = next;
    }
}

std::vector<std::int64_t> parse_integers(std::string_view text, std::size_t count, std::int64_t least, const char* field,
                                         const std::string& path) {
    const auto values = parse_numbers(text);
    std::vector<std::int64_t> integers;
    if (values)
        for (const double x : *values)
            if (x >= static_cast<double>(least) && x < 4e18 && x == std::floor(x)) integers.push_back(static_cast<std::int64_t>(x));
    if (!values || integers.size() != values->size() || integers.size() != count)
        bad_file(path, "{} is \"{:.60}\": expected {} whole number{} of at least {}", field, text, count, count == 1 ? "" : "s", least);
    return integers;
}

std::vector<double> parse_finite(std::string_view text, std::size_t count, const char* field, const std::string& path) {
    const auto values = parse_numbers(text);
    if (!values || values->size() != count || !std::all_of(values->begin(), values->end(), [](double x) { return std::isfinite(x); }))
        bad_file(path, "{} is \"{:.60}\": expected {} finite number{}", field, text, count, count == 1 ? "" : "s");
    return *values;
}

std::vector<double> parse_spacing(std::string_view text, std::size_t count, const char* field, const std::string& path) {
    const auto values = parse_numbers(text);
    if (!values || values->size() != count ||
        !std::all_of(values->begin(), values->end(), [](double x) { return std::isfinite(x) && x != 0; }))
        bad_file(path, "{} is \"{:.60}\": expected {} finite number{} other than 0", field, text, count, count == 1 ? "" : "s");
    return *values;
}

std::string_view trimmed(std::string_view s) {
    constexpr const char* blanks = " \t\r\n";
    const auto first = s.find_first_not_of(blanks);
    return first == std::string_view::npos ? std::string_view{} : s.substr(first, s.find_last_not_of(blanks) - first + 1);
}

std::string lower_case(std::string_view s) {
    std::string t(s);
    std::transform(t.begin(), t.end(), t.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return t;
}

namespace {

/// The file, or the only one of its folder whose name differs in case alone; empty when there is none.
std::filesystem::path file_in_any_case(const std::filesystem::path& wanted) {
    std::error_code error;
    if (std::filesystem::is_regular_file(wanted, error)) return wanted;
    std::filesystem::path found;
    const std::string name = lower_case(wanted.filename().string());
    for (std::filesystem::directory_iterator i(wanted.parent_path().empty() ? "." : wanted.parent_path(), error), end; !error && i != end;
         i.increment(error)) {
        if (lower_case(i->path().filename().string()) != name || !i->is_regular_file(error)) continue;
        if (!found.empty()) return {};
        found = i->path();
    }
    return found;
}

} // namespace

std::string beside(const std::string& header, const std::string& name) {
    const std::filesystem::path folder = std::filesystem::path(header).parent_path();
    std::filesystem::path found = file_in_any_case(folder / name); // an absolute name replaces the folder
    if (found.empty() && name.find('\\') != std::string::npos) {
        std::string parted = name;
        std::replace(parted.begin(), parted.end(), '\\', '/');
        found = file_in_any_case(folder / parted);
    }
    if (found.empty()) bad_file(header, "its voxels are missing: there is no file {}", (folder / name).string());
    return found.string();
}

} // namespace clvr

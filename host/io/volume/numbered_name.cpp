#include "host/io/volume/numbered_name.hpp"
#include "host/io/volume/header_text.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace clvr {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || static_cast<unsigned char>(c) >= 128; }

std::string without_zeros(const std::string& digits) {
    const auto first = digits.find_first_not_of('0');
    return first == std::string::npos ? "" : digits.substr(first);
}
std::string without_end_zeros(const std::string& digits) {
    const auto last = digits.find_last_not_of('0');
    return last == std::string::npos ? "" : digits.substr(0, last + 1);
}

/// The name without the ending of a picture: other endings may be the slice's number.
std::string stem_of(const std::string& name) {
    const std::string ending = lower_case(std::filesystem::path(name).extension().string());
    for (const char* known : {".tif", ".tiff", ".png", ".jpg", ".jpeg"})
        if (ending == known) return name.substr(0, name.size() - ending.size());
    return name;
}

} // namespace

std::string NameNumber::text() const { return (negative ? "-" : "") + whole + (fraction.empty() ? "" : "." + fraction); }
double NameNumber::value() const { return std::strtod(text().c_str(), nullptr); }
std::size_t NameNumber::digits() const { return without_zeros(whole).size() + fraction.size(); }

bool operator<(const NameNumber& a, const NameNumber& b) {
    const auto sign = [](const NameNumber& n) {
        const bool zero = without_zeros(n.whole).empty() && without_zeros(n.fraction).empty();
        return zero ? 0 : n.negative ? -1 : 1;
    };
    if (sign(a) != sign(b)) return sign(a) < sign(b);
    if (sign(a) == 0) return false;
    const auto less = [](const NameNumber& x, const NameNumber& y) { // of their amounts
        const std::string xs = without_zeros(x.whole), ys = without_zeros(y.whole);
        if (xs.size() != ys.size()) return xs.size() < ys.size();
        if (xs != ys) return xs < ys;
        return without_end_zeros(x.fraction) < without_end_zeros(y.fraction);
    };
    return sign(a) > 0 ? less(a, b) : less(b, a);
}

std::string NumberedName::pattern() const {
    std::string pattern = texts.front();
    for (std::size_t i = 1; i < texts.size(); ++i) pattern += "#" + texts[i];
    return pattern;
}

NumberedName numbered_name(const std::string& whole, bool signs_after_letters) {
    const std::string stem = stem_of(whole);
    NumberedName name;
    name.name = whole;
    std::string text;
    for (std::size_t at = 0; at < stem.size();) {
        if (!is_digit(stem[at])) {
            text += stem[at++];
            continue;
        }
        NameNumber n;
        const auto run = [&](std::size_t from) { return std::min(stem.find_first_not_of("0123456789", from), stem.size()); };
        const std::size_t end = run(at);
        n.whole = stem.substr(at, end - at);
        const auto point_at = [&](std::size_t i) { return i + 1 < stem.size() && stem[i] == '.' && is_digit(stem[i + 1]); };
        const bool chained = at >= 2 && stem[at - 1] == '.' && is_digit(stem[at - 2]);
        std::size_t next = end;
        if (!chained && point_at(end) && !point_at(run(end + 1))) {
            next = run(end + 1);
            n.fraction = stem.substr(end + 1, next - end - 1);
        }
        if (!text.empty() && (text.back() == '-' || text.back() == '+')) {
            const char before = at >= 2 ? stem[at - 2] : '\0';
            if (before == '\0' || (!is_digit(before) && (signs_after_letters || !is_letter(before)) && before != ')')) {
                n.negative = text.back() == '-';
                text.pop_back();
            }
        }
        name.texts.push_back(lower_case(text));
        text.clear();
        name.numbers.push_back(std::move(n));
        at = next;
    }
    name.texts.push_back(lower_case(text));
    return name;
}

} // namespace clvr

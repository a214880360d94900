#include "host/io/dicom/elements.hpp"
#include "host/io/volume/header_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace clvr {

namespace {

std::optional<double> decimal_of(std::string_view text) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size() && !text.empty() ? std::optional(value) : std::nullopt;
}

std::uint64_t whole(const std::string& bytes, std::size_t at, std::size_t n, bool big) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < n; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes[at + (big ? n - 1 - i : i)])} << (8 * i);
    return value;
}

} // namespace

const std::string* DicomElements::bytes(DicomTag tag) const {
    const auto value = values.find(tag);
    return value == values.end() ? nullptr : &value->second;
}

std::string DicomElements::text(DicomTag tag) const {
    const std::string* value = bytes(tag);
    if (!value) return {};
    return std::string(trimmed(std::string_view(*value).substr(0, value->find('\0'))));
}

std::vector<std::string> DicomElements::texts(DicomTag tag) const {
    const std::string all = text(tag);
    std::vector<std::string> parts;
    for (std::size_t at = 0; !all.empty() && at <= all.size();) {
        const std::size_t end = std::min(all.find('\\', at), all.size());
        parts.emplace_back(trimmed(std::string_view(all).substr(at, end - at)));
        at = end + 1;
    }
    return parts;
}

std::vector<std::uint32_t> DicomElements::words(DicomTag tag, std::size_t bytes_each) const {
    std::vector<std::uint32_t> all;
    if (const std::string* value = bytes(tag))
        for (std::size_t at = 0; at + bytes_each <= value->size(); at += bytes_each)
            all.push_back(static_cast<std::uint32_t>(whole(*value, at, bytes_each, big_endian)));
    return all;
}

std::optional<int> DicomElements::unsigned_short(DicomTag tag) const {
    const std::string* value = bytes(tag);
    return value && value->size() >= 2 ? std::optional(static_cast<int>(whole(*value, 0, 2, big_endian))) : std::nullopt;
}

std::optional<double> DicomElements::real(DicomTag tag) const {
    const std::string* value = bytes(tag);
    if (!value) return std::nullopt;
    if (value->size() == 4) {
        const auto bits = static_cast<std::uint32_t>(whole(*value, 0, 4, big_endian));
        float x;
        std::memcpy(&x, &bits, sizeof x);
        return x;
    }
    if (value->size() < 8) return std::nullopt;
    const std::uint64_t bits = whole(*value, 0, 8, big_endian);
    double x;
    std::memcpy(&x, &bits, sizeof x);
    return x;
}

std::vector<double> DicomElements::decimals(DicomTag tag, const char* name, const std::string& path) const {
    std::vector<double> numbers;
    for (const std::string& part : texts(tag)) {
        const auto number = decimal_of(part);
        if (!number)
            throw DicomSliceError(ErrorKind::input,
                                  fmt::format("{} is \"{:.60}\", which is no number{}", name, text(tag),
                                              part.find(',') == std::string::npos
                                                  ? ""
                                                  : ": DICOM writes a decimal point, no comma; correct the element in the file"),
                                  path);
        numbers.push_back(*number);
    }
    return numbers;
}

std::optional<double> DicomElements::decimal(DicomTag tag, const char* name, const std::string& path) const {
    const auto numbers = decimals(tag, name, path);
    if (numbers.size() > 1)
        throw DicomSliceError(ErrorKind::input, fmt::format("{} is \"{:.60}\": expected one number", name, text(tag)), path);
    return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

double DicomElements::count(DicomTag tag, double fallback) const {
    const auto parts = texts(tag);
    const double number = parts.empty() ? fallback : decimal_of(parts.front()).value_or(fallback);
    return std::isfinite(number) ? number : fallback;
}

const DicomElements* DicomElements::item(DicomTag sequence) const {
    const auto found = sequences.find(sequence);
    return found == sequences.end() || found->second.empty() ? nullptr : &found->second.front();
}

} // namespace clvr

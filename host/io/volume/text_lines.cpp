#include "host/io/volume/text_lines.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

namespace clvr {

namespace {

constexpr std::size_t longest_line = std::size_t{1} << 26, longest_word = 1000;

bool separates(char c) { return std::isspace(static_cast<unsigned char>(c)) || c == ','; }

/// The whole word as T; nothing when it is none. Floats beyond T's range become infinite or 0.
template <class T>
std::optional<T> number_of(const std::string& word) {
    const char *begin = word.data(), *const end = begin + word.size();
    if (word.size() > 1 && word[0] == '+' && word[1] != '-') ++begin; // from_chars takes no plus
    T value{};
    const auto [next, error] = std::from_chars(begin, end, value);
    if (next == end && error == std::errc()) return value;
    if constexpr (std::is_floating_point_v<T>) {
        if (next == end && error == std::errc::result_out_of_range) return static_cast<T>(std::strtod(begin, nullptr));
    } else if (const auto real = number_of<double>(word)) { // "12.0" is whole, too
        constexpr double beyond = 2.0 * static_cast<double>(T{1} << (std::numeric_limits<T>::digits - 1));
        if (*real == std::floor(*real) && *real < beyond && *real >= static_cast<double>(std::numeric_limits<T>::min()))
            return static_cast<T>(*real);
    }
    return std::nullopt;
}

template <class T>
void store_number(const std::string& word, std::uint64_t index, const std::string& path, unsigned char* to) {
    const auto value = number_of<T>(word);
    if (!value)
        bad_file(path, "value {} is \"{:.20}\": expected {}", index, word,
                 std::is_floating_point_v<T>
                     ? std::string("a number")
                     : fmt::format("a whole number from {} to {}", std::numeric_limits<T>::min(), std::numeric_limits<T>::max()));
    std::memcpy(to, &*value, sizeof(T));
}

using StoreNumber = void (*)(const std::string& word, std::uint64_t index, const std::string& path, unsigned char* to);
StoreNumber store_number_of(SampleType type) {
    switch (type) {
    case SampleType::u8:
        return store_number<std::uint8_t>;
    case SampleType::i8:
        return store_number<std::int8_t>;
    case SampleType::u16:
        return store_number<std::uint16_t>;
    case SampleType::i16:
        return store_number<std::int16_t>;
    case SampleType::u32:
        return store_number<std::uint32_t>;
    case SampleType::i32:
        return store_number<std::int32_t>;
    case SampleType::u64:
        return store_number<std::uint64_t>;
    case SampleType::i64:
        return store_number<std::int64_t>;
    case SampleType::f32:
        return store_number<float>;
    case SampleType::f64:
        return store_number<double>;
    default:
        throw Error(ErrorKind::input, fmt::format("numbers of type {} as text are not read", sample_type_name(type)));
    }
}

} // namespace

bool TextLines::fill() {
    buffer_.resize(1 << 16);
    buffer_.resize(from_.read(buffer_.data(), buffer_.size()));
    at_ = 0;
    return !buffer_.empty();
}

std::optional<std::string> TextLines::line() {
    std::string text;
    bool any = false;
    while (at_ < buffer_.size() || fill()) {
        any = true;
        const auto end = buffer_.find('\n', at_);
        const std::size_t n = (end == std::string::npos ? buffer_.size() : end) - at_;
        text.append(buffer_, at_, n);
        if (text.size() > longest_line) bad_file(path_, "a line of its header is longer than {} MiB: no header", longest_line >> 20);
        at_ += n;
        position_ += n;
        if (end == std::string::npos) continue;
        ++at_;
        ++position_;
        break;
    }
    if (!any) return std::nullopt;
    if (!text.empty() && text.back() == '\r') text.pop_back();
    return text;
}

std::string TextLines::word() {
    std::string text;
    while (at_ < buffer_.size() || fill()) {
        const char c = buffer_[at_];
        if (separates(c) ? !text.empty() : text.size() == longest_word) break;
        ++at_;
        ++position_;
        if (!separates(c)) text += c;
    }
    return text;
}

std::size_t TextLines::read(void* to, std::size_t bytes) {
    const std::size_t held = std::min(bytes, buffer_.size() - at_);
    std::memcpy(to, buffer_.data() + at_, held);
    at_ += held;
    const std::size_t n = held + (held < bytes ? from_.read(static_cast<char*>(to) + held, bytes - held) : 0);
    position_ += n;
    return n;
}

std::uint64_t TextLines::skip(std::uint64_t bytes) {
    const std::uint64_t held = std::min<std::uint64_t>(bytes, buffer_.size() - at_);
    at_ += static_cast<std::size_t>(held);
    const std::uint64_t n = held + (held < bytes ? from_.skip(bytes - held) : 0);
    position_ += n;
    return n;
}

TextSamples::TextSamples(TextLines& from, SampleType type, std::uint64_t expected, std::string path)
    : from_(from), type_(type), expected_(expected), path_(std::move(path)) {}

std::size_t TextSamples::read(void* to, std::size_t bytes) {
    const StoreNumber store = store_number_of(type_);
    auto* out = static_cast<unsigned char*>(to);
    const std::size_t size = sample_bytes(type_);
    std::size_t n = 0;
    for (; n + size <= bytes && done_ < expected_; n += size, ++done_) {
        const std::string word = from_.word();
        if (word.empty()) bad_file(path_, "expected {} voxels as text, found {}: the file is truncated", expected_, done_);
        store(word, done_, path_, out + n);
    }
    return n;
}

} // namespace clvr

#include "tests/fuzz/mutation.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

namespace clvr::test {

namespace {

/// 0..n-1, without std::uniform_int_distribution, whose numbers differ between libraries.
std::size_t below(std::size_t n, std::mt19937_64& random) { return n ? random() % n : 0; }

void put_edge_number(std::string& bytes, std::size_t at, std::mt19937_64& random) {
    constexpr std::array<std::uint64_t, 12> edges{0,       1,          0x7f,       0xff,       0x7fff,     0xffff,
                                                  0x10000, 0x7fffffff, 0x80000000, 0xffffffff, 0x7ff00000, 0x7f800000};
    std::uint64_t value = edges[below(edges.size(), random)];
    if (below(4, random) == 0) value = ~value;
    const std::size_t size = std::min<std::size_t>(std::size_t{1} << below(4, random), bytes.size() - at);
    const bool big = below(2, random) == 1;
    for (std::size_t i = 0; i < size; ++i) bytes[at + (big ? size - 1 - i : i)] = static_cast<char>(value >> (8 * i) & 0xff);
}

/// Puts another number for the first digits behind `at`.
void put_text_number(std::string& bytes, std::size_t at, std::mt19937_64& random) {
    const std::array<const char*, 14> texts{"0",   "-1",  "1e308", "-1e400", "1e-320",     "nan",        "inf",
                                            "1.5", "007", "1,5",   "65536",  "2147483648", "4294967296", "99999999999999999999"};
    const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    const auto begin = std::find_if(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes.end(), digit);
    const auto end = std::find_if_not(begin, bytes.end(), digit);
    if (begin != end) bytes.replace(begin, end, texts[below(texts.size(), random)]);
}

} // namespace

std::string mutated(std::string bytes, const std::string& other, std::mt19937_64& random) {
    for (std::size_t change = 1 + below(4, random); change > 0; --change) {
        if (bytes.empty()) return bytes;
        const std::size_t at = below(bytes.size(), random), length = 1 + below(std::min<std::size_t>(64, bytes.size() - at), random);
        switch (below(9, random)) {
        case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8, random)));
            break;
        case 1:
            bytes[at] = static_cast<char>(below(256, random));
            break;
        case 2:
        case 3:
            put_edge_number(bytes, at, random);
            break;
        case 4:
        case 5:
            put_text_number(bytes, at, random);
            break;
        case 6:
            bytes.erase(at, below(8, random) == 0 ? std::string::npos : length);
            break;
        case 7:
            bytes.insert(at, bytes.substr(at, length));
            break;
        default:
            bytes.replace(at, length, other.substr(below(other.size(), random), length));
        }
    }
    return bytes;
}

} // namespace clvr::test

#include "host/view/net_text.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace clvr::view {

std::string encoded(const std::string& text) {
    constexpr const char* plain = "-._~";
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        const bool stays = byte < 0x80 && (std::isalnum(byte) != 0 || std::string(plain).find(c) != std::string::npos);
        out += stays ? std::string(1, c) : fmt::format("%{:02X}", byte);
    }
    return out;
}

std::string decoded(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool coded = text[i] == '%' && i + 2 < text.size() && std::isxdigit(static_cast<unsigned char>(text[i + 1])) != 0 &&
                           std::isxdigit(static_cast<unsigned char>(text[i + 2])) != 0;
        out += coded ? static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16)) : text[i];
        i += coded ? 2 : 0;
    }
    return out;
}

std::string cut_utf8(const std::string& text, std::size_t most) {
    std::size_t end = std::min(text.size(), most);
    while (end > 0 && end < text.size() && (text[end] & 0xc0) == 0x80) --end;
    return text.substr(0, end);
}

} // namespace clvr::view

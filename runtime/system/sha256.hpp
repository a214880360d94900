// SHA-256 of texts and of lists of texts.
#pragma once
#include <initializer_list>
#include <string>
#include <string_view>

namespace clvr {

/// 64 lower-case hexadecimal digits.
std::string sha256_hex(std::string_view bytes);

/// Of the parts, each with its length before it, so that no two lists have the same bytes.
std::string sha256_hex(std::initializer_list<std::string_view> parts);

} // namespace clvr

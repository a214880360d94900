// Texts for addresses and close frames.
#pragma once
#include <string>

namespace clvr::view {

/// Percent-encoding (RFC 3986): %XX for every byte that is not a letter, a digit or one of -._~
std::string encoded(const std::string& text);
/// What is no %XX stays as it is.
std::string decoded(const std::string& text);
/// At most so many bytes of it, without half a character at the end.
std::string cut_utf8(const std::string& text, std::size_t most);

} // namespace clvr::view

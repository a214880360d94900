// Byte counts as people write them.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace clvr {

/// "1048576", "512M", "1.5G", "64KiB": bytes, with the binary factor of K, M, G or T (an optional "B" or "iB" after it).
/// Throws Error{usage} naming `what` (an option or environment variable) for anything else, 0 and overflow included.
std::size_t parse_size(std::string_view text, const std::string& what);

/// The size in an environment variable; nothing when it is unset or empty. Throws as parse_size.
std::optional<std::size_t> size_from_environment(const char* variable);

/// "1.4 GiB", "312 MiB", "17 bytes".
std::string size_text(std::size_t bytes);

} // namespace clvr

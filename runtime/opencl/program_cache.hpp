// Program binaries on disk, for drivers that keep none themselves. An entry is checked in full before a driver sees it: some abort on
// broken ones.
#pragma once
#include "runtime/drivers/facts.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace clvr {

/// What decides a binary: the expanded source, the options (definitions included), device, driver and platform versions, and the format of
/// the entries. A SHA-256 in hexadecimal.
std::string program_key(const DeviceFacts& facts, std::string_view source, std::string_view options);

/// The file's bytes: format, key, length and SHA-256 of the binary, then the binary.
std::string encode_entry(const std::string& key, std::string_view binary);

/// The binary; nothing when the entry is cut, changed, longer than it says, of another format, or was made for another key.
std::optional<std::string> decode_entry(const std::string& key, std::string_view entry);

/// The stored binary under `key`; nothing when there is none or it is broken.
std::optional<std::string> load_program(const std::string& key);

/// Stores a binary. Two processes may store the same key at once. A failure is logged for debugging and otherwise ignored.
void store_program(const std::string& key, std::string_view binary);

} // namespace clvr

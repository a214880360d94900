// Files that are never seen half-written.
#pragma once
#include <cstddef>
#include <functional>
#include <string>

namespace clvr {

/// Calls `write(temporary_path)`, then fsyncs and renames to `path`; removes the temporary when anything throws. Throws Error{input}
/// naming `path` and the reason when the folder cannot be written.
void write_atomically(const std::string& path, const std::function<void(const std::string& temporary_path)>& write);
void write_atomically(const std::string& path, const void* bytes, std::size_t size);
/// Whole file as text. Throws Error{input}.
std::string read_text(const std::string& path, std::size_t limit_bytes = std::size_t{64} << 20);

} // namespace clvr

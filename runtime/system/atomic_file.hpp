// Files that are never seen half-written.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

namespace clvr {

/// Where the bytes of a file of this name go. Symbolic links are followed, so that they stay links; also links to a file that does not
/// exist yet.
std::filesystem::path final_place(const std::filesystem::path& path);

/// Throws Error{input} with the reason unless a regular file can be made or replaced at `path`. Leaves nothing behind.
void check_writable(const std::string& path);
/// Calls `write(temporary_path)` (an empty file in the folder of `path`), then brings it to disk and renames it to `path`; removes the
/// temporary when anything throws. Two processes may write the same path: one of them wins as a whole. Throws Error{input} naming `path`
/// and the reason.
void write_atomically(const std::string& path, const std::function<void(const std::string& temporary_path)>& write);
void write_atomically(const std::string& path, const void* bytes, std::size_t size);
inline void write_atomically(const std::string& path, const std::string& text) { write_atomically(path, text.data(), text.size()); }

/// Throws Error{input} with the reason unless `path` is a file that can be opened.
void check_readable(const std::string& path);
/// Whole file, as text or bytes. Throws Error{input}, also when it is larger than the limit.
std::string read_text(const std::string& path, std::size_t limit_bytes = std::size_t{64} << 20);

} // namespace clvr

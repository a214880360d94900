// Files that people try and that clvr does not read.
#pragma once
#include <string>

namespace clvr {

/// What the file is and what to do with it, where its first bytes are the mark of a kind that clvr does not read; else empty.
std::string other_kind_of_head(const std::string& head);
/// The same by the file's name, in any case, for a file whose bytes say nothing.
std::string other_kind_of_name(const std::string& path);
/// The same for a folder.
std::string other_kind_of_folder(const std::string& path);

} // namespace clvr

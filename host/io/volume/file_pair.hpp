// Volumes in two files of the same name with different endings.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// The file beside `path` that has one of the endings `to` in place of the ending of `path` (one of `from`): the letters' case does not
/// matter, though a file whose case agrees goes first, then the order of `to`. Endings are given in lower case with their dot. Empty
/// where there is none, or where `path` has none of `from`.
std::string file_beside(const std::string& path, const std::vector<std::string>& from, const std::vector<std::string>& to);

} // namespace clvr

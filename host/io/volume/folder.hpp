// The files in a folder that may be a user's.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// Whether the file's name is one that operating systems leave in folders: "._x" (AppleDouble), .DS_Store, Thumbs.db, desktop.ini.
bool is_system_file(const std::string& path);

struct FolderFiles {
    std::vector<std::string> paths; ///< regular files, in order of their names
    std::vector<std::string> notes; ///< what was left out, a line
};
/// Regular files in `folder`, without those of operating systems (noted); with `recursive` those of the folders inside it, too (links to
/// folders are not followed). Throws Error{input} where a folder cannot be read.
FolderFiles files_in(const std::string& folder, bool recursive);

} // namespace clvr

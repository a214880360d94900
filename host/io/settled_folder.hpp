// Folders that belong to settings.
#pragma once
#include <string>

namespace clvr {

/// Makes the folder with `text`, a JSON, in its file `name`; a file that is there must hold the same members, in any order. Throws
/// Error{input}: the folder cannot be made, or the file holds other ones (`conflict` says what that means and what to do).
void begin_settled_folder(const std::string& folder, const std::string& name, const std::string& text, const std::string& conflict);

} // namespace clvr

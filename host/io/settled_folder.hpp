// Folders that belong to settings.
#pragma once
#include <string>

namespace clvr {

/// Makes the folder with `text` in its file `name`; a file that is there must hold the same text. Throws Error{input}: the folder cannot be
/// made, or the file holds another text (`conflict` says what that means and what to do).
void begin_settled_folder(const std::string& folder, const std::string& name, const std::string& text, const std::string& conflict);

} // namespace clvr

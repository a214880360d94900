// Folders that belong to settings.
#pragma once
#include <string>

namespace clvr {

/// Makes the folder with `text` in its file `name`; one that is there must hold the same text. Throws Error{input}: cannot be made, holds
/// another text
/// (`conflict` says what that means and what to do).
void begin_settled_folder(const std::string& folder, const std::string& name, const std::string& text, const std::string& conflict);

} // namespace clvr

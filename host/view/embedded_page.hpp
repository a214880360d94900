// The page's files, inside the binary.
#pragma once
#include <map>
#include <string>

namespace clvr {

/// Every file under host/view/page/ by its name; made at build time by tools/embed.cmake.
const std::map<std::string, std::string>& embedded_page();

} // namespace clvr

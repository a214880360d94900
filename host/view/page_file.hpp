// What is answered to a GET for a part of the page.
#pragma once
#include <string>

namespace clvr::view {

struct PageFile {
    const std::string* text; ///< null: there is no such file
    const char* type;        ///< Content-Type
};
/// `path` without the leading '/'; empty: the page itself.
PageFile page_file(const std::string& path);

/// What may be loaded from where, for every answer.
inline constexpr const char* content_policy =
    "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; base-uri 'none'; form-action 'none'";

} // namespace clvr::view

#include "host/view/page_file.hpp"
#include "host/view/embedded_page.hpp"

namespace clvr::view {

namespace {

const char* type_of(const std::string& name) {
    const std::string ending = name.substr(name.rfind('.') + 1);
    if (ending == "html") return "text/html; charset=utf-8";
    if (ending == "css") return "text/css; charset=utf-8";
    if (ending == "svg") return "image/svg+xml";
    return "text/javascript; charset=utf-8";
}

} // namespace

PageFile page_file(const std::string& path) {
    const std::string name = path.empty() ? "index.html" : path;
    const auto found = embedded_page().find(name);
    return {found == embedded_page().end() ? nullptr : &found->second, type_of(name)};
}

} // namespace clvr::view

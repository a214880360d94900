#include "host/io/settled_folder.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace clvr {

namespace fs = std::filesystem;

namespace {

/// Two JSON texts with the same members, in any order: a later clvr may write them in another.
bool same_settings(const std::string& a, const std::string& b) {
    if (a == b) return true;
    const auto parsed = [](const std::string& text) { return nlohmann::json::parse(text, nullptr, false); };
    const nlohmann::json first = parsed(a), second = parsed(b);
    return !first.is_discarded() && first == second;
}

} // namespace

void begin_settled_folder(const std::string& folder, const std::string& name, const std::string& text, const std::string& conflict) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed) throw Error(ErrorKind::input, fmt::format("cannot be made: {}", failed.message()), folder);
    const std::string path = (fs::path(folder) / name).string();
    if (!fs::exists(path)) return write_atomically(path, text);
    if (!same_settings(read_text(path), text)) throw Error(ErrorKind::input, conflict, folder);
}

} // namespace clvr

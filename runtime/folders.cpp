#include "runtime/folders.hpp"

#include <cstdlib>
#include <unistd.h>

namespace clvr {
namespace {

std::optional<std::filesystem::path> xdg_folder(const char* variable, const char* under_home) {
    const auto absolute = [](const char* name) -> std::optional<std::filesystem::path> {
        const char* value = std::getenv(name);
        if (!value || *value != '/') return std::nullopt;
        return value;
    };
    if (const auto base = absolute(variable)) return *base / "clvr";
    if (const auto home = absolute("HOME")) return *home / under_home / "clvr";
    return std::nullopt;
}

} // namespace

std::optional<std::filesystem::path> cache_folder() { return xdg_folder("XDG_CACHE_HOME", ".cache"); }

std::optional<std::filesystem::path> config_folder() { return xdg_folder("XDG_CONFIG_HOME", ".config"); }

bool writable_folder(const std::filesystem::path& folder) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    return std::filesystem::is_directory(folder, failed) && access(folder.c_str(), W_OK | X_OK) == 0;
}

} // namespace clvr

#include "runtime/system/folders.hpp"
#include "runtime/system/atomic_file.hpp"

#include <spdlog/spdlog.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>
#include <unistd.h>

namespace clvr {
namespace fs = std::filesystem;
namespace {

std::optional<fs::path> xdg_folder(const char* variable, const char* under_home) {
    const auto absolute = [](const char* name) -> std::optional<fs::path> {
        const char* value = std::getenv(name);
        if (!value || *value != '/') return std::nullopt;
        return value;
    };
    if (const auto base = absolute(variable)) return *base / "clvr";
    if (const auto home = absolute("HOME")) return *home / under_home / "clvr";
    return std::nullopt;
}

} // namespace

std::optional<fs::path> cache_folder() {
    const auto folder = xdg_folder("XDG_CACHE_HOME", ".cache");
    if (folder && writable_folder(*folder)) return folder;
    static std::atomic_flag warned = ATOMIC_FLAG_INIT;
    if (!warned.test_and_set())
        spdlog::warn("the cache folder {} cannot be written, so kernels are built and devices probed anew in each run; set XDG_CACHE_HOME "
                     "to a writable folder",
                     folder ? folder->string() : "(HOME is not set)");
    return std::nullopt;
}

void warn_of_ignored_file(const Error& error) {
    static std::mutex mutex;
    static std::set<std::string> warned;
    const std::lock_guard lock(mutex);
    if (warned.insert(error.line()).second) spdlog::warn("{}; clvr goes on without it", error.line());
}

std::optional<fs::path> config_folder() { return xdg_folder("XDG_CONFIG_HOME", ".config"); }

bool writable_folder(const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    return fs::is_directory(folder, failed) && access(folder.c_str(), W_OK | X_OK) == 0;
}

std::optional<std::string> load_file(const fs::path& path) {
    std::error_code failed;
    if (!fs::is_regular_file(path, failed)) return std::nullopt;
    std::ifstream file(path, std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(file), {});
    if (!file) return std::nullopt;
    return bytes;
}

bool replace_file(const fs::path& path, std::string_view bytes) {
    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    try {
        write_atomically(path.string(), bytes.data(), bytes.size());
        return true;
    } catch (const Error&) {
        return false;
    }
}

} // namespace clvr

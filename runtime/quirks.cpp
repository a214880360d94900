#include "runtime/quirks.hpp"

#include "runtime/folders.hpp"

#include <spdlog/spdlog.h>

#include <cstdlib>
#include <filesystem>

namespace clvr::quirks {
namespace fs = std::filesystem;
namespace {

/// Where PoCL 3.1 keeps compiled kernels (lib/CL/pocl_cache.c, pocl_cache_init_topdir): empty when no variable says.
fs::path pocl_cache() {
    const auto variable = [](const char* name) { return std::getenv(name) ? fs::path(std::getenv(name)) : fs::path(); };
    if (!variable("POCL_CACHE_DIR").empty()) return variable("POCL_CACHE_DIR");
    if (!variable("XDG_CACHE_HOME").empty()) return variable("XDG_CACHE_HOME") / "pocl" / "kcache";
    if (!variable("HOME").empty()) return variable("HOME") / ".cache" / "pocl" / "kcache";
    return {};
}

fs::path private_cache; // of this process, empty when the usual one serves

} // namespace

void pocl_hides_devices_without_writable_cache() {
    const fs::path usual = pocl_cache();
    if (!usual.empty() && writable_folder(usual)) return;
    std::error_code failed;
    std::string folder = (fs::temp_directory_path(failed) / "clvr-pocl-XXXXXX").string();
    if (failed || !mkdtemp(folder.data())) {
        spdlog::warn("no folder for compiled kernels can be written ({} and the temporary folder); PoCL will show no device",
                     usual.string());
        return;
    }
    private_cache = folder;
    setenv("POCL_CACHE_DIR", folder.c_str(), 1);
    std::atexit([] {
        std::error_code ignored;
        fs::remove_all(private_cache, ignored);
    });
    spdlog::debug("PoCL cannot write {}; it keeps its kernels in a temporary folder", usual.empty() ? "(no HOME)" : usual.string());
}

bool pocl_aborts_on_broken_binaries(const std::string& platform) {
    return platform.find("Portable Computing Language") != std::string::npos;
}

double milliseconds_though_stamps_run_backwards(std::uint64_t start_ns, std::uint64_t end_ns) {
    return end_ns > start_ns ? static_cast<double>(end_ns - start_ns) * 1e-6 : 0;
}

bool oclgrind_knows_no_noalias_scopes(const std::string& platform) { return platform.find("Oclgrind") != std::string::npos; }

bool oclgrind_claims_every_device_type(const std::string& platform) { return platform.find("Oclgrind") != std::string::npos; }

bool oclgrind_ignores_line_directives(const std::string& platform) { return platform.find("Oclgrind") != std::string::npos; }

} // namespace clvr::quirks

#include "runtime/drivers/quirks.hpp"

#include "runtime/system/folders.hpp"
#include "runtime/system/temporary.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <unistd.h>

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

bool is_pocl(const std::string& platform) { return platform.find("Portable Computing Language") != std::string::npos; }

Temporary private_cache; // of this process, empty when the usual one serves

/// Why so many bytes cannot be written into the folder; empty: they can.
std::string why_no_room(const fs::path& folder, off_t bytes) {
    const Temporary file = Temporary::file_in(folder.string());
    if (file.path().empty()) return std::strerror(errno);
    const int fd = ::open(file.path().c_str(), O_WRONLY | O_CLOEXEC);
    const int why = fd < 0 ? errno : ::posix_fallocate(fd, 0, bytes); // counts against quotas and ulimit -f, too
    if (fd >= 0) ::close(fd);
    return why == 0 || why == EOPNOTSUPP || why == EINVAL ? "" : std::strerror(why);
}

} // namespace

bool pocl_hides_devices_without_writable_cache() {
    const fs::path usual = pocl_cache();
    if (!usual.empty() && writable_folder(usual)) return true;
    std::error_code failed;
    const std::string temporary = fs::temp_directory_path(failed).string();
    remove_stale_folders(temporary, "pocl");
    private_cache = Temporary::folder_in(temporary, "pocl");
    if (private_cache.path().empty()) return false;
    setenv("POCL_CACHE_DIR", private_cache.path().c_str(), 1);
    std::atexit([] { private_cache = Temporary(); });
    return true;
}

std::string pocl_cache_problem() {
    constexpr off_t largest_kernel = off_t{4} << 20; // [bytes], compiled
    const fs::path cache = pocl_cache();
    std::error_code none;
    if (cache.empty() || !fs::is_directory(cache, none)) return {};
    const std::string why = why_no_room(cache, largest_kernel);
    if (why.empty()) return {};
    return fmt::format("{}: the OpenCL driver's cache folder has no room for another kernel ({}); free some disk space, or set "
                       "POCL_CACHE_DIR to a folder on another disk",
                       cache.string(), why);
}

bool pocl_aborts_on_broken_binaries(const std::string& platform) { return is_pocl(platform); }

bool pocl_reads_a_header_of_all_builtins(const std::string& platform, const std::string& driver_version) {
    return is_pocl(platform) && driver_version.rfind("3.1", 0) == 0;
}

double milliseconds_though_stamps_run_backwards(std::uint64_t start_ns, std::uint64_t end_ns) {
    return end_ns > start_ns ? static_cast<double>(end_ns - start_ns) * 1e-6 : 0;
}

bool oclgrind_knows_no_noalias_scopes(const std::string& platform) { return platform.find("Oclgrind") != std::string::npos; }

bool oclgrind_claims_every_device_type(const std::string& platform) { return platform.find("Oclgrind") != std::string::npos; }

bool oclgrind_ignores_line_directives(const std::string& platform) { return platform.find("Oclgrind") != std::string::npos; }

} // namespace clvr::quirks

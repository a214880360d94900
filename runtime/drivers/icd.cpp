#include "runtime/drivers/icd.hpp"

#include "runtime/system/folders.hpp"

#include <fmt/format.h>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace clvr {
namespace fs = std::filesystem;
namespace {

std::string load_library(const std::string& library) {
    void* handle = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!handle) return fmt::format("cannot be loaded ({})", dlerror());
    const bool driver = dlsym(handle, "clIcdGetPlatformIDsKHR") || dlsym(handle, "clGetExtensionFunctionAddress");
    return driver ? "" : "is no OpenCL driver";
}

/// Empty when the library is a driver. Loaded in a child process: two drivers with an LLVM each (PoCL, Mesa) abort the process that loads
/// one of them a second time. A child that ends without a message is no evidence against the driver.
std::string why_no_driver(const std::string& library) {
    int ends[2];
    if (pipe(ends) != 0) return "";
    const pid_t child = fork();
    if (child == 0) {
        alarm(10); // a lock that another thread held at the fork
        if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) dup2(nowhere, STDERR_FILENO);
        const std::string why = load_library(library);
        const ssize_t written = write(ends[1], why.data(), why.size());
        _exit(written == static_cast<ssize_t>(why.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::string why;
    char piece[512];
    for (ssize_t n; child > 0 && (n = read(ends[0], piece, sizeof piece)) > 0;) why.append(piece, static_cast<std::size_t>(n));
    close(ends[0]);
    int status = 0;
    if (child > 0) waitpid(child, &status, 0);
    return why;
}

/// The first line of an .icd file names the library.
void look_at(const fs::path& icd, std::vector<std::string>& lines) {
    const auto text = load_file(icd);
    std::string library = text ? text->substr(0, text->find_first_of("\r\n")) : "";
    library.erase(library.find_last_not_of(" \t") + 1);
    if (library.empty()) {
        lines.push_back(fmt::format("{} names no library", icd.string()));
    } else if (const std::string why = why_no_driver(library); !why.empty()) {
        lines.push_back(fmt::format("{}, which {} names, {}", library, icd.string(), why));
    }
}

} // namespace

std::vector<std::string> unloadable_drivers() {
    const char* variable = std::getenv("OCL_ICD_VENDORS");
    const fs::path place = variable && *variable ? variable : "/etc/OpenCL/vendors";
    std::vector<std::string> lines;
    std::error_code failed;
    if (fs::is_directory(place, failed)) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(place, failed))
            if (entry.path().extension() == ".icd") files.push_back(entry.path());
        std::sort(files.begin(), files.end());
        for (const fs::path& file : files) look_at(file, lines);
    } else if (place.extension() == ".icd") {
        look_at(place, lines);
    } else if (const std::string why = why_no_driver(place.string()); !why.empty()) {
        lines.push_back(fmt::format("{} {}", place.string(), why));
    }
    return lines;
}

} // namespace clvr

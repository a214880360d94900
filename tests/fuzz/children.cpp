#include "tests/fuzz/children.hpp"
#include "runtime/system/atomic_file.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <pthread.h>
#include <sanitizer/common_interface_defs.h>
#include <sys/mman.h>
#include <unistd.h>

// The counters of clang's -fsanitize-coverage=inline-8bit-counters, which libFuzzer reads after each input.
extern "C" {
extern std::uint8_t __start___sancov_cntrs[] __attribute__((visibility("hidden")));
extern std::uint8_t __stop___sancov_cntrs[] __attribute__((visibility("hidden")));

/// Children put the signals' defaults back: not those that AddressSanitizer reports.
const char* __asan_default_options() { return "handle_segv=2:handle_sigbus=2:handle_sigfpe=2:handle_sigill=2:handle_abort=2"; }
}

namespace clvr::test {

namespace {

namespace fs = std::filesystem;

std::string reports; // the folder
std::string report;  // its files' names, without the process's number

/// Whole pages only: the first and the last page hold other data, too.
void share_counters() {
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto first = (reinterpret_cast<std::uintptr_t>(__start___sancov_cntrs) + page - 1) / page * page;
    const auto last = reinterpret_cast<std::uintptr_t>(__stop___sancov_cntrs) / page * page;
    if (first >= last) return;
    void* const at = reinterpret_cast<void*>(first);
    std::vector<std::uint8_t> counts(last - first);
    std::memcpy(counts.data(), at, counts.size());
    if (mmap(at, counts.size(), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != at)
        throw std::runtime_error("cannot share the counters of edges");
    std::memcpy(at, counts.data(), counts.size());
}

/// In a child: its standard error goes nowhere, and the parent is the one that saves libFuzzer's input.
void report_into_file() {
    __sanitizer_set_report_path(report.c_str());
    __sanitizer_set_death_callback(nullptr);
}

/// Whether the innermost frame that is clvr's or a library's is clvr's; else that frame is said. Of the C and C++ runtimes are functions
/// that either may call.
bool blames_clvr(const std::string& text) {
    static const std::regex own(R"( /\S*/(host|runtime|tests)/\S+:\d+)"), library(R"(/lib(?!c\.|m\.|stdc\+\+|pthread)[^/\s]*\.so)");
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        if (line.find("    #") != 0) continue;
        if (std::regex_search(line, own)) return true;
        if (!std::regex_search(line, library)) continue;
        std::fprintf(stderr, "a library's crash in a child: %s\n", line.c_str());
        return false;
    }
    return true;
}

} // namespace

void watch_children(const std::string& folder) {
    reports = folder;
    report = folder + "/report";
    share_counters();
    if (pthread_atfork(nullptr, nullptr, report_into_file) != 0) throw std::runtime_error("cannot watch children");
}

void end_at_childs_report() {
    for (const auto& file : fs::directory_iterator(reports)) {
        const std::string text = read_text(file.path().string());
        fs::remove(file.path());
        if (!blames_clvr(text)) continue;
        std::fputs(text.c_str(), stderr);
        std::abort();
    }
}

} // namespace clvr::test

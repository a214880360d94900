// `clvr selftest`: does this device compute what clvr's pictures rest on?
#include "host/cli/commands.hpp"

#include "host/selftest/selftest.hpp"
#include "runtime/choose/select.hpp"
#include "runtime/error.hpp"
#include "runtime/system/json_text.hpp"
#include "runtime/system/signals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <regex>

namespace clvr {
namespace {

struct SelftestOptions {
    std::string selector;
    std::vector<std::string> checks;
    bool json = false;
};

std::string device_text(const DeviceFacts& d) {
    const std::string part = d.sub_devices ? fmt::format(", part {} of {}", d.sub_device + 1, d.sub_devices) : "";
    return fmt::format("device {}: {}{} ({}, driver {})", d.index, d.name, part, d.platform, d.driver_version);
}

/// Hashes by their first digits, as people compare them.
std::string shortened(const std::string& text) {
    static const std::regex hash("\\b([0-9a-f]{12})[0-9a-f]{52}\\b");
    return std::regex_replace(text, hash, "$1");
}

void print_result(const selftest::Result& r) {
    const std::string expected = shortened(r.outcome.expected), found = shortened(r.outcome.found);
    fmt::print("{:<6} {} ({:.1f} s)\n", r.outcome.ok ? "ok" : "FAILED",
               r.outcome.ok && expected == found ? found : fmt::format("expected {}; found {}", expected, found), r.seconds);
    std::fflush(stdout);
}

nlohmann::json to_json(const DeviceFacts& d, const std::vector<selftest::Result>& results) {
    nlohmann::json list = nlohmann::json::array();
    for (const selftest::Result& r : results)
        list.push_back({{"name", r.check->name},
                        {"ok", r.outcome.ok},
                        {"expected", r.outcome.expected},
                        {"found", r.outcome.found},
                        {"seconds", r.seconds}});
    nlohmann::json device{{"index", d.index},
                          {"name", d.name},
                          {"platform", d.platform},
                          {"driver_version", d.driver_version},
                          {"ok", selftest::failed_names(results).empty()},
                          {"checks", list}};
    if (d.sub_devices) device.update({{"sub_device", d.sub_device}, {"sub_devices", d.sub_devices}});
    return device;
}

/// What runs now, in memory that outlives this process.
struct Running {
    char text[256];
};

/// Tests the selected devices and says what was found. Throws Error{device} when one of them cannot be trusted.
void test_devices(const SelftestOptions& o, const std::vector<const selftest::Check*>& wanted, Running& running) {
    const auto note = [&](const std::string& text) { std::snprintf(running.text, sizeof running.text, "%s", text.c_str()); };
    note("listing the devices");
    nlohmann::json devices = nlohmann::json::array();
    std::string failures;
    for (const DeviceFacts& facts : select_devices(o.selector).devices) {
        note("opening " + facts.name);
        if (!o.json) fmt::print("{}\n", device_text(facts));
        selftest::Listener listener;
        listener.starts = [&](const selftest::Check& check) {
            note(fmt::format("check \"{}\" on {}", check.name, facts.name));
            if (!o.json) fmt::print("  {:<15} {:<42} ", check.name, check.what);
            std::fflush(stdout);
        };
        if (!o.json) listener.ends = print_result;
        const auto results = run_checks(facts, wanted, listener);
        devices.push_back(to_json(facts, results));
        if (const std::string failed = failed_names(results); !failed.empty())
            failures += fmt::format("{}{} cannot be trusted, it fails: {}", failures.empty() ? "" : "; ", device_text(facts), failed);
    }
    note("closing");
    if (o.json) fmt::print("{}", json_text(nlohmann::json{{"devices", devices}}));
    std::fflush(stdout);
    if (!failures.empty()) throw Error(ErrorKind::device, failures + "; update its driver or choose another --device");
    if (!o.json) fmt::print("every check passed\n");
}

/// Some drivers end the process that loads them. So a child does the work; this process never calls OpenCL and says what the child was
/// doing.
void selftest_command(const SelftestOptions& o) {
    const auto wanted = selftest::chosen_checks(o.checks);
    void* memory = mmap(nullptr, sizeof(Running), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw Error(ErrorKind::host_memory, "no memory to share with a child process");
    Running& running = *static_cast<Running*>(memory);
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) throw Error(ErrorKind::host_memory, "no child process can be started");
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM); // ends with this process
        watch_signals("clvr");
        return test_devices(o, wanted, running);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    constexpr int by_llvm = 1; // LLVM's exit code where it gives up; none of clvr's
    if (WIFEXITED(status) && WEXITSTATUS(status) != by_llvm) std::_Exit(WEXITSTATUS(status)); // the child has said everything
    const std::string how = WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status)) : strsignal(WTERMSIG(status));
    throw Error(ErrorKind::device,
                fmt::format("the driver ended the program ({}) in: {}; update it or choose another --device", how, running.text));
}

} // namespace

void add_selftest_command(CLI::App& app) {
    const auto options = std::make_shared<SelftestOptions>();
    CLI::App* command = app.add_subcommand("selftest", "Check that a device computes what it should (exit code 4: it does not)");
    command->add_option("--device", options->selector, "An index, cpu, gpu, part of a name, cpu/2, several joined by +")
        ->type_name("SEL")
        ->group("Device");
    command->add_option("--check", options->checks, "Only these checks, joined by commas")
        ->delimiter(',')
        ->type_name("CHECK")
        ->group("Checks");
    command->add_flag("--json", options->json, "Print JSON")->group("Output");
    command->footer("Examples:\n"
                    "  clvr selftest\n"
                    "  clvr selftest --device gpu --check arithmetic\n");
    command->callback([options] { selftest_command(*options); });
}

} // namespace clvr

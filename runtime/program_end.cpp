#include "runtime/program_end.hpp"

#include "runtime/drivers/quirks.hpp"
#include "runtime/error.hpp"
#include "runtime/system/signals.hpp"
#include "runtime/system/standard_streams.hpp"
#include "runtime/system/temporary.hpp"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <system_error>

#include <unistd.h>

namespace clvr {
namespace {

std::string program;
pid_t process = 0;
bool ended = false; // in the usual way

/// For when a driver called exit() or abort().
[[noreturn]] void say_what_the_driver_did(const char* how) {
    const std::string cache = quirks::pocl_cache_problem();
    std::fflush(stdout);
    complain(program, cache.empty() ? std::string("the program was ") + how +
                                          ", most likely by the OpenCL driver; update it or choose another --device"
                                    : cache);
    remove_temporaries();
    ::_exit(exit_code(cache.empty() ? ErrorKind::device : ErrorKind::input));
}

void at_exit() {
    if (!ended && ::getpid() == process) say_what_the_driver_did("ended"); // a child tells its parent by its exit code
}

extern "C" void on_abort(int) {
    if (::getpid() == process) say_what_the_driver_did("aborted");
}

} // namespace

void complain(const std::string& name, const std::string& what) noexcept {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), what.c_str());
    std::fflush(stderr);
}

int run_program(const std::string& name, int (*body)(int argc, char** argv), int argc, char** argv) {
    program = name;
    process = ::getpid();
    prepare_standard_streams();
    quirks::pocl_hides_devices_without_writable_cache(); // sets a variable: watch_signals starts the first thread
    watch_signals(name);
    std::atexit(at_exit);
    struct sigaction action {};
    action.sa_handler = on_abort;
    action.sa_flags = SA_RESETHAND;
    sigaction(SIGABRT, &action, nullptr);

    int code = 0;
    const auto fail = [&](const std::string& what, ErrorKind kind) {
        complain(name, what);
        code = exit_code(kind);
    };
    const auto unprinted = [](const std::string& why) { return "standard output cannot be written: " + why; };
    try {
        code = body(argc, argv);
    } catch (const Error& error) {
        standard_output_problem(); // prints results first, in case both go to one terminal
        fail(error.line(), error.kind());
    } catch (const std::bad_alloc&) {
        fail("out of memory; try something smaller", ErrorKind::host_memory);
    } catch (const std::system_error& error) { // of {fmt}, which throws where it cannot print
        const std::string why = standard_output_problem();
        fail(why.empty() ? std::string("internal error: ") + error.what() : unprinted(error.code().message()),
             why.empty() ? ErrorKind::internal : ErrorKind::input);
    } catch (const std::exception& error) {
        fail(std::string("internal error: ") + error.what(), ErrorKind::internal);
    }
    const std::string why = standard_output_problem();
    if (code == 0 && !why.empty()) fail(unprinted(why), ErrorKind::input);
    ended = true;
    return code;
}

} // namespace clvr

#include "runtime/system/signals.hpp"

#include "runtime/system/temporary.hpp"

#include <csignal>
#include <system_error>
#include <thread>

#include <unistd.h>

namespace clvr {
namespace {

std::atomic<bool> interrupted{false}, polled{false};

[[noreturn]] void end_now(const std::string& program) {
    remove_temporaries();
    const std::string line = program + ": interrupted\n";
    [[maybe_unused]] const ssize_t said = ::write(STDERR_FILENO, line.data(), line.size());
    ::_exit(130);
}

/// A thread waits for the signals, as a signal handler must not call what is needed here.
[[noreturn]] void wait_for_signals(const sigset_t& signals, const std::string& program) {
    for (;;) {
        int signal = 0;
        if (sigwait(&signals, &signal) != 0) continue;
        if (polled && !interrupted.exchange(true)) continue;
        if (polled && signal == SIGHUP) continue;
        end_now(program);
    }
}

} // namespace

void watch_signals(const std::string& program) {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction found {};
        if (sigaction(signal, nullptr, &found) == 0 && found.sa_handler != SIG_IGN) sigaddset(&signals, signal);
    }
    pthread_sigmask(SIG_BLOCK, &signals, nullptr); // all threads that begin later inherit it
    try {
        std::thread([signals, program] { wait_for_signals(signals, program); }).detach();
    } catch (const std::system_error&) { // no thread can be started: the signals end the program in the usual way
        pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
    }
}

const std::atomic<bool>& catch_interrupts() {
    polled = true;
    return interrupted;
}

} // namespace clvr

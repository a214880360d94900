// Processes killed at random moments, the same ones in every run.
#pragma once
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <random>
#include <thread>

namespace clvr {

/// How many processes each test kills: CLVR_KILLS (tools/check_kills.sh), else a handful.
inline int kills() {
    const char* text = std::getenv("CLVR_KILLS");
    return text ? std::atoi(text) : 6;
}

/// A share of a process's usual life, uniform in 0 .. 1.1.
inline double moment(int kill) {
    std::mt19937 random(20261127u + static_cast<unsigned>(kill));
    return std::uniform_real_distribution<double>(0, 1.1)(random);
}

/// Kills the process so long after now, unless it has ended by itself; waits for it. Whether it was killed.
inline bool kill_after(pid_t process, double seconds) {
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
    kill(process, SIGKILL);
    int status = 0;
    waitpid(process, &status, 0);
    return WIFSIGNALED(status);
}

} // namespace clvr

#include "tools/bench/child.hpp"

#include "runtime/error.hpp"
#include "tools/bench/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace clvr::bench {

void Child::start() {
    std::signal(SIGPIPE, SIG_IGN); // a child that is gone is noticed by its answer
    int request[2], answer[2];
    if (pipe2(request, O_CLOEXEC) != 0) throw Error(ErrorKind::internal, fmt::format("no pipe: {}", std::strerror(errno)));
    if (pipe2(answer, O_CLOEXEC) != 0) {
        close(request[0]), close(request[1]);
        throw Error(ErrorKind::internal, fmt::format("no pipe: {}", std::strerror(errno)));
    }
    std::vector<char*> argv;
    for (std::string& argument : command_) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t parent = getpid();
    pid_ = fork();
    if (pid_ == 0) {
        prctl(PR_SET_PDEATHSIG, SIGKILL); // no driver goes on computing for a parent that is gone
        if (getppid() != parent) _exit(127);
        dup2(request[0], STDIN_FILENO);
        dup2(answer[1], STDOUT_FILENO);
        std::signal(SIGPIPE, SIG_DFL);
        execvp(argv[0], argv.data());
        _exit(127);
    }
    close(request[0]), close(answer[1]);
    to_ = request[1], from_ = answer[0];
    rest_.clear();
    ++starts_;
    if (pid_ < 0) {
        end();
        throw Error(ErrorKind::internal, fmt::format("no child process: {}", std::strerror(errno)));
    }
}

std::string Child::end() {
    for (int* fd : {&to_, &from_}) {
        if (*fd >= 0) close(*fd);
        *fd = -1;
    }
    if (pid_ <= 0) return {};
    int status = 0;
    pid_t ended = 0;
    for (int k = 0; k < 20 && ended == 0; ++k) { // it may be about to end by itself
        ended = waitpid(pid_, &status, WNOHANG);
        if (ended == 0) usleep(10000);
    }
    if (ended == 0) {
        kill(pid_, SIGKILL);
        waitpid(pid_, &status, 0);
    }
    pid_ = -1;
    if (ended == 0) return {};
    if (WIFSIGNALED(status)) return fmt::format("crashed ({})", strsignal(WTERMSIG(status)));
    return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

Answer Child::ask(const std::string& line, double limit_seconds) {
    if (pid_ <= 0) start();
    const std::string request = line + "\n";
    for (std::size_t sent = 0; sent < request.size();) {
        const ssize_t n = write(to_, request.data() + sent, request.size() - sent);
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break; // it is gone, which reading says
        sent += static_cast<std::size_t>(n);
    }
    const double deadline = steady_seconds() + limit_seconds;
    for (;;) {
        if (const std::size_t at = rest_.find('\n'); at != std::string::npos) {
            Answer answer{true, rest_.substr(0, at), {}};
            rest_.erase(0, at + 1);
            return answer;
        }
        const double left = deadline - steady_seconds();
        pollfd waiting{from_, POLLIN, 0};
        const int ready = left > 0 ? poll(&waiting, 1, static_cast<int>(std::min(left * 1000 + 1, 1e9))) : 0;
        if (ready < 0 && errno == EINTR) continue;
        if (ready == 0) {
            kill(pid_, SIGKILL);
            end();
            return {false, {}, fmt::format("gave no answer within {:.0f} s", limit_seconds)};
        }
        char block[4096];
        const ssize_t n = read(from_, block, sizeof block);
        if (n < 0 && errno == EINTR) continue;
        if (n > 0) {
            rest_.append(block, static_cast<std::size_t>(n));
            continue;
        }
        const std::string how = end();
        return {false, {}, how.empty() ? "closed its output" : how};
    }
}

} // namespace clvr::bench

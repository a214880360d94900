#include "runtime/system/standard_streams.hpp"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>

#include <fcntl.h>
#include <unistd.h>

namespace clvr {

void prepare_standard_streams() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF) {
            // Standard output is opened for reading only: writing fails, so that lost results are noticed.
            [[maybe_unused]] const int opened = ::open("/dev/null", fd == STDOUT_FILENO ? O_RDONLY : O_RDWR);
        }
}

std::string standard_output_problem() {
    const bool failed_before = std::ferror(stdout) || !std::cout;
    errno = 0;
    std::cout.flush();
    if (std::fflush(stdout) == 0 && std::cout && !failed_before) return {};
    if (errno == 0 && failed_before) { // the failed output is lost: write once more to learn the reason
        std::clearerr(stdout);
        if (std::fputc('\n', stdout) != EOF && std::fflush(stdout) == 0) return "some of it is lost";
    }
    return errno == EBADF ? "it is closed" : errno == 0 ? "some of it is lost" : std::strerror(errno);
}

} // namespace clvr

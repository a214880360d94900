#include "host/io/volume/decoding_child.hpp"
#include "runtime/error.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace clvr {

namespace {

/// The kind of a message of the child; its bytes follow. The bytes of an error are its text.
enum class Kind : std::uint32_t { data, input_error, memory_error, end };
struct Message {
    Kind kind;
    std::uint32_t bytes;
};

void write_all(int pipe, const void* from, std::size_t bytes) {
    for (const char* at = static_cast<const char*>(from); bytes > 0;) {
        const ssize_t n = write(pipe, at, bytes);
        if (n < 0 && errno != EINTR) _exit(1);
        if (n > 0) at += n, bytes -= static_cast<std::size_t>(n);
    }
}

void send(int pipe, Kind kind, const void* from, std::size_t bytes) {
    constexpr std::size_t most = std::size_t{1} << 30;
    do {
        const Message message{kind, static_cast<std::uint32_t>(std::min(bytes, most))};
        write_all(pipe, &message, sizeof message);
        write_all(pipe, from, message.bytes);
        from = static_cast<const char*>(from) + message.bytes;
        bytes -= message.bytes;
    } while (bytes > 0);
}

/// For the child: no core dump, no output on the terminal, no more memory than given. Ctrl-C and a closing terminal are left to the parent.
void confine(std::size_t memory_bytes) {
    for (const int signal : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGPIPE, SIGTERM}) std::signal(signal, SIG_DFL);
    for (const int signal : {SIGINT, SIGHUP}) std::signal(signal, SIG_IGN);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    std::size_t pages = 0;
    rlimit address_space{};
    if (std::ifstream("/proc/self/statm") >> pages && getrlimit(RLIMIT_AS, &address_space) == 0) {
        const rlim_t wanted = pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + memory_bytes;
        address_space.rlim_cur = std::min<rlim_t>(wanted, address_space.rlim_cur);
        setrlimit(RLIMIT_AS, &address_space);
    }
}

[[noreturn]] void run(int pipe, std::size_t memory_bytes, const std::function<void(const DecodingChild::Send&)>& work) {
    confine(memory_bytes);
    try {
        work([&](const void* from, std::size_t bytes) {
            if (bytes > 0) send(pipe, Kind::data, from, bytes);
        });
        send(pipe, Kind::end, nullptr, 0);
    } catch (const Error& e) {
        const std::string text = e.what();
        send(pipe, e.kind() == ErrorKind::host_memory ? Kind::memory_error : Kind::input_error, text.data(), text.size());
    } catch (const std::bad_alloc&) {
        const std::string text = "not enough memory for this volume";
        send(pipe, Kind::memory_error, text.data(), text.size());
    } catch (...) {
        _exit(1);
    }
    _exit(0);
}

} // namespace

DecodingChild::DecodingChild(std::string file, std::string library, std::size_t memory_bytes,
                             const std::function<void(const Send& send)>& work)
    : file_(std::move(file)), library_(std::move(library)) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error(ErrorKind::internal, fmt::format("no pipe: {}", std::strerror(errno)), file_);
    child_ = fork();
    if (child_ == 0) {
        close(ends[0]);
        run(ends[1], memory_bytes, work);
    }
    close(ends[1]);
    pipe_ = ends[0];
    if (child_ < 0) {
        const int reason = errno;
        close(pipe_);
        throw Error(ErrorKind::internal, fmt::format("no process: {}", std::strerror(reason)), file_);
    }
}

DecodingChild::~DecodingChild() {
    close(pipe_);
    kill(child_, SIGKILL);
    while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

void DecodingChild::failed(const char* how) const {
    throw Error(ErrorKind::input, fmt::format("{} {} it: the file is damaged", library_, how), file_);
}

/// False where the pipe ends before.
bool DecodingChild::fill(void* to, std::size_t bytes) {
    constexpr int patience_ms = 60000;
    for (auto* at = static_cast<char*>(to); bytes > 0;) {
        pollfd ready{pipe_, POLLIN, 0};
        const int events = poll(&ready, 1, patience_ms);
        if (events == 0) failed("needs more than 60 seconds for");
        const ssize_t n = events > 0 ? ::read(pipe_, at, bytes) : -1;
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        at += n, bytes -= static_cast<std::size_t>(n);
    }
    return true;
}

std::size_t DecodingChild::read(void* to, std::size_t bytes) {
    std::size_t done = 0;
    while (done < bytes && !ended_) {
        if (left_ == 0) {
            Message message{};
            if (!fill(&message, sizeof message)) failed("crashes on");
            if (message.kind == Kind::end) {
                ended_ = true;
            } else if (message.kind == Kind::data) {
                left_ = message.bytes;
            } else {
                constexpr std::size_t longest = std::size_t{1} << 20;
                std::string text(std::min<std::size_t>(message.bytes, longest), '\0');
                if (!fill(text.data(), text.size())) failed("crashes on");
                throw Error(message.kind == Kind::memory_error ? ErrorKind::host_memory : ErrorKind::input, text, file_);
            }
            continue;
        }
        const std::size_t n = std::min(left_, bytes - done);
        if (!fill(static_cast<char*>(to) + done, n)) failed("crashes on");
        left_ -= n;
        done += n;
    }
    return done;
}

} // namespace clvr

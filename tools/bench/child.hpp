// A child process that answers one line with one line. What may crash or hang a driver happens in it.
#pragma once
#include <string>
#include <sys/types.h>
#include <vector>

namespace clvr::bench {

struct Answer {
    bool ok = false;
    std::string text; ///< the line
    std::string why;  ///< where not ok: "crashed (Segmentation fault)", "gave no answer within 20 s", "ended with exit code 3"
};

/// Starts the command when it is first asked, and again after it crashed or was ended for its silence.
class Child {
public:
    explicit Child(std::vector<std::string> command) : command_(std::move(command)) {}
    ~Child() { end(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Sends a line (no line break within) and waits for the answer, at most so long; then the child is killed.
    Answer ask(const std::string& line, double limit_seconds);
    /// How often the command was started.
    int starts() const { return starts_; }

private:
    std::vector<std::string> command_;
    pid_t pid_ = -1;
    int to_ = -1, from_ = -1, starts_ = 0;
    std::string rest_; // read beyond the last line

    void start();
    /// Kills it if it runs; how it had ended by itself, in words, else empty.
    std::string end();
};

} // namespace clvr::bench

// Runs the `clvr` program as a user would, in a child process.
#pragma once
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

struct Outcome {
    int exit_code = -1; ///< -1: ended by a signal
    std::string out, err;
};

/// Environment changes of the child: set, or unset where there is no value.
using Environment = std::map<std::string, std::optional<std::string>>;

/// A program on its way.
class Child {
public:
    /// `prepare` is called in the child before the program begins: to close or redirect streams, set limits, ignore signals.
    Child(const std::vector<std::string>& arguments, const Environment& environment, const std::filesystem::path& folder,
          const std::function<void()>& prepare = {})
        : out_(folder / ("out" + std::to_string(count()))), err_(out_.string() + ".err") {
        std::vector<char*> argv{const_cast<char*>(CLVR_PROGRAM)};
        for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
        argv.push_back(nullptr);
        pid_ = fork();
        if (pid_ != 0) return;
        for (const auto& [name, value] : environment) value ? setenv(name.c_str(), value->c_str(), 1) : unsetenv(name.c_str());
        const int out = open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600),
                  err = open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
        if (out < 0 || err < 0 || dup2(out, 1) < 0 || dup2(err, 2) < 0) _exit(99);
        close(out), close(err);
        if (prepare) prepare();
        execv(CLVR_PROGRAM, argv.data());
        _exit(99);
    }
    Outcome wait() {
        int status = 0;
        waitpid(pid_, &status, 0);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(out_), text(err_)};
    }
    pid_t pid() const { return pid_; }
    /// What it has written so far.
    std::string out() const { return text(out_); }
    std::string err() const { return text(err_); }

private:
    std::filesystem::path out_, err_;
    pid_t pid_ = -1;

    static int count() {
        static int n = 0;
        return n++;
    }
    static std::string text(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
};

} // namespace clvr

// The one error type of clvr: thrown inside, caught once in main().
#pragma once
#include <stdexcept>
#include <string>

namespace clvr {

/// What went wrong (host/README.md, "Errors"). device_memory: another device may have more; host_memory: nothing but a smaller task helps.
enum class ErrorKind { usage, input, device, device_memory, host_memory, internal, interrupted };

/// The program's exit code for it.
constexpr int exit_code(ErrorKind kind) {
    switch (kind) {
    case ErrorKind::usage:
        return 2;
    case ErrorKind::input:
        return 3;
    case ErrorKind::device:
        return 4;
    case ErrorKind::device_memory:
    case ErrorKind::host_memory:
        return 5;
    case ErrorKind::internal:
        return 6;
    case ErrorKind::interrupted:
        return 130;
    }
    return 6;
}

/// One line that says what was wrong, what was expected and what to try; `where` names the file, option, device or OpenCL call (may be
/// empty).
class Error : public std::runtime_error {
public:
    Error(ErrorKind kind, const std::string& what, std::string where = {})
        : std::runtime_error(what), kind_(kind), where_(std::move(where)) {}
    ErrorKind kind() const { return kind_; }
    int exit_code() const { return clvr::exit_code(kind_); }
    const std::string& where() const { return where_; }
    /// "where: what", or "what" when there is no where. Of input and usage it is one line: control characters, which a file's own words
    /// may hold, become blanks. Others keep their lines: a compiler's log has many.
    std::string line() const {
        std::string text = where_.empty() ? what() : where_ + ": " + what();
        if (kind_ != ErrorKind::input && kind_ != ErrorKind::usage) return text;
        for (char& c : text)
            if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
        return text;
    }

private:
    ErrorKind kind_;
    std::string where_;
};

} // namespace clvr

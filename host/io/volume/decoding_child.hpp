// Decoding in a process of its own, for libraries that damaged files may bring down.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <sys/types.h>

namespace clvr {

/// A child process whose work sends bytes to this one. There the library that decodes can crash, hang or ask for all memory: here that is
/// an Error. An Error that the work throws is thrown here by `read`.
class DecodingChild {
public:
    using Send = std::function<void(const void* from, std::size_t bytes)>;

    /// Starts the work. `file` is named where it fails, `library` is what decodes. The child may use `memory_bytes` beyond what the process
    /// uses at the start.
    DecodingChild(std::string file, std::string library, std::size_t memory_bytes, const std::function<void(const Send& send)>& work);
    ~DecodingChild();
    DecodingChild(const DecodingChild&) = delete;
    DecodingChild& operator=(const DecodingChild&) = delete;

    /// Stores the next bytes at `to`; fewer only where the work has ended well. Throws the work's Error, or Error{input} where the child
    /// crashed or said nothing for 60 seconds.
    std::size_t read(void* to, std::size_t bytes);

private:
    bool fill(void* to, std::size_t bytes);
    [[noreturn]] void failed(const char* how) const;

    std::string file_, library_;
    pid_t child_ = -1;
    int pipe_ = -1;
    std::size_t left_ = 0; ///< bytes of the current message that were not read yet
    bool ended_ = false;
};

} // namespace clvr

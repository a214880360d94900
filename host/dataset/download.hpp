// Files from the web, whole or not at all.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace clvr {

struct Download {
    std::string url;         ///< http or https
    std::string path;        ///< where the whole file is to lie
    std::uint64_t bytes = 0; ///< its size
    std::string sha512;      ///< hexadecimal; empty: only the size is checked
    int attempts = 5;        ///< for troubles that may pass: broken connections, busy servers
    double pause = 1;        ///< before the second attempt [s], twice as long before each further one
};

/// Fetches the file with libcurl into path + ".part", continuing a part that an earlier call left there. Only a file of the right size and
/// checksum gets its name. Follows redirections, honours the proxy settings of the environment. Asks nobody when the right file is there
/// already. `progress` gets the number of bytes that are there. Throws Error{input}: what the server answered, a wrong size or checksum
/// (the damaged part is removed), an existing file of other content; Error{interrupted}.
void download(const Download& what, const std::function<void(std::uint64_t)>& progress = {}, const std::atomic<bool>* cancelled = nullptr);

/// The files that a download to `path` writes: itself last.
std::vector<std::string> download_files(const std::string& path);

} // namespace clvr

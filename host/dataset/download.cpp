#include "host/dataset/download.hpp"
#include "runtime/error.hpp"
#include "runtime/system/hashes.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <curl/curl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <thread>

namespace clvr {
namespace fs = std::filesystem;

namespace {

std::string sha512_of(const std::string& path) {
    Hash hash(Hash::Kind::sha512);
    std::ifstream in(path, std::ios::binary);
    std::array<char, 1 << 16> piece;
    while (in) {
        in.read(piece.data(), piece.size());
        hash.add(piece.data(), static_cast<std::size_t>(in.gcount()));
    }
    return hash.hex();
}

std::uint64_t size_of(const std::string& path) {
    std::error_code failed;
    const auto size = fs::file_size(path, failed);
    return failed ? 0 : size;
}

/// What a transfer writes to, and why it stopped.
struct Sink {
    std::FILE* file;
    std::uint64_t there, expected;
    const std::function<void(std::uint64_t)>* progress;
    const std::atomic<bool>* cancelled;
    bool too_long = false, full = false;

    static std::size_t take(char* bytes, std::size_t size, std::size_t count, void* self) {
        Sink& sink = *static_cast<Sink*>(self);
        const std::size_t n = size * count;
        if (sink.cancelled && *sink.cancelled) return 0;
        if (sink.there + n > sink.expected) {
            sink.too_long = true;
            return 0;
        }
        if (std::fwrite(bytes, 1, n, sink.file) != n) {
            sink.full = true;
            return 0;
        }
        sink.there += n;
        if (*sink.progress) (*sink.progress)(sink.there);
        return n;
    }
    static int watch(void* self, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
        const Sink& sink = *static_cast<const Sink*>(self);
        return sink.cancelled && *sink.cancelled;
    }
};

/// Whether the next attempt may go better.
bool may_pass(CURLcode code, long answer) {
    switch (code) {
    case CURLE_COULDNT_CONNECT:
    case CURLE_COULDNT_RESOLVE_HOST:
    case CURLE_OPERATION_TIMEDOUT:
    case CURLE_PARTIAL_FILE:
    case CURLE_RECV_ERROR:
    case CURLE_SEND_ERROR:
    case CURLE_GOT_NOTHING:
    case CURLE_SSL_CONNECT_ERROR:
    case CURLE_HTTP2_STREAM:
        return true;
    case CURLE_HTTP_RETURNED_ERROR:
        return answer == 408 || answer == 429 || answer >= 500;
    default:
        return false;
    }
}

/// One transfer that appends to the part. Returns whether to try again; throws when another try cannot help.
bool transfer(const Download& what, const std::string& part, const std::function<void(std::uint64_t)>& progress,
              const std::atomic<bool>* cancelled, std::string& why) {
    const std::uint64_t begin = size_of(part);
    const std::unique_ptr<CURL, void (*)(CURL*)> curl(curl_easy_init(), curl_easy_cleanup);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(part.c_str(), "ab"), std::fclose);
    if (!curl) throw Error(ErrorKind::internal, "libcurl cannot start");
    if (!file) throw Error(ErrorKind::input, "cannot be written", part);
    Sink sink{file.get(), begin, what.bytes, &progress, cancelled};
    char message[CURL_ERROR_SIZE] = "";
    CURL* c = curl.get();
    curl_easy_setopt(c, CURLOPT_URL, what.url.c_str());
    curl_easy_setopt(c, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(c, CURLOPT_REDIR_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(c, CURLOPT_FOLLOWLOCATION, 1L);
    curl_easy_setopt(c, CURLOPT_MAXREDIRS, 10L);
    curl_easy_setopt(c, CURLOPT_FAILONERROR, 1L);
    curl_easy_setopt(c, CURLOPT_CONNECTTIMEOUT, 30L);
    curl_easy_setopt(c, CURLOPT_LOW_SPEED_LIMIT, 100L); // [bytes a second] over a minute: the connection is dead
    curl_easy_setopt(c, CURLOPT_LOW_SPEED_TIME, 60L);
    curl_easy_setopt(c, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(c, CURLOPT_USERAGENT, "clvr");
    curl_easy_setopt(c, CURLOPT_RESUME_FROM_LARGE, static_cast<curl_off_t>(begin));
    curl_easy_setopt(c, CURLOPT_WRITEFUNCTION, Sink::take);
    curl_easy_setopt(c, CURLOPT_WRITEDATA, &sink);
    curl_easy_setopt(c, CURLOPT_XFERINFOFUNCTION, Sink::watch);
    curl_easy_setopt(c, CURLOPT_XFERINFODATA, &sink);
    curl_easy_setopt(c, CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(c, CURLOPT_ERRORBUFFER, message);
    const CURLcode code = curl_easy_perform(c);
    long answer = 0;
    curl_easy_getinfo(c, CURLINFO_RESPONSE_CODE, &answer);
    if (cancelled && *cancelled) throw Error(ErrorKind::interrupted, "interrupted; the same command goes on from here", what.url);
    if (sink.full) throw Error(ErrorKind::input, "cannot be written; is the disk full?", part);
    if (sink.too_long) {
        fs::remove(part);
        throw Error(ErrorKind::input, fmt::format("sends more than the {} bytes expected", what.bytes), what.url);
    }
    if (code == CURLE_OK) {
        why = fmt::format("sent {} of {} bytes", sink.there, what.bytes);
        return sink.there < what.bytes;
    }
    // A server that knows no ranges, or whose file is shorter than our part: from the beginning.
    if (begin > 0 && (code == CURLE_RANGE_ERROR || code == CURLE_BAD_DOWNLOAD_RESUME || answer == 416)) {
        fs::remove(part);
        why = "cannot continue a part";
        return true;
    }
    why = code == CURLE_HTTP_RETURNED_ERROR ? fmt::format("answers {}", answer) : message[0] ? message : curl_easy_strerror(code);
    if (!may_pass(code, answer)) throw Error(ErrorKind::input, why, what.url);
    return true;
}

} // namespace

std::vector<std::string> download_files(const std::string& path) { return {path + ".part", path}; }

void download(const Download& what, const std::function<void(std::uint64_t)>& progress, const std::atomic<bool>* cancelled) {
    static const CURLcode started = curl_global_init(CURL_GLOBAL_DEFAULT);
    if (started != CURLE_OK) throw Error(ErrorKind::internal, "libcurl cannot start");
    const auto right = [&](const std::string& path) {
        return size_of(path) == what.bytes && (what.sha512.empty() || sha512_of(path) == what.sha512);
    };
    if (fs::exists(what.path)) {
        if (right(what.path)) return;
        throw Error(ErrorKind::input, "is there already, with other content; remove it, or name another --dir", what.path);
    }
    const std::string part = download_files(what.path).front();
    if (size_of(part) > what.bytes) fs::remove(part);
    double pause = what.pause;
    std::string why;
    for (int attempt = 1; size_of(part) < what.bytes && transfer(what, part, progress, cancelled, why); ++attempt) {
        if (attempt >= what.attempts)
            throw Error(ErrorKind::input, fmt::format("{} attempts failed; at last: {}. The same command goes on from here", attempt, why),
                        what.url);
        for (double left = pause; left > 0 && !(cancelled && *cancelled); left -= 0.1)
            std::this_thread::sleep_for(std::chrono::duration<double>(std::min(left, 0.1)));
        pause *= 2;
    }
    if (!right(part)) {
        const std::uint64_t got = size_of(part);
        fs::remove(part);
        throw Error(ErrorKind::input,
                    got != what.bytes
                        ? fmt::format("has {} bytes; expected {}", got, what.bytes)
                        : "does not have the expected checksum (SHA-512); the server's file has changed, or the transfer was damaged",
                    what.url);
    }
    fs::rename(part, what.path);
}

} // namespace clvr

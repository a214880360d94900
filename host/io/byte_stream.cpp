#include "host/io/byte_stream.hpp"
#include "host/io/file_roles.hpp"
#include "runtime/error.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <unistd.h>
#include <vector>
#include <zlib.h>

namespace clvr {

namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 22;
constexpr std::uint64_t deflate_ratio = 1032; // the greatest that the format allows

[[noreturn]] void unreadable(const std::string& path) {
    throw Error(ErrorKind::input, fmt::format("cannot be read: {}", std::strerror(errno)), path);
}

std::unique_ptr<std::FILE, int (*)(std::FILE*)> open_file(const std::string& path) {
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) unreadable(path);
    return file;
}

} // namespace

struct ByteStream::Inflater {
    z_stream z{};
    std::array<unsigned char, 1 << 16> input;
    bool ended = false;

    Inflater() {
        if (inflateInit2(&z, 15 + 32) != Z_OK)
            throw Error(ErrorKind::host_memory, "zlib cannot start"); // 15 + 32: gzip or zlib, by its header
    }
    ~Inflater() { inflateEnd(&z); }
};

ByteStream::ByteStream(const std::string& path, Coding coding, std::uint64_t offset) : path_(path), file_(open_file(path)) {
    will_read(path);
    const std::uint64_t size = std::filesystem::file_size(path);
    capacity_ = size > offset ? size - offset : 0;
    if (std::fseek(file_.get(), static_cast<long>(std::min(offset, size)), SEEK_SET) != 0) unreadable(path);
    if (coding == Coding::deflated) {
        inflater_ = std::make_unique<Inflater>();
        capacity_ *= deflate_ratio;
    }
}

ByteStream::~ByteStream() = default;

/// A large part of the file, by all cores: one of them copies 834 MB from the system's cache in 0.25 s.
std::size_t ByteStream::read_at_once(void* to, std::size_t bytes) {
    const long at = std::ftell(file_.get());
    if (at < 0) return 0;
    std::vector<std::size_t> got((bytes + piece_bytes - 1) / piece_bytes);
    for_each_index(got.size(), [&](std::size_t piece) {
        const std::size_t first = piece * piece_bytes, wanted = std::min(piece_bytes, bytes - first);
        while (got[piece] < wanted) {
            const std::size_t done = first + got[piece];
            const ssize_t n =
                ::pread(::fileno(file_.get()), static_cast<unsigned char*>(to) + done, wanted - got[piece], at + static_cast<off_t>(done));
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) break; // read_file says why
            got[piece] += static_cast<std::size_t>(n);
        }
    });
    std::size_t n = 0;
    for (std::size_t piece = 0; piece < got.size(); ++piece) {
        n += got[piece];
        if (got[piece] < piece_bytes) break;
    }
    if (std::fseek(file_.get(), at + static_cast<long>(n), SEEK_SET) != 0) unreadable(path_);
    return n;
}

std::size_t ByteStream::read_file(void* to, std::size_t bytes) {
    if (bytes > 2 * piece_bytes)
        if (const std::size_t n = read_at_once(to, bytes); n > 0) return n;
    const std::size_t n = std::fread(to, 1, bytes, file_.get());
    if (n < bytes && std::ferror(file_.get())) unreadable(path_);
    return n;
}

std::size_t ByteStream::inflate_some(void* to, std::size_t bytes) {
    Inflater& in = *inflater_;
    in.z.next_out = static_cast<unsigned char*>(to);
    in.z.avail_out = static_cast<unsigned>(std::min<std::size_t>(bytes, 1u << 30));
    const std::size_t wanted = in.z.avail_out;
    while (in.z.avail_out > 0 && !in.ended) {
        if (in.z.avail_in == 0) {
            in.z.next_in = in.input.data();
            in.z.avail_in = static_cast<unsigned>(read_file(in.input.data(), in.input.size()));
            if (in.z.avail_in == 0)
                throw Error(ErrorKind::input, "the compressed data ends too early: the file is truncated, copy it again", path_);
        }
        const int status = inflate(&in.z, Z_NO_FLUSH);
        if (status == Z_STREAM_END) {
            // A gzip file may hold several members in a row; anything else after the end is not data.
            if (in.z.avail_in < 2) {
                std::memmove(in.input.data(), in.z.next_in, in.z.avail_in);
                in.z.next_in = in.input.data();
                in.z.avail_in += static_cast<unsigned>(read_file(in.input.data() + in.z.avail_in, in.input.size() - in.z.avail_in));
            }
            in.ended = !(in.z.avail_in >= 2 && in.z.next_in[0] == 0x1f && in.z.next_in[1] == 0x8b);
            if (!in.ended) inflateReset(&in.z);
        } else if (status != Z_OK && status != Z_BUF_ERROR) {
            throw Error(ErrorKind::input,
                        fmt::format("the compressed data is corrupt ({}): copy or download the file again", in.z.msg ? in.z.msg : "zlib"),
                        path_);
        }
    }
    return wanted - in.z.avail_out;
}

std::size_t ByteStream::read(void* to, std::size_t bytes) {
    std::size_t done = 0;
    while (done < bytes) {
        auto* at = static_cast<unsigned char*>(to) + done;
        const std::size_t n = inflater_ ? inflate_some(at, bytes - done) : read_file(at, bytes - done);
        if (n == 0) break;
        done += n;
    }
    position_ += done;
    return done;
}

std::uint64_t ByteStream::skip(std::uint64_t bytes) {
    if (!inflater_) {
        const std::uint64_t n = std::min(bytes, capacity_ - position_);
        if (std::fseek(file_.get(), static_cast<long>(n), SEEK_CUR) != 0) unreadable(path_);
        position_ += n;
        return n;
    }
    std::vector<unsigned char> scratch(1 << 16);
    std::uint64_t done = 0;
    while (done < bytes) {
        const std::size_t n = read(scratch.data(), static_cast<std::size_t>(std::min<std::uint64_t>(scratch.size(), bytes - done)));
        if (n == 0) break;
        done += n;
    }
    return done;
}

std::uint64_t ByteStream::drain() { return skip(UINT64_MAX); }

bool is_gzip(const std::string& path) {
    const std::string head = read_head(path, 2);
    return head == "\x1f\x8b";
}

ByteStream open_inside(const std::string& path) {
    return ByteStream(path, is_gzip(path) ? ByteStream::Coding::deflated : ByteStream::Coding::plain);
}

std::string read_head(const std::string& path, std::size_t limit) {
    const auto file = open_file(path); // no ByteStream, as that declares an input: looking at a file's head is no use of it yet
    std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(limit, std::filesystem::file_size(path))), '\0');
    head.resize(std::fread(head.data(), 1, head.size(), file.get()));
    if (std::ferror(file.get())) unreadable(path);
    return head;
}

std::string read_head_inside(const std::string& path, std::size_t limit) {
    if (!is_gzip(path)) return read_head(path, limit);
    ByteStream stream(path, ByteStream::Coding::deflated);
    std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(limit, stream.capacity())), '\0');
    head.resize(stream.read(head.data(), head.size()));
    return head;
}

} // namespace clvr

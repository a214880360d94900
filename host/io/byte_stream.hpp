// A file's bytes in order, decompressed on the way, with every checksum checked.
#pragma once
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

namespace clvr {

/// Reads forward from an offset of a file: the plain bytes, or what gzip members or one zlib stream decode to. Damage and a missing end
/// throw Error{input} naming the file; for compressed data this is certain only after `drain`, which reads up to the checksum.
class ByteStream {
public:
    enum class Coding { plain, deflated };

    ByteStream(const std::string& path, Coding coding, std::uint64_t offset = 0);
    ~ByteStream();
    ByteStream(const ByteStream&) = delete;
    ByteStream& operator=(const ByteStream&) = delete;

    /// Reads up to `bytes` bytes; fewer only where the data ends.
    std::size_t read(void* to, std::size_t bytes);
    /// Decodes to the end, checksum included; returns how many bytes there were.
    std::uint64_t drain();
    /// Skips `bytes` bytes; returns how many there were to skip.
    std::uint64_t skip(std::uint64_t bytes);
    /// Bytes handed out or skipped so far.
    std::uint64_t position() const { return position_; }
    /// The most bytes that the whole stream can hold: known before any allocation (deflate packs at most 1032 to 1).
    std::uint64_t capacity() const { return capacity_; }

private:
    struct Inflater;
    std::size_t inflate_some(void* to, std::size_t bytes);
    std::size_t read_file(void* to, std::size_t bytes);
    std::size_t read_at_once(void* to, std::size_t bytes);

    std::string path_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    std::unique_ptr<Inflater> inflater_; ///< empty for plain bytes
    std::uint64_t position_ = 0, capacity_ = 0;
};

/// Whether the file starts as a gzip file does.
bool is_gzip(const std::string& path);
/// A file from its start: what gzip packs where it is a gzip file, else its plain bytes.
ByteStream open_inside(const std::string& path);
/// The first bytes of a file, at most `limit`. Throws Error{input}.
std::string read_head(const std::string& path, std::size_t limit);
/// The first bytes of what open_inside reads.
std::string read_head_inside(const std::string& path, std::size_t limit);

} // namespace clvr

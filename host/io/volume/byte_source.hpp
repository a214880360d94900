// Sources of bytes, read from front to back: the readers of formats with a text header are composed of them.
#pragma once
#include "host/io/byte_stream.hpp"
#include "host/io/volume/samples.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace clvr {

class ByteSource {
public:
    ByteSource() = default;
    virtual ~ByteSource() = default;
    ByteSource(const ByteSource&) = delete;
    ByteSource& operator=(const ByteSource&) = delete;
    /// Stores up to `bytes` bytes at `to` and returns how many; fewer only where the data ends. Throws Error{input} for damage.
    virtual std::size_t read(void* to, std::size_t bytes) = 0;
    /// Passes over up to `bytes` bytes; returns how many there were.
    virtual std::uint64_t skip(std::uint64_t bytes);
};

/// As read_samples of a stream.
void read_samples(ByteSource& from, SampleType type, bool swapped, Voxels& v);

/// A file from an offset on, as ByteStream reads it.
class FileBytes final : public ByteSource {
public:
    FileBytes(const std::string& path, ByteStream::Coding coding, std::uint64_t offset = 0) : stream_(path, coding, offset) {}
    std::size_t read(void* to, std::size_t bytes) override { return stream_.read(to, bytes); }
    std::uint64_t skip(std::uint64_t bytes) override { return stream_.skip(bytes); }

private:
    ByteStream stream_;
};

/// A text in memory, which must outlive this.
class MemoryBytes final : public ByteSource {
public:
    explicit MemoryBytes(std::string_view bytes) : left_(bytes) {}
    std::size_t read(void* to, std::size_t bytes) override;

private:
    std::string_view left_;
};

/// One index of an axis: of each `count` blocks of `block` bytes in a row, the one at `index`. Reads must be whole samples, and so must
/// blocks.
class PickedBytes final : public ByteSource {
public:
    PickedBytes(ByteSource& from, std::uint64_t block, std::uint64_t count, std::uint64_t index);
    std::size_t read(void* to, std::size_t bytes) override;

private:
    std::size_t read_large(unsigned char* to, std::size_t bytes);
    void fill();

    ByteSource& from_;
    std::uint64_t block_, count_, index_;
    std::uint64_t ahead_, left_ = 0;    ///< large blocks: bytes to pass over before the next one, bytes left of this one
    std::vector<unsigned char> picked_; ///< small blocks: read many at once
    std::size_t at_ = 0;
};

} // namespace clvr

#include "host/io/volume/vti_data.hpp"

#include <algorithm>
#include <limits>
#include <lz4.h>
#include <zlib.h>

namespace clvr {

namespace {

std::uint64_t header_number(ByteSource& from, const VtiCoding& coding, const std::string& path) {
    std::array<unsigned char, 8> bytes{};
    if (from.read(bytes.data(), coding.header_bytes) < coding.header_bytes)
        bad_file(path, "its data end within the numbers before the values: the file is truncated");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < coding.header_bytes; ++i)
        value |= std::uint64_t{bytes[i]} << 8 * (coding.big_endian ? coding.header_bytes - 1 - i : i);
    return value;
}

[[noreturn]] void wrong_size(std::uint64_t expected, std::uint64_t found, const std::string& path) {
    bad_file(path, "expected {} bytes of voxels, found {}: the file is damaged or its header is wrong", expected, found);
}

/// Plain bytes behind their number.
class PlainValues final : public ByteSource {
public:
    PlainValues(ByteSource& from, const VtiCoding& coding, std::uint64_t expected, std::uint64_t capacity, const std::string& path)
        : from_(from) {
        const std::uint64_t size = header_number(from, coding, path);
        if (size != expected) wrong_size(expected, size, path);
        check_capacity(size, capacity, path);
    }
    std::size_t read(void* to, std::size_t bytes) override { return from_.read(to, bytes); }
    std::uint64_t skip(std::uint64_t bytes) override { return from_.skip(bytes); }

private:
    ByteSource& from_;
};

/// Blocks, each compressed by itself. Before them: how many, the size of each, of the last one (0: as the others), and the compressed
/// sizes.
class BlockValues final : public ByteSource {
public:
    BlockValues(ByteSource& from, const VtiCoding& coding, std::uint64_t expected, std::uint64_t capacity, std::string path)
        : from_(from), zlib_(coding.compressor == VtiCompressor::zlib), path_(std::move(path)) {
        const auto number = [&] { return header_number(from, coding, path_); };
        const std::uint64_t blocks = number();
        block_ = number();
        const std::uint64_t last = number(), ratio = zlib_ ? 1032 : 255; // the greatest that the formats allow
        if (blocks > capacity / coding.header_bytes || block_ > capacity * ratio || last > block_ || block_ > LZ4_MAX_INPUT_SIZE)
            bad_file(path_, "its {} compressed blocks of {} bytes are more than the file can hold: the file is truncated or damaged",
                     blocks, block_);
        last_ = last ? last : block_;
        packed_sizes_.resize(static_cast<std::size_t>(blocks));
        std::uint64_t packed = 0;
        for (std::uint64_t& size : packed_sizes_) {
            size = number();
            check_capacity(size, std::min<std::uint64_t>(capacity, std::numeric_limits<int>::max()), path_);
            packed += size;
        }
        check_capacity(packed, capacity, path_);
        if (const std::uint64_t size = blocks ? (blocks - 1) * block_ + last_ : 0; size != expected) wrong_size(expected, size, path_);
        check_capacity(expected, capacity * ratio, path_);
    }

    std::size_t read(void* to, std::size_t bytes) override {
        std::size_t done = 0;
        while (done < bytes) {
            if (at_ == values_.size() && !decode_next()) break;
            const std::size_t n = std::min(bytes - done, values_.size() - at_);
            std::copy_n(values_.data() + at_, n, static_cast<unsigned char*>(to) + done);
            at_ += n;
            done += n;
        }
        return done;
    }

private:
    bool decode_next() {
        if (next_ == packed_sizes_.size()) return false;
        std::vector<unsigned char> packed(static_cast<std::size_t>(packed_sizes_[next_]));
        if (from_.read(packed.data(), packed.size()) < packed.size())
            bad_file(path_, "its compressed block {} ends too early: the file is truncated", next_);
        ++next_;
        values_.resize(static_cast<std::size_t>(next_ == packed_sizes_.size() ? last_ : block_));
        at_ = 0;
        bool whole = false;
        if (zlib_) {
            uLongf size = values_.size();
            whole = uncompress(values_.data(), &size, packed.data(), packed.size()) == Z_OK && size == values_.size();
        } else {
            const int size = LZ4_decompress_safe(reinterpret_cast<const char*>(packed.data()), reinterpret_cast<char*>(values_.data()),
                                                 static_cast<int>(packed.size()), static_cast<int>(values_.size()));
            whole = size >= 0 && static_cast<std::size_t>(size) == values_.size();
        }
        if (!whole) bad_file(path_, "its compressed block {} is corrupt: copy or download the file again", next_ - 1);
        return true;
    }

    ByteSource& from_;
    bool zlib_;
    std::string path_;
    std::uint64_t block_ = 0, last_ = 0;
    std::vector<std::uint64_t> packed_sizes_;
    std::size_t next_ = 0, at_ = 0;
    std::vector<unsigned char> values_;
};

} // namespace

std::unique_ptr<ByteSource> open_vti_values(ByteSource& from, const VtiCoding& coding, std::uint64_t expected, std::uint64_t capacity,
                                            const std::string& path) {
    if (coding.compressor == VtiCompressor::none) return std::make_unique<PlainValues>(from, coding, expected, capacity, path);
    return std::make_unique<BlockValues>(from, coding, expected, capacity, path);
}

} // namespace clvr

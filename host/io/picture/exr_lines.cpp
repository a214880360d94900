#include "host/io/picture/exr_lines.hpp"
#include "runtime/error.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <half.h>
#include <libdeflate.h>
#include <memory>
#include <mutex>
#include <new>

namespace clvr {

namespace {

using Byte = unsigned char;

// Measured on a rendered picture of 1280 x 720, 27 channels, one core: 0.40 s and 20.1 MB; level 4 0.33 s and 20.0 MB; zlib's level 4,
// which OpenEXR takes, 0.81 s and 20.0 MB.
constexpr int level = 4;

template <class T, void (*release)(T*)>
struct Release {
    void operator()(T* it) const { release(it); }
};

/// Bytes of even places, then those of odd places; then each but the first less the one before it, plus 128.
std::string predicted(const std::string& lines) {
    const std::size_t half = lines.size() / 2;
    std::string split(lines.size(), '\0'), differences(lines.size(), '\0');
    const auto* from = reinterpret_cast<const Byte*>(lines.data());
    auto *even = reinterpret_cast<Byte*>(split.data()), *odd = even + half;
    for (std::size_t i = 0; i < half; ++i) even[i] = from[2 * i], odd[i] = from[2 * i + 1];
    auto* to = reinterpret_cast<Byte*>(differences.data());
    to[0] = even[0];
    for (std::size_t i = 1; i < split.size(); ++i) to[i] = static_cast<Byte>(even[i] - even[i - 1] + 128);
    return differences;
}

/// What predicted() was made of.
void restore(const std::string& differences, std::string& lines) {
    const std::size_t half = lines.size() / 2;
    const auto *even = reinterpret_cast<const Byte*>(differences.data()), *odd = even + half;
    auto* to = reinterpret_cast<Byte*>(lines.data());
    // Two sums at once: the second begins where the first ends, which is added when that is known.
    Byte first = 128, second = 128;
    for (std::size_t i = 0; i < half; ++i) {
        first = static_cast<Byte>(first + even[i] - 128), second = static_cast<Byte>(second + odd[i] - 128);
        to[2 * i] = first, to[2 * i + 1] = second;
    }
    const auto more = static_cast<Byte>(first - 128);
    for (std::size_t i = 0; i < half; ++i) to[2 * i + 1] = static_cast<Byte>(to[2 * i + 1] + more);
}

} // namespace

std::string pack_lines(const std::string& lines) {
    const std::unique_ptr<libdeflate_compressor, Release<libdeflate_compressor, libdeflate_free_compressor>> compressor(
        libdeflate_alloc_compressor(level));
    if (!compressor) throw std::bad_alloc();
    const std::string from = predicted(lines);
    std::string packed(lines.size() - 1, '\0'); // more would gain nothing
    const std::size_t size = libdeflate_zlib_compress(compressor.get(), from.data(), from.size(), packed.data(), packed.size());
    if (size == 0) return lines;
    packed.resize(size);
    return packed;
}

namespace {

/// Unpacks a block into as many bytes as `lines` has; false when it is damaged or holds another number of them.
bool unpack_lines(const std::string& packed, std::string& lines) {
    if (packed.size() == lines.size()) {
        lines = packed;
        return true;
    }
    const std::unique_ptr<libdeflate_decompressor, Release<libdeflate_decompressor, libdeflate_free_decompressor>> decompressor(
        libdeflate_alloc_decompressor());
    if (!decompressor) throw std::bad_alloc();
    std::string differences(lines.size(), '\0');
    if (libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), differences.data(), differences.size(), nullptr) !=
        LIBDEFLATE_SUCCESS)
        return false;
    restore(differences, lines);
    return true;
}

std::size_t bytes_of(StoredChannel::Type type) { return type == StoredChannel::Type::half ? 2 : 4; }

/// The values of a line's channel.
void convert(const char* from, StoredChannel::Type type, float* to, int count) {
    if (type == StoredChannel::Type::float32) {
        std::memcpy(to, from, sizeof(float) * static_cast<std::size_t>(count));
        return;
    }
    for (int x = 0; x < count; ++x) {
        if (type == StoredChannel::Type::half) {
            std::uint16_t bits = 0;
            std::memcpy(&bits, from + 2 * x, 2);
            to[x] = imath_half_to_float(bits);
        } else {
            std::uint32_t value = 0;
            std::memcpy(&value, from + 4 * x, 4);
            to[x] = static_cast<float>(value);
        }
    }
}

} // namespace

void read_lines(const StoredLines& stored, const std::function<std::string(int line)>& fetch) {
    std::size_t line_bytes = 0;
    for (const StoredChannel& channel : stored.channels) line_bytes += bytes_of(channel.type) * static_cast<std::size_t>(stored.width);
    std::mutex fetching;
    const int blocks = (stored.height + stored.block_lines - 1) / stored.block_lines;
    for_each_index(static_cast<std::size_t>(blocks), [&](std::size_t block) {
        const int line = static_cast<int>(block) * stored.block_lines, end = std::min(line + stored.block_lines, stored.height);
        const std::string packed = [&] {
            const std::lock_guard lock(fetching);
            return fetch(line);
        }();
        std::string lines(static_cast<std::size_t>(end - line) * line_bytes, '\0');
        if (!unpack_lines(packed, lines)) throw Error(ErrorKind::input, "is no complete OpenEXR image: its packed pixels are damaged");
        const char* from = lines.data();
        for (int y = line; y < end; ++y)
            for (const StoredChannel& channel : stored.channels) {
                if (channel.to) convert(from, channel.type, channel.to + static_cast<std::size_t>(y) * stored.row, stored.width);
                from += bytes_of(channel.type) * static_cast<std::size_t>(stored.width);
            }
    });
}

} // namespace clvr

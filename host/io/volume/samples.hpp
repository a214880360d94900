// Samples of any numeric file type into Voxels: what every volume reader ends with.
#pragma once
#include "host/io/byte_stream.hpp"
#include "host/volume/voxels.hpp"
#include "runtime/error.hpp"

#include <array>
#include <cstdint>
#include <fmt/format.h>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace clvr {

/// Throws Error{input} that names the file.
template <class... A>
[[noreturn]] void bad_file(const std::string& path, fmt::format_string<A...> text, A&&... arguments) {
    throw Error(ErrorKind::input, fmt::format(text, std::forward<A>(arguments)...), path);
}

/// The numeric types that volume files hold.
enum class SampleType { u8, i8, u16, i16, u32, i32, u64, i64, f16, f32, f64 };
std::size_t sample_bytes(SampleType t);
/// The type by one of its usual names (uint8, uchar, unsigned char, UInt8, u8, float32, float, ...); nothing when it is none.
std::optional<SampleType> parse_sample_type(std::string_view name);
const char* sample_type_name(SampleType t);
/// What the samples are kept as: themselves where VoxelType has it, else f32.
VoxelType kept_type(SampleType t);
bool is_kept(SampleType t);

/// Whether a file of the given byte order has to be swapped for this machine.
constexpr bool must_swap(bool file_is_big_endian) { return file_is_big_endian != (__BYTE_ORDER__ == __ORDER_BIG_ENDIAN__); }

/// Sizes from a header, not yet trusted.
using FileDims = std::array<std::int64_t, 3>;
/// dims as Int3 and `bytes`, the size of dims x frames samples. Throws Error{input} for a size below 1 or above what 63 bits and int hold.
struct CheckedDims {
    Int3 dims;
    std::uint64_t frame_bytes, bytes;
};
CheckedDims check_dims(const FileDims& dims, std::int64_t frames, SampleType type, const std::string& path);
/// The product of sizes from a header. Throws Error{input} where one is below 1, or the product above 2^31.
std::int64_t checked_product(const std::vector<std::int64_t>& sizes, const std::string& path);
/// Throws Error{input} unless `frame` is one of `frames`.
void check_frame(int frame, std::int64_t frames, const std::string& path);
/// Throws Error{input} unless the payload of `bytes` bytes can be within `capacity` bytes: before anything is allocated.
void check_capacity(std::uint64_t bytes, std::uint64_t capacity, const std::string& path);
/// Throws Error{input} unless origin, spacing and direction are finite, spacing is > 0 and the direction is not singular.
void check_geometry(const Geometry& g, const std::string& path);

/// Sizes `to`, or v.bytes for v.dims and v.type. Throws Error{host_memory} when the machine does not have that much.
void allocate_bytes(std::vector<unsigned char>& to, std::uint64_t bytes, const std::string& path);
void allocate(Voxels& v);
/// Reverses the bytes of each of `n` samples.
void swap_samples(void* samples, SampleType type, std::size_t n);
/// Stores `n` samples in host byte order as voxels first .. first + n - 1 (v.type is kept_type(type), or f32). `samples` may be
/// where those voxels are when both have the same size.
void store_samples(const void* samples, SampleType type, std::size_t n, Voxels& v, std::size_t first);
/// Where samples come from: stores up to `bytes` bytes at `to`, returns how many; fewer only where the data ends.
using ReadBytes = std::function<std::size_t(void* to, std::size_t bytes)>;
/// Allocates v and fills it from the stream, in pieces, so that nothing is held twice. Throws Error{input} when the stream ends too early.
void read_samples(const ReadBytes& from, SampleType type, bool swapped, Voxels& v);
void read_samples(ByteStream& from, SampleType type, bool swapped, Voxels& v);
/// Where voxel (i, j, k) lies among samples: start + i stride[0] + j stride[1] + k stride[2].
struct SampleOrder {
    std::uint64_t start = 0;
    std::array<std::uint64_t, 3> stride;
    /// x fastest, then y, then z, from `start` on.
    static SampleOrder plain(const Int3& dims, std::uint64_t start = 0);
};
/// As read_samples, for samples in another order: reads `samples` of them, among which are all of v's, and holds them beside v.
void read_reordered(const ReadBytes& from, SampleType type, bool swapped, std::uint64_t samples, const SampleOrder& order, Voxels& v);

/// Sets what all readers set alike: source, format, a note of a widened type.
void describe(Voxels& v, const std::string& path, const std::string& format, SampleType type);
/// Checks the scale, replaces (by the least physical value), counts and notes NaN and infinite voxels, notes a constant volume.
/// Throws Error{input} when no voxel is finite.
void repair(Voxels& v);

} // namespace clvr

#include "host/io/volume/samples.hpp"
#include "runtime/system/parallel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <sys/mman.h>
#include <unistd.h>

namespace clvr {

namespace {

/// IEEE 754 binary16.
struct Half {
    std::uint16_t bits = 0;
    explicit operator float() const {
        const int exponent = bits >> 10 & 31, fraction = bits & 1023;
        const float sign = bits >> 15 ? -1.0f : 1.0f;
        if (exponent == 31) return fraction ? std::numeric_limits<float>::quiet_NaN() : sign * std::numeric_limits<float>::infinity();
        return sign * (exponent == 0 ? std::ldexp(static_cast<float>(fraction), -24)
                                     : std::ldexp(static_cast<float>(fraction + 1024), exponent - 25));
    }
};

/// Calls f(T{}) with the C++ type of `t`.
template <class F>
decltype(auto) with_sample_type(SampleType t, F&& f) {
    switch (t) {
    case SampleType::u8:
        return f(std::uint8_t{});
    case SampleType::i8:
        return f(std::int8_t{});
    case SampleType::u16:
        return f(std::uint16_t{});
    case SampleType::i16:
        return f(std::int16_t{});
    case SampleType::u32:
        return f(std::uint32_t{});
    case SampleType::i32:
        return f(std::int32_t{});
    case SampleType::u64:
        return f(std::uint64_t{});
    case SampleType::i64:
        return f(std::int64_t{});
    case SampleType::f16:
        return f(Half{});
    case SampleType::f32:
        return f(float{});
    case SampleType::f64:
        return f(double{});
    }
    throw std::logic_error("sample type");
}

constexpr std::size_t piece_samples = std::size_t{1} << 17, piece_bytes = std::size_t{1} << 26;

/// Has the system give the pages of memory, on all cores: 834 MB take one core 0.65 s, two 0.45 s. (Pages of 2 MiB took between 0.15 and 3
/// s: the system gathers them first.)
void take_pages([[maybe_unused]] unsigned char* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_POPULATE_WRITE
    const auto page = static_cast<std::uintptr_t>(sysconf(_SC_PAGESIZE));
    const auto up = [&](std::size_t at) { return (reinterpret_cast<std::uintptr_t>(memory) + at + page - 1) / page * page; };
    for_each_index(bytes / piece_bytes, [&](std::size_t piece) {
        const std::uintptr_t first = up(piece * piece_bytes), end = up((piece + 1) * piece_bytes) - page;
        madvise(reinterpret_cast<void*>(first), end - first, MADV_POPULATE_WRITE); // in vain, without harm, on older systems
    });
#endif
}

} // namespace

std::size_t sample_bytes(SampleType t) {
    return with_sample_type(t, [](auto zero) { return sizeof(zero); });
}

std::optional<SampleType> parse_sample_type(std::string_view name) {
    static const std::map<std::string, SampleType, std::less<>> types{{"u8", SampleType::u8},
                                                                      {"uint8", SampleType::u8},
                                                                      {"uint8_t", SampleType::u8},
                                                                      {"uchar", SampleType::u8},
                                                                      {"unsigned char", SampleType::u8},
                                                                      {"unsigned_char", SampleType::u8},
                                                                      {"i8", SampleType::i8},
                                                                      {"int8", SampleType::i8},
                                                                      {"int8_t", SampleType::i8},
                                                                      {"char", SampleType::i8},
                                                                      {"signed char", SampleType::i8},
                                                                      {"signed_char", SampleType::i8},
                                                                      {"u16", SampleType::u16},
                                                                      {"uint16", SampleType::u16},
                                                                      {"uint16_t", SampleType::u16},
                                                                      {"ushort", SampleType::u16},
                                                                      {"unsigned short", SampleType::u16},
                                                                      {"unsigned short int", SampleType::u16},
                                                                      {"unsigned_short", SampleType::u16},
                                                                      {"i16", SampleType::i16},
                                                                      {"int16", SampleType::i16},
                                                                      {"int16_t", SampleType::i16},
                                                                      {"short", SampleType::i16},
                                                                      {"short int", SampleType::i16},
                                                                      {"signed short", SampleType::i16},
                                                                      {"signed short int", SampleType::i16},
                                                                      {"u32", SampleType::u32},
                                                                      {"uint32", SampleType::u32},
                                                                      {"uint32_t", SampleType::u32},
                                                                      {"uint", SampleType::u32},
                                                                      {"unsigned int", SampleType::u32},
                                                                      {"unsigned_int", SampleType::u32},
                                                                      {"i32", SampleType::i32},
                                                                      {"int32", SampleType::i32},
                                                                      {"int32_t", SampleType::i32},
                                                                      {"int", SampleType::i32},
                                                                      {"signed int", SampleType::i32},
                                                                      {"u64", SampleType::u64},
                                                                      {"uint64", SampleType::u64},
                                                                      {"uint64_t", SampleType::u64},
                                                                      {"ulonglong", SampleType::u64},
                                                                      {"unsigned long long", SampleType::u64},
                                                                      {"unsigned long long int", SampleType::u64},
                                                                      {"unsigned_long", SampleType::u64},
                                                                      {"unsigned_long_long", SampleType::u64},
                                                                      {"vtktypeuint64", SampleType::u64},
                                                                      {"i64", SampleType::i64},
                                                                      {"int64", SampleType::i64},
                                                                      {"int64_t", SampleType::i64},
                                                                      {"longlong", SampleType::i64},
                                                                      {"long long", SampleType::i64},
                                                                      {"long long int", SampleType::i64},
                                                                      {"signed long long", SampleType::i64},
                                                                      {"signed long long int", SampleType::i64},
                                                                      {"long_long", SampleType::i64},
                                                                      {"long", SampleType::i64},
                                                                      {"vtktypeint64", SampleType::i64},
                                                                      {"f16", SampleType::f16},
                                                                      {"float16", SampleType::f16},
                                                                      {"f32", SampleType::f32},
                                                                      {"float32", SampleType::f32},
                                                                      {"float", SampleType::f32},
                                                                      {"f64", SampleType::f64},
                                                                      {"float64", SampleType::f64},
                                                                      {"double", SampleType::f64}};
    const auto found = types.find(name);
    return found == types.end() ? std::nullopt : std::optional(found->second);
}

const char* sample_type_name(SampleType t) {
    static constexpr std::array names{"u8", "i8", "u16", "i16", "u32", "i32", "u64", "i64", "f16", "f32", "f64"};
    return names[static_cast<std::size_t>(t)];
}

VoxelType kept_type(SampleType t) {
    switch (t) {
    case SampleType::u8:
        return VoxelType::u8;
    case SampleType::i8:
        return VoxelType::i8;
    case SampleType::u16:
        return VoxelType::u16;
    case SampleType::i16:
        return VoxelType::i16;
    default:
        return VoxelType::f32;
    }
}

bool is_kept(SampleType t) { return kept_type(t) != VoxelType::f32 || t == SampleType::f32; }

CheckedDims check_dims(const FileDims& dims, std::int64_t frames, SampleType type, const std::string& path) {
    constexpr std::int64_t most = std::numeric_limits<int>::max();
    std::uint64_t bytes = sample_bytes(type), frame_bytes = bytes;
    for (const std::int64_t n : {dims[0], dims[1], dims[2], frames}) {
        if (n < 1 || n > most || bytes > (std::uint64_t{1} << 62) / static_cast<std::uint64_t>(n))
            bad_file(path, "the size {} x {} x {} x {} frames is impossible: each must be at least 1 and the whole fit a file", dims[0],
                     dims[1], dims[2], frames);
        frame_bytes = bytes;
        bytes *= static_cast<std::uint64_t>(n);
    }
    frame_bytes = bytes / static_cast<std::uint64_t>(frames);
    return {{static_cast<int>(dims[0]), static_cast<int>(dims[1]), static_cast<int>(dims[2])}, frame_bytes, bytes};
}

std::int64_t checked_product(const std::vector<std::int64_t>& sizes, const std::string& path) {
    std::int64_t product = 1;
    for (const std::int64_t n : sizes) {
        if (n < 1 || n > std::numeric_limits<std::int32_t>::max() / product) bad_file(path, "an axis has the impossible size {}", n);
        product *= n;
    }
    return product;
}

void check_frame(int frame, std::int64_t frames, const std::string& path) {
    if (frame < 0 || frame >= frames)
        bad_file(path, "frame {} is not there: the file has {} frame{}, counted from 0", frame, frames, frames == 1 ? "" : "s");
}

void check_capacity(std::uint64_t bytes, std::uint64_t capacity, const std::string& path) {
    if (bytes > capacity)
        bad_file(path, "expected {} bytes of voxels, found room for at most {}: the file is truncated or its header is wrong", bytes,
                 capacity);
}

void check_geometry(const Geometry& g, const std::string& path) {
    for (int i = 0; i < 3; ++i) {
        if (!(g.spacing[i] > 0) || !std::isfinite(g.spacing[i]))
            bad_file(path, "the voxel spacing {:g} x {:g} x {:g} mm is not usable: each must be finite and above 0", g.spacing[0],
                     g.spacing[1], g.spacing[2]);
        if (!std::isfinite(g.origin[i])) bad_file(path, "the origin {:g} {:g} {:g} is not finite", g.origin[0], g.origin[1], g.origin[2]);
    }
    // Unit columns: the determinant is the volume of the cell they span; at 1e-3 two axes are within 0.06 degrees of each other.
    const double volume = g.direction.determinant();
    if (!std::isfinite(volume) || std::abs(volume) < 1e-3)
        bad_file(path, "the direction matrix is singular (determinant {:g}): the three axes must span space", volume);
}

void allocate_bytes(std::vector<unsigned char>& to, std::uint64_t bytes, const std::string& path) {
    const std::uint64_t machine = static_cast<std::uint64_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    if (bytes > machine)
        throw Error(ErrorKind::host_memory, fmt::format("its voxels need {} bytes, this machine has {} bytes of memory", bytes, machine),
                    path);
    to.reserve(static_cast<std::size_t>(bytes));
    take_pages(to.data(), to.capacity());
    to.resize(static_cast<std::size_t>(bytes));
}

void allocate(Voxels& v) { allocate_bytes(v.bytes, static_cast<std::uint64_t>(v.count()) * voxel_bytes(v.type), v.source); }

void swap_samples(void* samples, SampleType type, std::size_t n) {
    auto* p = static_cast<unsigned char*>(samples);
    const std::size_t size = sample_bytes(type);
    if (size == 1) return;
    for (std::size_t i = 0; i < n; ++i, p += size) std::reverse(p, p + size);
}

void store_samples(const void* samples, SampleType type, std::size_t n, Voxels& v, std::size_t first) {
    const std::size_t to_bytes = voxel_bytes(v.type);
    unsigned char* to = v.bytes.data() + first * to_bytes;
    with_sample_type(type, [&](auto zero) {
        using T = decltype(zero);
        if (is_kept(type) && v.type == kept_type(type)) {
            std::memcpy(to, samples, n * sizeof(T));
        } else {
            for (std::size_t i = 0; i < n; ++i) {
                T x;
                std::memcpy(&x, static_cast<const unsigned char*>(samples) + i * sizeof(T), sizeof(T));
                const float y = static_cast<float>(x); // beyond float's range: infinite, found by repair()
                std::memcpy(to + i * sizeof(float), &y, sizeof(float));
            }
        }
    });
}

void read_samples(const ReadBytes& from, SampleType type, bool swapped, Voxels& v) {
    allocate(v);
    const std::size_t size = sample_bytes(type), count = v.count();
    const bool kept = is_kept(type);
    const std::size_t most = kept ? piece_bytes / size : piece_samples;
    std::vector<unsigned char> scratch(kept ? 0 : most * size);
    for (std::size_t first = 0; first < count; first += most) {
        const std::size_t n = std::min(most, count - first);
        unsigned char* piece = kept ? v.bytes.data() + first * size : scratch.data();
        const std::size_t got = from(piece, n * size);
        if (got < n * size)
            bad_file(v.source, "expected {} bytes of voxels, found {}: the file is truncated", count * size, first * size + got);
        if (swapped)
            for_parts(n, [&](std::size_t, std::size_t low, std::size_t high) { swap_samples(piece + low * size, type, high - low); });
        if (!kept) store_samples(piece, type, n, v, first);
    }
}

void read_samples(ByteStream& from, SampleType type, bool swapped, Voxels& v) {
    read_samples([&](void* to, std::size_t bytes) { return from.read(to, bytes); }, type, swapped, v);
}

SampleOrder SampleOrder::plain(const Int3& dims, std::uint64_t start) {
    return {start, {1, static_cast<std::uint64_t>(dims[0]), static_cast<std::uint64_t>(dims[0]) * static_cast<std::uint64_t>(dims[1])}};
}

void read_reordered(const ReadBytes& from, SampleType type, bool swapped, std::uint64_t samples, const SampleOrder& order, Voxels& v) {
    const std::size_t size = sample_bytes(type);
    std::vector<unsigned char> all;
    allocate_bytes(all, samples * size, v.source);
    if (const std::size_t got = from(all.data(), all.size()); got < all.size())
        bad_file(v.source, "expected {} bytes of voxels, found {}: the file is truncated", all.size(), got);
    allocate(v);
    std::vector<unsigned char> row(static_cast<std::size_t>(v.dims[0]) * size);
    std::size_t first = 0;
    for (std::uint64_t k = 0; k < static_cast<std::uint64_t>(v.dims[2]); ++k)
        for (std::uint64_t j = 0; j < static_cast<std::uint64_t>(v.dims[1]); ++j, first += static_cast<std::size_t>(v.dims[0])) {
            const unsigned char* sample = all.data() + (order.start + j * order.stride[1] + k * order.stride[2]) * size;
            for (std::size_t at = 0; at < row.size(); at += size, sample += order.stride[0] * size)
                std::memcpy(row.data() + at, sample, size);
            if (swapped) swap_samples(row.data(), type, static_cast<std::size_t>(v.dims[0]));
            store_samples(row.data(), type, static_cast<std::size_t>(v.dims[0]), v, first);
        }
}

void describe(Voxels& v, const std::string& path, const std::string& format, SampleType type) {
    v.source = path;
    v.format = format;
    v.type = kept_type(type);
    if (type == SampleType::f16)
        v.decisions.push_back("the file's f16 voxels are kept as f32, each value as it is");
    else if (!is_kept(type))
        v.notes.push_back(fmt::format("the file's {} voxels are kept as f32 (24 bits of precision)", sample_type_name(type)));
}

void repair(Voxels& v) {
    if (!std::isfinite(v.slope) || v.slope == 0 || !std::isfinite(v.intercept))
        bad_file(v.source, "the scale slope {:g}, intercept {:g} is not usable: both must be finite and the slope not 0", v.slope,
                 v.intercept);
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        T* const begin = reinterpret_cast<T*>(v.bytes.data());
        T* const end = begin + v.count();
        if constexpr (std::is_same_v<T, float>) {
            const float sign = v.slope < 0 ? -1.0f : 1.0f; // the least physical value is the greatest stored one
            float least = std::numeric_limits<float>::infinity();
            for (const T* p = begin; p != end; ++p) {
                if (std::isfinite(*p))
                    least = std::min(least, sign * *p);
                else
                    ++v.repaired;
            }
            if (v.repaired == v.count()) bad_file(v.source, "none of the {} voxels is finite: nothing to show", v.count());
            if (v.repaired > 0) {
                for (T* p = begin; p != end; ++p)
                    if (!std::isfinite(*p)) *p = sign * least;
                v.notes.push_back(fmt::format("{} voxel{} NaN or infinite: shown as the least finite value, {:g}", v.repaired,
                                              v.repaired == 1 ? " is" : "s are", v.slope * double{sign * least} + v.intercept));
            }
        }
        if (std::all_of(begin, end, [&](T x) { return x == *begin; }))
            v.notes.push_back(fmt::format("every voxel has the same value, {:g}: there is no structure to show",
                                          v.slope * static_cast<double>(*begin) + v.intercept));
    });
}

} // namespace clvr

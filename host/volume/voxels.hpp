// A decoded volume in host memory: voxels in their stored type, physical scale, geometry.
#pragma once
#include "host/volume/geometry.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace clvr {

/// The types that stay as they are from the file to the device. Anything else becomes f32, and the reader says so.
enum class VoxelType { u8, i8, u16, i16, f32 };

constexpr std::size_t voxel_bytes(VoxelType t) { return t == VoxelType::f32 ? 4 : (t == VoxelType::u16 || t == VoxelType::i16) ? 2 : 1; }
/// "u8", "i8", "u16", "i16", "f32".
const char* voxel_type_name(VoxelType t);
/// The type of such a name; nothing for another text.
std::optional<VoxelType> voxel_type_named(const std::string& name);

/// Calls f(T{}) with the C++ type of `t`.
template <class F>
decltype(auto) with_voxel_type(VoxelType t, F&& f) {
    switch (t) {
    case VoxelType::u8:
        return f(std::uint8_t{});
    case VoxelType::i8:
        return f(std::int8_t{});
    case VoxelType::u16:
        return f(std::uint16_t{});
    case VoxelType::i16:
        return f(std::int16_t{});
    case VoxelType::f32:
        return f(float{});
    }
    throw std::logic_error("voxel type");
}

/// Decoded voxels, x fastest. physical value = slope * stored + intercept. Stored f32 values are all finite: readers replace NaN and
/// infinities by the minimum of the finite ones and count them in `repaired`.
struct Voxels {
    VoxelType type = VoxelType::u8;
    Int3 dims{0, 0, 0};
    std::vector<unsigned char> bytes; ///< dims[0]*dims[1]*dims[2]*voxel_bytes(type), host byte order
    double slope = 1, intercept = 0;
    Geometry geometry;
    std::string source;             ///< the file (or "demo:head") this came from
    std::string format;             ///< "NIfTI", "DICOM series", ...
    std::string modality;           ///< "CT", "MR", ... where the file says so, else empty
    int frames = 1;                 ///< of the file's series of volumes, of which this is one; 1 where it does not say (DICOM)
    std::size_t repaired = 0;       ///< NaN and infinite voxels that were replaced
    std::vector<std::string> notes; ///< what the reader wants the user to know (a warning a line)
    /// How the reader understood what a file may say in several ways ("spacing z from OME-XML"): shown by `clvr info`, no warnings.
    std::vector<std::string> decisions;

    std::size_t count() const { return static_cast<std::size_t>(dims[0]) * dims[1] * dims[2]; }
    template <class T>
    const T* data() const {
        return reinterpret_cast<const T*>(bytes.data());
    }
};

/// Voxels of each stored value of an integer type, from the type's least value on: in all of the volume, and in the shell at its border
/// (stored_counts.hpp). Empty for f32.
struct StoredCounts {
    std::vector<std::uint64_t> all, border;
};

/// Least and greatest stored value, and a histogram of 1024 equal bins over [low, high] in stored values (the last bin closed).
struct Histogram {
    double low = 0, high = 0;
    std::vector<std::uint64_t> bins;
    StoredCounts stored; ///< what it was made of, for value_counts()
    std::uint64_t total() const {
        std::uint64_t n = 0;
        for (auto b : bins) n += b;
        return n;
    }
};
Histogram stored_histogram(const Voxels& v);

} // namespace clvr

// NIfTI-1 files of volumes.
#include "host/io/volume/format.hpp"
#include "host/io/volume/volume_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <array>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <zlib.h>

namespace clvr {

namespace {

constexpr std::size_t nifti_header_bytes = 352; // 348 and the mark of no extension

short datatype_of(VoxelType t) {
    switch (t) {
    case VoxelType::u8:
        return 2;
    case VoxelType::i8:
        return 256;
    case VoxelType::u16:
        return 512;
    case VoxelType::i16:
        return 4;
    case VoxelType::f32:
        return 16;
    }
    throw std::logic_error("voxel type");
}

std::array<unsigned char, nifti_header_bytes> header_of(const Voxels& v) {
    std::array<unsigned char, nifti_header_bytes> h{};
    const auto put = [&](std::size_t at, auto value) { std::memcpy(h.data() + at, &value, sizeof value); };
    put(0, std::int32_t{348});
    put(40, std::int16_t{3});
    for (std::size_t a = 0; a < 3; ++a) {
        put(42 + 2 * a, static_cast<std::int16_t>(v.dims[a]));
        put(80 + 4 * a, static_cast<float>(v.geometry.spacing[a]));
    }
    for (std::size_t a = 3; a < 7; ++a) put(42 + 2 * a, std::int16_t{1});
    put(70, datatype_of(v.type));
    put(72, static_cast<std::int16_t>(8 * voxel_bytes(v.type)));
    put(76, 1.0f);
    put(108, static_cast<float>(nifti_header_bytes));
    put(112, static_cast<float>(v.slope));
    put(116, static_cast<float>(v.intercept));
    h[123] = 2;                // millimetres
    put(254, std::int16_t{1}); // sform: scanner coordinates, RAS where clvr's are LPS
    const Double3 origin = v.geometry.to_world({0, 0, 0});
    for (std::size_t row = 0; row < 3; ++row) {
        const double sign = row < 2 ? -1 : 1;
        for (std::size_t column = 0; column < 3; ++column) {
            Double3 index{0, 0, 0};
            index[column] = 1;
            put(280 + 16 * row + 4 * column, static_cast<float>(sign * (v.geometry.to_world(index)[row] - origin[row])));
        }
        put(280 + 16 * row + 12, static_cast<float>(sign * origin[row]));
    }
    std::memcpy(h.data() + 344, "n+1", 4);
    return h;
}

void write_compressed(const std::string& path, const void* header, const std::vector<unsigned char>& bytes) {
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "wb4"), gzclose);
    bool good = file && gzwrite(file.get(), header, nifti_header_bytes) == static_cast<int>(nifti_header_bytes);
    constexpr std::size_t piece = std::size_t{64} << 20;
    for (std::size_t at = 0; good && at < bytes.size(); at += piece) {
        const auto n = static_cast<unsigned>(std::min(piece, bytes.size() - at));
        good = gzwrite(file.get(), bytes.data() + at, n) == static_cast<int>(n);
    }
    if (!good || gzflush(file.get(), Z_FINISH) != Z_OK) throw Error(ErrorKind::input, "cannot be written", path);
}

} // namespace

void check_nifti_path(const std::string& path) {
    if (!ends_with(path, ".nii") && !ends_with(path, ".nii.gz"))
        throw Error(ErrorKind::input, "has another ending; expected .nii or .nii.gz", path);
    check_writable(path);
}

void write_nifti(const Voxels& v, const std::string& path) {
    check_nifti_path(path);
    for (const int n : v.dims)
        if (n < 1 || n > 32767)
            throw Error(ErrorKind::input, fmt::format("has {} voxels along an axis; NIfTI-1 holds 1 to 32767", n), path);
    const std::array<unsigned char, nifti_header_bytes> header = header_of(v);
    write_atomically(path, [&](const std::string& temporary) {
        if (ends_with(path, ".gz")) return write_compressed(temporary, header.data(), v.bytes);
        std::ofstream out(temporary, std::ios::binary);
        out.write(reinterpret_cast<const char*>(header.data()), nifti_header_bytes);
        out.write(reinterpret_cast<const char*>(v.bytes.data()), static_cast<std::streamsize>(v.bytes.size()));
        out.close();
        if (!out) throw Error(ErrorKind::input, "cannot be written; is the disk full?", path);
    });
}

} // namespace clvr

// Small volume files of every format, written byte by byte from the formats' own documents.
#pragma once
#include "host/volume/geometry.hpp"
#include "host/volume/voxels.hpp"
#include "runtime/error.hpp"
#include "tests/io/folder.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <unistd.h>
#include <vector>
#include <zlib.h>

namespace clvr::test {

inline std::string write(const std::string& path, const std::string& bytes) {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
}
inline std::string read(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes of numbers, little-endian unless `big`.
template <class T>
std::string bytes_of(const std::vector<T>& values, bool big = false) {
    std::string bytes(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    if (big)
        for (std::size_t i = 0; i < bytes.size(); i += sizeof(T)) std::reverse(bytes.begin() + i, bytes.begin() + i + sizeof(T));
    return bytes;
}
template <class T>
std::string number(T value, bool big = false) {
    return bytes_of(std::vector<T>{value}, big);
}

inline std::vector<double> values_of(const Voxels& v) {
    std::vector<double> values;
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        values.assign(v.data<T>(), v.data<T>() + v.count());
    });
    return values;
}

/// gzip (as a .gz file) or a zlib stream.
inline std::string deflated(const std::string& bytes, bool gzip = true) {
    z_stream z{};
    deflateInit2(&z, 6, Z_DEFLATED, gzip ? 15 + 16 : 15, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&z, bytes.size()), '\0');
    z.next_in = reinterpret_cast<unsigned char*>(const_cast<char*>(bytes.data()));
    z.avail_in = static_cast<unsigned>(bytes.size());
    z.next_out = reinterpret_cast<unsigned char*>(packed.data());
    z.avail_out = static_cast<unsigned>(packed.size());
    deflate(&z, Z_FINISH);
    packed.resize(z.total_out);
    deflateEnd(&z);
    return packed;
}

/// Expects that `f` throws Error of the kind and that its line holds every word.
inline void expect_error(const std::function<void()>& f, const std::vector<std::string>& words, ErrorKind kind = ErrorKind::input) {
    try {
        f();
        ADD_FAILURE() << "no error; expected one that says " << (words.empty() ? "" : words.front());
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind) << e.line();
        EXPECT_EQ(e.line().find('\n'), std::string::npos) << e.line();
        for (const std::string& word : words)
            EXPECT_NE(e.line().find(word), std::string::npos) << "\"" << word << "\" is not in: " << e.line();
    }
}

/// What the writers write: i16 voxels, oblique geometry in LPS.
struct Sample {
    Int3 dims{5, 4, 3};
    std::vector<std::int16_t> voxels;
    Geometry geometry;

    explicit Sample(Int3 size = {5, 4, 3}) : dims(size) {
        voxels.resize(static_cast<std::size_t>(size[0]) * size[1] * size[2]);
        for (std::size_t i = 0; i < voxels.size(); ++i) voxels[i] = static_cast<std::int16_t>((i * 2654435761u >> 7) % 3000) - 1000;
        geometry.origin = {-10.5, 20.25, 31};
        geometry.spacing = {0.5, 0.75, 2};
        // 30 degrees about z, exactly orthogonal to six digits in a text header
        geometry.direction.row = {{{0.866025, -0.5, 0}, {0.5, 0.866025, 0}, {0, 0, 1}}};
    }
};

struct NiftiFields {
    bool big = false, pair = false;
    int version = 1;
    int datatype = 4;
    std::size_t sample_bytes = 2;
    std::vector<std::int64_t> dim; ///< of all axes; empty: those of the sample
    std::vector<double> pixdim;    ///< of 3 axes; empty: those of the sample
    double slope = 0, intercept = 0, qfac = 1;
    int qform = 0, sform = 1, units = 2, intent = 0;
    std::array<double, 3> quatern{};
    double voxel_offset = -1; ///< -1: right behind the header
};

/// The header alone; its matrix and offsets are RAS, the sample's LPS.
inline std::string nifti_header(const Sample& s, const NiftiFields& f) {
    const std::size_t size = f.version == 2 ? 540 : 348;
    std::string h(size, '\0');
    const auto put = [&](std::size_t at, const std::string& bytes) { h.replace(at, bytes.size(), bytes); };
    const auto real = [&](std::size_t at1, std::size_t at2, std::size_t index, double x) {
        f.version == 2 ? put(at2 + 8 * index, number(x, f.big)) : put(at1 + 4 * index, number(static_cast<float>(x), f.big));
    };
    const auto code = [&](std::size_t at1, std::size_t at2, int x) {
        f.version == 2 ? put(at2, number(std::int32_t{x}, f.big)) : put(at1, number(static_cast<std::int16_t>(x), f.big));
    };
    put(0, number(static_cast<std::int32_t>(size), f.big));
    put(f.version == 2 ? 4 : 344, f.version == 2 ? std::string(f.pair ? "ni2\0\r\n\032\n" : "n+2\0\r\n\032\n", 8) : f.pair ? "ni1" : "n+1");
    std::vector<std::int64_t> dim = f.dim;
    if (dim.empty()) dim = {s.dims[0], s.dims[1], s.dims[2]};
    dim.insert(dim.begin(), static_cast<std::int64_t>(dim.size()));
    dim.resize(8, 1);
    std::vector<double> pixdim = f.pixdim;
    if (pixdim.empty()) pixdim = {s.geometry.spacing[0], s.geometry.spacing[1], s.geometry.spacing[2]};
    pixdim.insert(pixdim.begin(), f.qfac);
    for (std::size_t i = 0; i < 8; ++i) {
        f.version == 2 ? put(16 + 8 * i, number(dim[i], f.big)) : put(40 + 2 * i, number(static_cast<std::int16_t>(dim[i]), f.big));
        if (i < pixdim.size()) real(76, 104, i, pixdim[i]);
    }
    put(f.version == 2 ? 12 : 70, number(static_cast<std::int16_t>(f.datatype), f.big));
    put(f.version == 2 ? 14 : 72, number(static_cast<std::int16_t>(8 * f.sample_bytes), f.big));
    const double offset = f.voxel_offset >= 0 ? f.voxel_offset : f.pair ? 0.0 : static_cast<double>(size + 4);
    f.version == 2 ? put(168, number(static_cast<std::int64_t>(offset), f.big)) : put(108, number(static_cast<float>(offset), f.big));
    real(112, 176, 0, f.slope);
    real(112, 176, 1, f.intercept);
    code(252, 344, f.qform);
    code(254, 348, f.sform);
    code(68, 504, f.intent);
    f.version == 2 ? put(500, number(std::int32_t{f.units}, f.big)) : put(123, std::string(1, static_cast<char>(f.units)));
    const std::array<double, 3> to_ras{-1, -1, 1};
    for (std::size_t i = 0; i < 3; ++i) {
        real(256, 352, i, f.quatern[i]);
        real(268, 376, i, to_ras[i] * s.geometry.origin[i]);
        for (std::size_t j = 0; j < 3; ++j)
            real(280 + 16 * i, 400 + 32 * i, j, to_ras[i] * s.geometry.direction.row[i][j] * s.geometry.spacing[j]);
        real(280 + 16 * i, 400 + 32 * i, 3, to_ras[i] * s.geometry.origin[i]);
    }
    return h;
}
/// Header, no extension, voxels.
inline std::string nifti(const Sample& s, const NiftiFields& f, const std::string& voxels) {
    return nifti_header(s, f) + std::string(4, '\0') + voxels;
}
inline std::string nifti(const Sample& s) { return nifti(s, {}, bytes_of(s.voxels)); }

inline std::string triple(const Double3& v) { return fmt::format("({},{},{})", v[0], v[1], v[2]); }

/// `more` are whole lines; the empty line and voxels come behind.
inline std::string nrrd_header(const Sample& s, const std::string& encoding, const std::string& more = {}) {
    const Matrix3 m = s.geometry.index_to_world();
    return fmt::format(
        "NRRD0004\n# a comment\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\nspace directions: {} {} {}\n"
        "kinds: domain domain domain\nendian: little\nencoding: {}\nspace origin: {}\n{}",
        s.dims[0], s.dims[1], s.dims[2], triple(m.column(0)), triple(m.column(1)), triple(m.column(2)), encoding, triple(s.geometry.origin),
        more);
}

inline std::string metaimage_header(const Sample& s, const std::string& more, const std::string& data = "LOCAL") {
    const auto& d = s.geometry.direction;
    std::string matrix;
    for (int j = 0; j < 3; ++j) // MetaIO writes the axes one after another
        for (int i = 0; i < 3; ++i) matrix += fmt::format(" {}", d.row[i][j]);
    return fmt::format(
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n{}TransformMatrix ={}\nOffset = {} {} {}\n"
        "ElementSpacing = {} {} {}\nDimSize = {} {} {}\nElementType = MET_SHORT\nElementDataFile = {}\n",
        more, matrix, s.geometry.origin[0], s.geometry.origin[1], s.geometry.origin[2], s.geometry.spacing[0], s.geometry.spacing[1],
        s.geometry.spacing[2], s.dims[0], s.dims[1], s.dims[2], data);
}

inline std::string vtk_header(const Sample& s, const std::string& coding = "BINARY", const std::string& type = "short") {
    const auto& g = s.geometry;
    return fmt::format(
        "# vtk DataFile Version 3.0\na test\n{}\nDATASET STRUCTURED_POINTS\nDIMENSIONS {} {} {}\nSPACING {} {} {}\nORIGIN {} {} {}\n"
        "POINT_DATA {}\nSCALARS density {} 1\nLOOKUP_TABLE default\n",
        coding, s.dims[0], s.dims[1], s.dims[2], g.spacing[0], g.spacing[1], g.spacing[2], g.origin[0], g.origin[1], g.origin[2],
        s.voxels.size(), type);
}

/// One page of a TIFF.
struct TiffPage {
    std::uint32_t width, height;
    std::uint16_t bits = 16, format = 2 /* signed */, samples = 1, photometric = 1 /* black is zero */,
                  compression = 1 /* none; 8: deflate */;
    std::string pixels = {}, description = {};
    std::uint32_t tile = 0; ///< edge of square tiles; 0: one strip
};

/// A classic little-endian TIFF: for each page its pixels, then its directory.
inline std::string tiff(const std::vector<TiffPage>& pages) {
    std::string file("II*\0\0\0\0\0", 8);
    std::size_t link = 4; // where the offset of the next directory belongs
    for (const TiffPage& p : pages) {
        std::vector<std::string> pieces{p.pixels};
        if (p.tile) {
            pieces.clear();
            const std::size_t pixel = p.bits / 8;
            for (std::uint32_t y = 0; y < p.height; y += p.tile)
                for (std::uint32_t x = 0; x < p.width; x += p.tile) {
                    std::string tile(std::size_t{p.tile} * p.tile * pixel, '\0');
                    for (std::uint32_t j = 0; j < p.tile && y + j < p.height; ++j)
                        for (std::uint32_t i = 0; i < p.tile && x + i < p.width; ++i)
                            tile.replace((std::size_t{j} * p.tile + i) * pixel, pixel, p.pixels,
                                         ((std::size_t{y} + j) * p.width + x + i) * pixel, pixel);
                    pieces.push_back(tile);
                }
        }
        std::vector<std::uint32_t> offsets, counts;
        for (const std::string& piece : pieces) {
            const std::string packed = p.compression == 8 ? deflated(piece, false) : piece;
            offsets.push_back(static_cast<std::uint32_t>(file.size()));
            counts.push_back(static_cast<std::uint32_t>(packed.size()));
            file += packed;
        }
        struct Entry {
            std::uint16_t tag, type;
            std::uint32_t count;
            std::uint32_t value;
        };
        const auto list = [&](const std::vector<std::uint32_t>& values) {
            if (values.size() == 1) return values.front();
            const auto at = static_cast<std::uint32_t>(file.size());
            file += bytes_of(values);
            return at;
        };
        constexpr std::uint16_t ascii = 2, word = 3, longword = 4;
        const auto n = static_cast<std::uint32_t>(pieces.size());
        std::vector<Entry> entries{{256, longword, 1, p.width},
                                   {257, longword, 1, p.height},
                                   {258, word, 1, p.bits},
                                   {259, word, 1, p.compression},
                                   {262, word, 1, p.photometric}};
        if (!p.description.empty()) {
            entries.push_back({270, ascii, static_cast<std::uint32_t>(p.description.size() + 1), static_cast<std::uint32_t>(file.size())});
            file += p.description + '\0';
        }
        if (!p.tile) entries.push_back({273, longword, n, list(offsets)});
        entries.push_back({277, word, 1, p.samples});
        if (!p.tile) {
            entries.push_back({278, longword, 1, p.height});
            entries.push_back({279, longword, n, list(counts)});
        }
        if (!p.description.empty()) { // 2 pixels a unit
            const auto at = static_cast<std::uint32_t>(file.size());
            file += bytes_of(std::vector<std::uint32_t>{2, 1});
            entries.push_back({282, 5, 1, at});
            entries.push_back({283, 5, 1, at});
        }
        if (p.tile) {
            entries.push_back({322, word, 1, p.tile});
            entries.push_back({323, word, 1, p.tile});
            entries.push_back({324, longword, n, list(offsets)});
            entries.push_back({325, longword, n, list(counts)});
        }
        entries.push_back({339, word, 1, p.format});
        file.resize((file.size() + 1) / 2 * 2);
        file.replace(link, 4, number(static_cast<std::uint32_t>(file.size())));
        file += number(static_cast<std::uint16_t>(entries.size()));
        for (const Entry& e : entries) file += number(e.tag) + number(e.type) + number(e.count) + number(e.value);
        link = file.size();
        file += number(std::uint32_t{0});
    }
    return file;
}
/// The sample, a page a slice.
inline std::vector<TiffPage> tiff_pages(const Sample& s) {
    std::vector<TiffPage> pages;
    const std::size_t n = static_cast<std::size_t>(s.dims[0]) * s.dims[1];
    for (int k = 0; k < s.dims[2]; ++k) {
        TiffPage p{static_cast<std::uint32_t>(s.dims[0]), static_cast<std::uint32_t>(s.dims[1])};
        p.pixels = bytes_of(std::vector<std::int16_t>(s.voxels.begin() + k * n, s.voxels.begin() + (k + 1) * n));
        pages.push_back(p);
    }
    return pages;
}

struct DicomFields {
    std::string series = "1.2.3", instance_uid, modality = "CT", photometric = "MONOCHROME2", position, orientation, spacing, slope,
                intercept, frames;
    int instance = 1, acquisition = 1, rows = 0, columns = 0, samples = 1, bits_stored = 16;
    bool is_signed = true, rle = false;
    std::string pixels;
};

/// RLE Lossless of 16-bit pixels: the high bytes, then the low bytes, as literal runs.
inline std::string rle_frame(const std::string& pixels) {
    std::array<std::string, 2> segments;
    for (std::size_t plane = 0; plane < 2; ++plane) {
        for (std::size_t i = 0; i < pixels.size() / 2; i += 128) {
            const std::size_t n = std::min<std::size_t>(128, pixels.size() / 2 - i);
            segments[plane] += static_cast<char>(n - 1);
            for (std::size_t k = 0; k < n; ++k) segments[plane] += pixels[2 * (i + k) + 1 - plane];
        }
        segments[plane].resize((segments[plane].size() + 1) / 2 * 2);
    }
    std::vector<std::uint32_t> header(16);
    header[0] = 2;
    header[1] = 64;
    header[2] = static_cast<std::uint32_t>(64 + segments[0].size());
    return bytes_of(header) + segments[0] + segments[1];
}

/// One slice, explicit VR little endian or RLE.
inline std::string dicom(const DicomFields& f) {
    const auto element = [](std::uint16_t group, std::uint16_t tag, const std::string& vr, std::string value) {
        if (value.size() % 2) value += vr == "UI" ? '\0' : ' ';
        const bool is_long = vr == "OB" || vr == "OW";
        return number(group) + number(tag) + vr +
               (is_long ? std::string(2, '\0') + number(static_cast<std::uint32_t>(value.size()))
                        : number(static_cast<std::uint16_t>(value.size()))) +
               value;
    };
    const auto text = [&](std::uint16_t group, std::uint16_t tag, const std::string& vr, const std::string& value) {
        return value.empty() ? "" : element(group, tag, vr, value);
    };
    const auto word = [&](std::uint16_t group, std::uint16_t tag, int value) {
        return element(group, tag, "US", number(static_cast<std::uint16_t>(value)));
    };
    const std::string image_class = "1.2.840.10008.5.1.4.1.1.2";
    const std::string meta = element(2, 0x0001, "OB", std::string("\0\1", 2)) + element(2, 0x0002, "UI", image_class) +
                             element(2, 0x0003, "UI", f.instance_uid) +
                             element(2, 0x0010, "UI", f.rle ? "1.2.840.10008.1.2.5" : "1.2.840.10008.1.2.1") +
                             element(2, 0x0012, "UI", "1.2.3.4");
    std::string file = std::string(128, '\0') + "DICM" + element(2, 0, "UL", number(static_cast<std::uint32_t>(meta.size()))) + meta;
    file += element(0x0008, 0x0016, "UI", image_class) + element(0x0008, 0x0018, "UI", f.instance_uid) +
            text(0x0008, 0x0060, "CS", f.modality) + text(0x0008, 0x103e, "LO", "a series");
    file += text(0x0020, 0x000d, "UI", "1.2") + text(0x0020, 0x000e, "UI", f.series) +
            text(0x0020, 0x0012, "IS", std::to_string(f.acquisition)) + text(0x0020, 0x0013, "IS", std::to_string(f.instance)) +
            text(0x0020, 0x0032, "DS", f.position) + text(0x0020, 0x0037, "DS", f.orientation);
    file += word(0x0028, 0x0002, f.samples) + text(0x0028, 0x0004, "CS", f.photometric) + text(0x0028, 0x0008, "IS", f.frames) +
            word(0x0028, 0x0010, f.rows) + word(0x0028, 0x0011, f.columns) + text(0x0028, 0x0030, "DS", f.spacing) +
            word(0x0028, 0x0100, 16) + word(0x0028, 0x0101, f.bits_stored) + word(0x0028, 0x0102, f.bits_stored - 1) +
            word(0x0028, 0x0103, f.is_signed) + text(0x0028, 0x1052, "DS", f.intercept) + text(0x0028, 0x1053, "DS", f.slope);
    if (!f.rle) return file + element(0x7fe0, 0x0010, "OW", f.pixels);
    const auto item = [](std::uint16_t tag, const std::string& value) {
        return number(std::uint16_t{0xfffe}) + number(tag) + number(static_cast<std::uint32_t>(value.size())) + value;
    };
    return file + number(std::uint16_t{0x7fe0}) + number(std::uint16_t{0x0010}) + "OB" + std::string(2, '\0') +
           number(std::uint32_t{0xffffffff}) + item(0xe000, "") + item(0xe000, rle_frame(f.pixels)) + item(0xe0dd, "");
}

/// Slice k of the sample.
inline DicomFields dicom_slice(const Sample& s, int k) {
    const Geometry& g = s.geometry;
    const Double3 at = g.to_world({0, 0, static_cast<double>(k)}), i = g.direction.column(0), j = g.direction.column(1);
    const std::size_t n = static_cast<std::size_t>(s.dims[0]) * s.dims[1];
    DicomFields f;
    f.instance_uid = fmt::format("1.2.3.{}", k + 1);
    f.instance = k + 1;
    f.position = fmt::format("{}\\{}\\{}", at[0], at[1], at[2]);
    f.orientation = fmt::format("{}\\{}\\{}\\{}\\{}\\{}", i[0], i[1], i[2], j[0], j[1], j[2]);
    f.spacing = fmt::format("{}\\{}", g.spacing[1], g.spacing[0]);
    f.columns = s.dims[0];
    f.rows = s.dims[1];
    f.pixels = bytes_of(std::vector<std::int16_t>(s.voxels.begin() + k * n, s.voxels.begin() + (k + 1) * n));
    return f;
}

} // namespace clvr::test

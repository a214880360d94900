// Encodings and files of the formats with text headers, written from their own documents.
#pragma once
#include "tests/io/volume_writers.hpp"

#include <bzlib.h>
#include <lz4.h>
#include <numeric>

namespace clvr::test {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline std::string bzip2ed(const std::string& bytes) {
    std::string packed(bytes.size() + bytes.size() / 100 + 700, '\0');
    auto size = static_cast<unsigned>(packed.size());
    EXPECT_EQ(BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(bytes.data()), static_cast<unsigned>(bytes.size()), 9, 0, 0),
              BZ_OK);
    packed.resize(size);
    return packed;
}

/// Two digits a byte, a line of 40 bytes.
inline std::string hexed(const std::string& bytes) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); ++i)
        text += fmt::format("{:02x}{}", static_cast<unsigned char>(bytes[i]), i % 40 == 39 ? "\n" : "");
    return text;
}

inline std::string base64(const std::string& bytes) {
    static const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

template <class T>
std::string text_of(const std::vector<T>& values) {
    std::string text;
    for (const T v : values) text += fmt::format("{}\n", v);
    return text;
}

/// How the values of a .vti are written.
struct VtiFields {
    enum Mode { ascii, binary, appended_raw, appended_base64 } mode = appended_raw;
    enum Compressor { none, zlib, lz4 } compressor = none;
    bool big = false, wide_header = false;
    std::size_t block = 48; ///< bytes of each compressed block
    std::array<int, 3> first{0, 0, 0};
};

/// An array of a .vti: its values as bytes (in the file's byte order) and, for mode ascii, as text.
struct VtiArray {
    std::string name, type, bytes, text;
    int components = 1;
    bool of_cells = false;
};
template <class T>
VtiArray vti_array(const std::string& name, const std::string& type, const std::vector<T>& values, const VtiFields& f) {
    return {name, type, bytes_of(values, f.big), text_of(values)};
}

/// The values with their numbers before them.
inline std::string vti_values(const std::string& bytes, const VtiFields& f) {
    const auto head = [&](const std::vector<std::uint64_t>& numbers) {
        return f.wide_header ? bytes_of(numbers, f.big) : bytes_of(std::vector<std::uint32_t>(numbers.begin(), numbers.end()), f.big);
    };
    const bool encoded = f.mode == VtiFields::binary || f.mode == VtiFields::appended_base64;
    if (f.compressor == VtiFields::none) { // encoded together
        const std::string all = head({bytes.size()}) + bytes;
        return encoded ? base64(all) : all;
    }
    std::vector<std::uint64_t> numbers{(bytes.size() + f.block - 1) / f.block, f.block, bytes.size() % f.block};
    std::string packed;
    for (std::size_t at = 0; at < bytes.size(); at += f.block) {
        const std::string block = bytes.substr(at, f.block);
        std::string one;
        if (f.compressor == VtiFields::zlib) {
            one = deflated(block, false);
        } else {
            one.resize(static_cast<std::size_t>(LZ4_compressBound(static_cast<int>(block.size()))));
            one.resize(static_cast<std::size_t>(
                LZ4_compress_default(block.data(), one.data(), static_cast<int>(block.size()), static_cast<int>(one.size()))));
        }
        numbers.push_back(one.size());
        packed += one;
    }
    return encoded ? base64(head(numbers)) + base64(packed) : head(numbers) + packed; // encoded apart
}

/// A point range as VTK writes it.
inline std::string vti_extent(const std::array<int, 3>& first, const Int3& points) {
    return fmt::format("{} {} {} {} {} {}", first[0], first[0] + points[0] - 1, first[1], first[1] + points[1] - 1, first[2],
                       first[2] + points[2] - 1);
}

struct VtiPiece {
    std::array<int, 3> first;
    Int3 points;
    std::vector<VtiArray> arrays;
};

constexpr const char* vti_tail = "\n  </AppendedData>\n</VTKFile>\n"; ///< behind appended data

/// `image`: the attributes of ImageData; `scalars`: the active array of points, if any.
inline std::string vti(const std::string& image, const std::vector<VtiPiece>& pieces, const VtiFields& f, const std::string& scalars = {}) {
    static const std::array<std::string, 3> compressors{"", " compressor=\"vtkZLibDataCompressor\"",
                                                        " compressor=\"vtkLZ4DataCompressor\""};
    std::string file = fmt::format(
                    "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"{}\" header_type=\"{}\"{}>\n"
                    "  <ImageData {}>\n    <FieldData><Array type=\"String\" Name=\"note\" NumberOfTuples=\"1\" format=\"ascii\">104 "
                    "0</Array></FieldData>\n",
                    f.big ? "BigEndian" : "LittleEndian", f.wide_header ? "UInt64" : "UInt32",
                    compressors[static_cast<std::size_t>(f.compressor)], image),
                appended;
    const bool in_line = f.mode == VtiFields::ascii || f.mode == VtiFields::binary;
    for (const VtiPiece& p : pieces) {
        file += fmt::format("    <Piece Extent=\"{}\">\n", vti_extent(p.first, p.points));
        for (const bool cells : {false, true}) {
            file +=
                cells ? "      <CellData>\n" : fmt::format("      <PointData{}>\n", scalars.empty() ? "" : " Scalars=\"" + scalars + "\"");
            for (const VtiArray& a : p.arrays) {
                if (a.of_cells != cells) continue;
                file += fmt::format("        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"{}\"", a.type, a.name,
                                    a.components,
                                    f.mode == VtiFields::ascii ? "ascii"
                                    : in_line                  ? "binary"
                                                               : "appended");
                if (in_line)
                    file += ">\n" + (f.mode == VtiFields::ascii ? a.text : vti_values(a.bytes, f)) + "\n        </DataArray>\n";
                else
                    file += fmt::format(" offset=\"{}\"/>\n", appended.size());
                if (!in_line) appended += vti_values(a.bytes, f);
            }
            file += cells ? "      </CellData>\n" : "      </PointData>\n";
        }
        file += "    </Piece>\n";
    }
    file += "  </ImageData>\n";
    if (in_line) return file + "</VTKFile>";
    return file + fmt::format("  <AppendedData encoding=\"{}\">\n   _", f.mode == VtiFields::appended_raw ? "raw" : "base64") + appended +
           vti_tail;
}

/// Attributes of ImageData for the sample; its first voxel keeps its place when the extent does not start at 0.
inline std::string vti_image(const Sample& s, const VtiFields& f) {
    const Geometry& g = s.geometry;
    const Double3 origin =
        g.to_world({static_cast<double>(-f.first[0]), static_cast<double>(-f.first[1]), static_cast<double>(-f.first[2])});
    std::string direction;
    for (const auto& row : g.direction.row) direction += fmt::format("{} {} {} ", row[0], row[1], row[2]);
    return fmt::format("WholeExtent=\"{}\" Origin=\"{} {} {}\" Spacing=\"{} {} {}\" Direction=\"{}\"", vti_extent(f.first, s.dims),
                       origin[0], origin[1], origin[2], g.spacing[0], g.spacing[1], g.spacing[2], direction);
}
inline std::string vti(const Sample& s, const VtiFields& f) {
    return vti(vti_image(s, f), {{f.first, s.dims, {vti_array("density", "Int16", s.voxels, f)}}}, f, "density");
}

/// The slices of the sample in files of their own beside `header`; returns their names.
inline std::vector<std::string> write_slices(const Folder& to, const Sample& s, const std::string& pattern) {
    std::vector<std::string> names;
    const std::string bytes = bytes_of(s.voxels);
    const std::size_t slice = bytes.size() / static_cast<std::size_t>(s.dims[2]);
    for (std::size_t k = 0; k < static_cast<std::size_t>(s.dims[2]); ++k) {
        names.push_back(fmt::format(fmt::runtime(pattern), k));
        write(to / names.back(), bytes.substr(k * slice, slice));
    }
    return names;
}
inline std::string lines_of(const std::vector<std::string>& names) {
    return std::accumulate(names.begin(), names.end(), std::string(),
                           [](const std::string& all, const std::string& n) { return all + n + "\n"; });
}

} // namespace clvr::test

// DICOM files of every syntax, element by element: what tests change in a slice, enhanced images, mosaics.
#pragma once
#include "tests/io/volume_writers.hpp"

#include <algorithm>
#include <map>

namespace clvr::test {

/// How a data set is written.
struct DicomSyntax {
    bool implicit = false, big = false, deflated = false;
    bool preamble = true, meta = true; ///< 128 bytes and DICM; group 2
    std::string uid() const {
        return deflated ? "1.2.840.10008.1.2.1.99" : implicit ? "1.2.840.10008.1.2" : big ? "1.2.840.10008.1.2.2" : "1.2.840.10008.1.2.1";
    }
};

/// A data set or an item: values by tag, little-endian until they are written.
class DicomSet {
public:
    DicomSet& raw(std::uint32_t tag, const std::string& vr, const std::string& bytes) {
        elements_[tag] = {vr, bytes, {}};
        return *this;
    }
    /// An empty text is an empty element.
    DicomSet& text(std::uint32_t tag, const std::string& vr, std::string value) {
        if (value.size() % 2) value += vr == "UI" ? '\0' : ' ';
        return raw(tag, vr, value);
    }
    DicomSet& word(std::uint32_t tag, int value, const std::string& vr = "US") {
        return raw(tag, vr, number(static_cast<std::uint16_t>(value)));
    }
    DicomSet& real(std::uint32_t tag, double value) { return raw(tag, "FD", number(value)); }
    DicomSet& sequence(std::uint32_t tag, const std::vector<DicomSet>& items) {
        elements_[tag] = {"SQ", {}, items};
        return *this;
    }
    DicomSet& erase(std::uint32_t tag) {
        elements_.erase(tag);
        return *this;
    }

    /// Sequences and items of undefined length where `undefined`. Compressed pixels (7FE0,0010) are given with their items.
    std::string bytes(const DicomSyntax& s, bool undefined = false) const {
        std::string all;
        for (const auto& [tag, e] : elements_) {
            std::string value = swapped(e, s.big);
            if (e.vr == "SQ")
                for (const DicomSet& item : e.items) {
                    const std::string inside = item.bytes(s, undefined);
                    value += head(0xfffee000, "", undefined ? ~0u : static_cast<std::uint32_t>(inside.size()), s) + inside;
                    if (undefined) value += head(0xfffee00d, "", 0, s);
                }
            const bool open = (undefined && e.vr == "SQ") || e.vr == compressed;
            if (open && e.vr == "SQ") value += head(0xfffee0dd, "", 0, s);
            all += head(tag, e.vr == compressed ? "OB" : e.vr, open ? ~0u : static_cast<std::uint32_t>(value.size()), s) + value;
        }
        return all;
    }
    static constexpr const char* compressed = "compressed";

private:
    struct Element {
        std::string vr, bytes;
        std::vector<DicomSet> items;
    };
    static std::string swapped(const Element& e, bool big) {
        static const std::map<std::string, std::size_t> sizes{{"US", 2}, {"SS", 2}, {"OW", 2}, {"UL", 4}, {"FL", 4},
                                                              {"OF", 4}, {"FD", 8}, {"OD", 8}, {"OV", 8}};
        std::string bytes = e.bytes;
        const auto size = sizes.find(e.vr);
        if (big && size != sizes.end())
            for (std::size_t i = 0; i + size->second <= bytes.size(); i += size->second)
                std::reverse(bytes.begin() + static_cast<long>(i), bytes.begin() + static_cast<long>(i + size->second));
        return bytes;
    }
    static std::string head(std::uint32_t tag, const std::string& vr, std::uint32_t length, const DicomSyntax& s) {
        const std::string name = number(static_cast<std::uint16_t>(tag >> 16), s.big) + number(static_cast<std::uint16_t>(tag), s.big);
        if (s.implicit || vr.empty()) return name + number(length, s.big);
        const bool is_long = vr == "OB" || vr == "OW" || vr == "OF" || vr == "OD" || vr == "OV" || vr == "SQ" || vr == "UN";
        return name + vr + (is_long ? std::string(2, '\0') + number(length, s.big) : number(static_cast<std::uint16_t>(length), s.big));
    }
    std::map<std::uint32_t, Element> elements_;
};

/// Deflate without header or checksum.
inline std::string raw_deflated(const std::string& bytes) {
    const std::string zlib = deflated(bytes, false);
    return zlib.substr(2, zlib.size() - 6);
}

/// A whole file. `transfer_syntax`: of compressed pixels; else that of the syntax.
inline std::string dicom_file(const DicomSet& set, const DicomSyntax& s = {}, bool undefined = false,
                              const std::string& transfer_syntax = {}) {
    DicomSet meta;
    meta.raw(0x00020001, "OB", std::string("\0\1", 2)).text(0x00020010, "UI", transfer_syntax.empty() ? s.uid() : transfer_syntax);
    const std::string group = meta.bytes({});
    const std::string length = DicomSet().raw(0x00020000, "UL", number(static_cast<std::uint32_t>(group.size()))).bytes({});
    const std::string data = set.bytes(s, undefined);
    return (s.preamble ? std::string(128, '\0') + "DICM" : "") + (s.meta ? length + group : "") + (s.deflated ? raw_deflated(data) : data);
}

/// Compressed pixels: an item each, the offset table first.
inline std::string dicom_items(const std::vector<std::string>& values) {
    std::string all;
    for (const std::string& v : values)
        all += number(std::uint16_t{0xfffe}) + number(std::uint16_t{0xe000}) + number(static_cast<std::uint32_t>(v.size())) + v;
    return all + number(std::uint16_t{0xfffe}) + number(std::uint16_t{0xe0dd}) + number(std::uint32_t{0});
}

inline std::string position_text(const Double3& at) { return fmt::format("{}\\{}\\{}", at[0], at[1], at[2]); }
inline std::string orientation_text(const Geometry& g) {
    const Double3 i = g.direction.column(0), j = g.direction.column(1);
    return fmt::format("{}\\{}\\{}\\{}\\{}\\{}", i[0], i[1], i[2], j[0], j[1], j[2]);
}

/// What every image of the sample says: 16 bits signed.
inline DicomSet dicom_image_set(const Sample& s) {
    DicomSet d;
    d.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2").text(0x00080018, "UI", "1.2.3.1").text(0x00080060, "CS", "CT");
    d.text(0x0020000e, "UI", "1.2.3").text(0x00200013, "IS", "1");
    d.word(0x00280002, 1).text(0x00280004, "CS", "MONOCHROME2").word(0x00280010, s.dims[1]).word(0x00280011, s.dims[0]);
    d.word(0x00280100, 16).word(0x00280101, 16).word(0x00280102, 15).word(0x00280103, 1);
    return d;
}
inline std::string slice_bytes(const Sample& s, int k) {
    const std::size_t n = static_cast<std::size_t>(s.dims[0]) * s.dims[1];
    return bytes_of(std::vector<std::int16_t>(s.voxels.begin() + k * n, s.voxels.begin() + (k + 1) * n));
}
inline Double3 slice_position(const Sample& s, int k) { return s.geometry.to_world({0, 0, static_cast<double>(k)}); }

/// Slice k of the sample as a file of its own.
inline DicomSet dicom_slice_set(const Sample& s, int k) {
    const Geometry& g = s.geometry;
    DicomSet d = dicom_image_set(s);
    d.text(0x00080018, "UI", fmt::format("1.2.3.{}", k + 1)).text(0x00200013, "IS", std::to_string(k + 1));
    d.text(0x00180050, "DS", fmt::format("{}", g.spacing[2]));
    d.text(0x00200032, "DS", position_text(slice_position(s, k))).text(0x00200037, "DS", orientation_text(g));
    d.text(0x00280030, "DS", fmt::format("{}\\{}", g.spacing[1], g.spacing[0]));
    return d.raw(0x7fe00010, "OW", slice_bytes(s, k));
}

/// One frame of an enhanced image.
struct EnhancedFrame {
    int slice = 0;        ///< of the sample
    DicomSet groups = {}; ///< more functional groups
    std::string slope = "1";
};
/// An enhanced image of frames with their place and rescale per frame, direction and spacing shared.
inline DicomSet enhanced_set(const Sample& s, const std::vector<EnhancedFrame>& frames) {
    const Geometry& g = s.geometry;
    DicomSet d = dicom_image_set(s);
    d.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.4.1").text(0x00280008, "IS", std::to_string(frames.size()));
    DicomSet shared;
    shared.sequence(0x00209116, {DicomSet().text(0x00200037, "DS", orientation_text(g))});
    shared.sequence(0x00289110, {DicomSet()
                                     .text(0x00180050, "DS", fmt::format("{}", g.spacing[2]))
                                     .text(0x00280030, "DS", fmt::format("{}\\{}", g.spacing[1], g.spacing[0]))});
    std::vector<DicomSet> items;
    std::string pixels;
    for (const EnhancedFrame& f : frames) {
        DicomSet item = f.groups;
        item.sequence(0x00209113, {DicomSet().text(0x00200032, "DS", position_text(slice_position(s, f.slice)))});
        item.sequence(0x00289145, {DicomSet().text(0x00281052, "DS", "0").text(0x00281053, "DS", f.slope)});
        items.push_back(item);
        pixels += slice_bytes(s, f.slice);
    }
    return d.sequence(0x52009229, {shared}).sequence(0x52009230, items).raw(0x7fe00010, "OW", pixels);
}
/// All slices of the sample, the last first.
inline std::vector<EnhancedFrame> all_frames(const Sample& s) {
    std::vector<EnhancedFrame> frames;
    for (int k = s.dims[2] - 1; k >= 0; --k) frames.push_back({k});
    return frames;
}

/// The private header of Siemens in its second form (or its first): tags with texts.
inline std::string csa_header(const std::vector<std::pair<std::string, std::vector<std::string>>>& tags, bool second = true) {
    std::string b = second ? std::string("SV10\4\3\2\1") : "";
    b += number(static_cast<std::uint32_t>(tags.size())) + number(std::uint32_t{77});
    constexpr std::uint32_t slots = 6; // of each tag; those not used are empty
    for (const auto& [name, texts] : tags) {
        std::string padded = name;
        padded.resize(64);
        b += padded + number(static_cast<std::uint32_t>(texts.size())) + std::string("DS\0\0", 4) + number(std::uint32_t{3}) +
             number(slots) + number(std::uint32_t{77});
        for (std::uint32_t i = 0; i < slots; ++i) {
            std::string text = i < texts.size() ? texts[i] + '\0' : "";
            const auto size = static_cast<std::uint32_t>(text.size());
            text.resize((text.size() + 3) / 4 * 4);
            const std::uint32_t other = 77;
            b += second ? number(size) + number(size) + number(other) + number(size)
                        : number(size + slots) + number(other) + number(other) + number(other);
            b += text;
        }
    }
    return b + std::string(b.size() % 2, '\0');
}

/// The sample as one Siemens mosaic, with its private header.
inline DicomSet mosaic_set(const Sample& s, bool second_form = true) {
    const int edge = static_cast<int>(std::ceil(std::sqrt(s.dims[2]))), nx = s.dims[0], ny = s.dims[1];
    std::vector<std::int16_t> picture(static_cast<std::size_t>(edge * nx) * static_cast<std::size_t>(edge * ny));
    for (int k = 0; k < s.dims[2]; ++k)
        for (int j = 0; j < ny; ++j)
            for (int i = 0; i < nx; ++i)
                picture[static_cast<std::size_t>((k / edge * ny + j) * edge * nx + k % edge * nx + i)] =
                    s.voxels[static_cast<std::size_t>((k * ny + j) * nx + i)];
    DicomSet d = dicom_slice_set(s, 0);
    // Around the same centre as the first slice, as large as the mosaic.
    d.text(0x00200032, "DS", position_text(s.geometry.to_world({-0.5 * (edge - 1) * nx, -0.5 * (edge - 1) * ny, 0})));
    d.text(0x00080008, "CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC").text(0x00080070, "LO", "SIEMENS");
    d.text(0x00180088, "DS", fmt::format("{}", s.geometry.spacing[2])).word(0x00280010, edge * ny).word(0x00280011, edge * nx);
    const Double3 n = s.geometry.direction.column(2);
    d.raw(0x00290010, "LO", "SIEMENS CSA HEADER")
        .raw(0x00291010, "OB",
             csa_header({{"EchoLinePosition", {"32"}},
                         {"NumberOfImagesInMosaic", {std::to_string(s.dims[2])}},
                         {"SliceNormalVector", {std::to_string(n[0]), std::to_string(n[1]), std::to_string(n[2])}}},
                        second_form));
    return d.raw(0x7fe00010, "OW", bytes_of(picture));
}

} // namespace clvr::test

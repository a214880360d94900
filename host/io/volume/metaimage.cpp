// MetaImage, attached (.mha) and detached (.mhd).
#include "host/io/volume/axes.hpp"
#include "host/io/volume/file_list.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/length_unit.hpp"
#include "host/io/volume/metaimage_header.hpp"
#include "host/io/volume/payload.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

namespace clvr {

namespace {

SampleType sample_type(const std::string& name, Voxels& v) {
    static const std::map<std::string, SampleType> types{
        {"MET_UCHAR", SampleType::u8},       {"MET_CHAR", SampleType::i8},       {"MET_ASCII_CHAR", SampleType::i8},
        {"MET_USHORT", SampleType::u16},     {"MET_SHORT", SampleType::i16},     {"MET_UINT", SampleType::u32},
        {"MET_INT", SampleType::i32},        {"MET_ULONG", SampleType::u32},     {"MET_LONG", SampleType::i32},
        {"MET_ULONG_LONG", SampleType::u64}, {"MET_LONG_LONG", SampleType::i64}, {"MET_FLOAT", SampleType::f32},
        {"MET_DOUBLE", SampleType::f64}};
    const auto t = types.find(name);
    if (t == types.end())
        bad_file(v.source,
                 "ElementType {:.40} is not read: expected MET_UCHAR, MET_CHAR, MET_USHORT, MET_SHORT, MET_UINT, MET_INT, MET_FLOAT or "
                 "MET_DOUBLE",
                 name);
    if (name == "MET_LONG" || name == "MET_ULONG") v.decisions.push_back(fmt::format("{} is read as 32 bits, as MetaIO writes it", name));
    return t->second;
}

/// Of several tags with the same meaning, the first that the header has. All that it has are checked; a contradiction is noted.
template <class Parse>
std::optional<std::vector<double>> first_of(const MetaHeader& h, std::initializer_list<const char*> tags, const Parse& parse, Voxels& v) {
    std::optional<std::vector<double>> taken;
    const char* by = nullptr;
    for (const char* tag : tags) {
        if (!h.has(tag)) continue;
        const std::vector<double> values = parse(h.tag(tag), tag);
        if (!taken) {
            taken = values;
            by = tag;
        } else if (values != *taken) {
            v.notes.push_back(fmt::format("{} and {} differ: {} is taken", by, tag, by));
        }
    }
    return taken;
}

/// Sets v.geometry from the tags of `n` axes, in millimetres and LPS.
void place(const MetaHeader& h, std::size_t n, Voxels& v) {
    const auto numbers = [&](std::size_t count) {
        return [&, count](const std::string& text, const char* tag) { return parse_finite(text, count, tag, v.source); };
    };
    const auto spacing = first_of(
        h, {"ElementSpacing", "ElementSize"},
        [&](const std::string& text, const char* tag) { return parse_spacing(text, n, tag, v.source); }, v);
    if (!spacing) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed");
    const auto matrix = first_of(h, {"TransformMatrix", "Rotation", "Orientation"}, numbers(n * n), v);
    const auto origin = first_of(h, {"Origin", "Position", "Offset"}, numbers(n), v);
    const std::string unit = h.tag("DistanceUnits"), anatomy = h.tag("AnatomicalOrientation");
    const double unit_mm = unit == "?" ? 1 : unit_or_millimetre(unit, v.notes);
    if (!matrix && n >= 3 && anatomy.find('?') == std::string::npos && !anatomy.empty() && anatomy != "RAI")
        v.notes.push_back(
            fmt::format("AnatomicalOrientation {:.20} is not used: without a TransformMatrix the axes are taken as LPS", anatomy));
    Geometry& g = v.geometry;
    for (std::size_t j = 0; j < std::min<std::size_t>(3, n); ++j) {
        if (spacing) g.spacing[j] = (*spacing)[j] * unit_mm;
        if (origin) g.origin[j] = (*origin)[j] * unit_mm;
        if (matrix) // the axes one after another
            for (std::size_t i = 0; i < 3; ++i) g.direction.row[i][j] = i < n ? (*matrix)[j * n + i] : 0.0;
    }
    settle_axes(g);
    complete_axes(g, static_cast<int>(std::min<std::size_t>(3, n)));
    check_geometry(g, v.source);
}

double number_of(const MetaHeader& h, const char* tag, double fallback, const std::string& path) {
    return h.has(tag) ? parse_finite(h.tag(tag), 1, tag, path).front() : fallback;
}

/// The data files in order: of a list ("LIST", "LIST 2D"), of a pattern ("name%03d.raw min max step"), or one.
std::vector<std::string> data_files(const MetaHeader& h, const std::vector<std::int64_t>& sizes, const std::string& path) {
    const std::string& value = h.required("ElementDataFile", path);
    if (lower_case(value) == "local") return {path};
    std::vector<std::string> names;
    std::int64_t subdim = std::max<std::int64_t>(static_cast<std::int64_t>(sizes.size()) - 1, 1);
    if (value == "LIST" || value.rfind("LIST ", 0) == 0) {
        names = h.listed;
        std::string axes = value.substr(4);
        if (!axes.empty() && (axes.back() == 'D' || axes.back() == 'd')) axes.pop_back();
        if (!axes.empty()) subdim = parse_integers(axes, 1, 1, "the number behind LIST", path).front();
    } else if (const auto numbered = numbered_files(value, 0);
               numbered && numbered->numbers.size() <= 3 && !std::filesystem::exists(std::filesystem::path(path).parent_path() / value)) {
        const auto& n = numbered->numbers; // first, last, step: the last ones may be left out
        const std::int64_t first = n.empty() ? 1 : n[0];
        names = names_of(numbered->pattern, first, n.size() > 1 ? n[1] : first + sizes.back() - 1, n.size() > 2 ? n[2] : 1, path);
    } else {
        return {beside(path, value)};
    }
    check_file_count(names.size(), sizes, subdim, path);
    for (std::string& name : names) name = beside(path, name);
    return names;
}

bool is_big_endian(const MetaHeader& h, const std::string& path) {
    constexpr const char *binary = "BinaryDataByteOrderMSB", *element = "ElementByteOrderMSB";
    if (h.has(binary) && h.has(element) && h.is_true(binary, false) != h.is_true(element, false))
        bad_file(path, "{} and {} contradict each other", binary, element);
    return h.is_true(binary, false) || h.is_true(element, false);
}

Payload payload_of(const MetaHeader& h, const std::vector<std::int64_t>& sizes, const std::string& path) {
    Payload p;
    p.files = data_files(h, sizes, path);
    const bool local = p.files.front() == path;
    p.encoding = h.is_true("CompressedData", false) ? Payload::Encoding::deflated
                 : h.is_true("BinaryData", true)    ? Payload::Encoding::raw
                                                    : Payload::Encoding::text;
    p.big_endian = is_big_endian(h, path);
    const auto skip = parse_integers(h.tag("HeaderSize", "0"), 1, -1, "HeaderSize", path).front();
    if (skip < 0 && p.encoding != Payload::Encoding::raw) bad_file(path, "HeaderSize -1 is for binary data without compression alone");
    if (skip > 0 && local && static_cast<std::uint64_t>(skip) < h.bytes)
        bad_file(path, "HeaderSize {} lies within the header, which has {} bytes", skip, h.bytes);
    // Of the file, before anything is decoded.
    p.offset = skip > 0 ? static_cast<std::uint64_t>(skip) : local ? h.bytes : 0;
    p.byte_skip = std::min<std::int64_t>(skip, 0);
    if (p.encoding == Payload::Encoding::deflated && p.files.size() == 1 && h.has("CompressedDataSize")) {
        const auto packed = parse_integers(h.tag("CompressedDataSize"), 1, 0, "CompressedDataSize", path).front();
        const std::uint64_t size = std::filesystem::file_size(p.files.front());
        if (p.offset > size || static_cast<std::uint64_t>(packed) > size - p.offset)
            bad_file(path, "expected {} bytes of compressed voxels, found {}: the file is truncated", packed,
                     size - std::min(size, p.offset));
    }
    return p;
}

} // namespace

Voxels read_metaimage(const std::string& path, const VolumeReadOptions& options) {
    const MetaHeader h = parse_metaimage_header(path);
    if (const std::string kind = h.tag("ObjectType", "Image"); kind != "Image")
        bad_file(path, "the file holds a MetaIO {:.40}: expected an Image", kind);
    const auto dimensions = parse_integers(h.required("NDims", path), 1, 1, "NDims", path).front();
    if (dimensions < 2 || dimensions > 4) bad_file(path, "the image has {} dimensions: expected 2, 3, or 4 with time", dimensions);
    const auto sizes = parse_integers(h.required("DimSize", path), static_cast<std::size_t>(dimensions), 1, "DimSize", path);

    Voxels v;
    v.source = path;
    const SampleType type = sample_type(h.required("ElementType", path), v);
    describe(v, path, "MetaImage", type);
    v.dims = check_dims({sizes[0], sizes[1], sizes.size() > 2 ? sizes[2] : 1}, 1, type, path).dims;
    place(h, sizes.size(), v);
    v.slope = number_of(h, "ElementToIntensityFunctionSlope", 1, path);
    v.intercept = number_of(h, "ElementToIntensityFunctionOffset", 0, path);
    if (const std::string m = h.tag("Modality"); m.rfind("MET_MOD_", 0) == 0 && m != "MET_MOD_UNKNOWN" && m != "MET_MOD_OTHER")
        v.modality = m.substr(8);

    const auto channels = parse_integers(h.tag("ElementNumberOfChannels", "1"), 1, 1, "ElementNumberOfChannels", path).front();
    const std::int64_t frames = sizes.size() > 3 ? sizes[3] : 1;
    check_frame(options.frame, frames, path);
    v.frames = say_frame(options.frame, frames, "the fourth axis", v.decisions);
    const std::vector<OtherAxis> others{{channels, chosen_channel(options, channels, path, v.notes), 1},
                                        {frames, options.frame, static_cast<std::int64_t>(v.count())}};
    read_payload(payload_of(h, sizes, path), type, others, v);
    return v;
}

} // namespace clvr

// MetaImage: the tags of the header that decide what the file must hold (itk.org/Wiki/ITK/MetaIO/Documentation).
#include "host/io/volume/itk.hpp"
#include "host/io/volume/readers.hpp"

#include <filesystem>
#include <map>

namespace clvr {

namespace {

constexpr std::size_t greatest_header = std::size_t{1} << 16;

struct MetaHeader {
    std::map<std::string, std::string> tags;
    std::uint64_t bytes = 0; ///< ElementDataFile is the last line; what follows are voxels
};

MetaHeader parse_header(const std::string& path) {
    const std::string text = read_head(path, greatest_header);
    MetaHeader h;
    for (std::size_t at = 0; at < text.size();) {
        const auto end = std::min(text.find('\n', at), text.size());
        const std::string_view line = trimmed(std::string_view(text).substr(at, end - at));
        at = std::min(end + 1, text.size());
        if (line.empty()) continue;
        const auto equals = line.find('=');
        const std::string tag(trimmed(line.substr(0, equals)));
        // MetaIO keeps tags and values in buffers of fixed size.
        if (equals == std::string_view::npos || tag.empty() || tag.size() > 100 || line.size() > 500)
            bad_file(path, "\"{:.40}\" is no line of a MetaImage header (Tag = value)", line);
        if (!h.tags.emplace(tag, trimmed(line.substr(equals + 1))).second) bad_file(path, "the tag {} stands twice in the header", tag);
        if (tag == "ElementDataFile") {
            h.bytes = at;
            return h;
        }
    }
    bad_file(path, "the MetaImage header has no ElementDataFile: the file is truncated or damaged");
}

const std::string& required(const MetaHeader& h, const char* tag, const std::string& path) {
    const auto t = h.tags.find(tag);
    if (t == h.tags.end()) bad_file(path, "the MetaImage header has no {}", tag);
    return t->second;
}

std::string optional_tag(const MetaHeader& h, const char* tag, std::string fallback = {}) {
    const auto t = h.tags.find(tag);
    return t == h.tags.end() ? fallback : t->second;
}

bool is_true(const MetaHeader& h, const char* tag, bool fallback) {
    const std::string value = lower_case(optional_tag(h, tag, fallback ? "true" : "false"));
    return !value.empty() && (value[0] == 't' || value[0] == '1' || value[0] == 'y');
}

SampleType sample_type(const std::string& name, const std::string& path) {
    static const std::map<std::string, SampleType> types{{"MET_UCHAR", SampleType::u8},       {"MET_CHAR", SampleType::i8},
                                                         {"MET_USHORT", SampleType::u16},     {"MET_SHORT", SampleType::i16},
                                                         {"MET_UINT", SampleType::u32},       {"MET_INT", SampleType::i32},
                                                         {"MET_ULONG_LONG", SampleType::u64}, {"MET_LONG_LONG", SampleType::i64},
                                                         {"MET_FLOAT", SampleType::f32},      {"MET_DOUBLE", SampleType::f64}};
    const auto t = types.find(name);
    if (t == types.end())
        bad_file(
            path,
            "ElementType {} is not read: expected MET_UCHAR, MET_CHAR, MET_USHORT, MET_SHORT, MET_UINT, MET_INT, MET_FLOAT or MET_DOUBLE",
            name);
    return t->second;
}

/// ITK would take 1 mm for what is not a number. MetaIO's names of one thing: the last one that a file gives wins, so each is checked.
void check_axes(Container& c, const MetaHeader& h, std::size_t dimensions, const std::string& path) {
    bool given = false;
    for (const char* tag : {"ElementSpacing", "ElementSize"}) {
        if (!h.tags.count(tag)) continue;
        check_spacing(h.tags.at(tag), dimensions, tag, path);
        given = true;
    }
    if (!given) c.notes.push_back("the file gives no voxel spacing: 1 mm is assumed");
    for (const char* tag : {"TransformMatrix", "Rotation", "Orientation"})
        if (h.tags.count(tag))
            if (const auto m = parse_numbers(h.tags.at(tag)); !m || m->size() != dimensions * dimensions)
                bad_file(path, "{} is \"{:.60}\": expected {} numbers", tag, h.tags.at(tag), dimensions * dimensions);
    for (const char* tag : {"Offset", "Position", "Origin", "CenterOfRotation"})
        if (h.tags.count(tag))
            if (const auto o = parse_numbers(h.tags.at(tag)); !o || o->size() != dimensions)
                bad_file(path, "{} is \"{:.60}\": expected {} numbers", tag, h.tags.at(tag), dimensions);
}

double number_of(const MetaHeader& h, const char* tag, double fallback, const std::string& path) {
    if (!h.tags.count(tag)) return fallback;
    const auto values = parse_numbers(h.tags.at(tag));
    if (!values || values->size() != 1) bad_file(path, "{} is \"{:.60}\": expected a number", tag, h.tags.at(tag));
    return values->front();
}

void place_payload(Container& c, const MetaHeader& h, const std::string& path) {
    const std::string data = required(h, "ElementDataFile", path);
    if (data == "LIST" || data.rfind("LIST ", 0) == 0 || data.find('%') != std::string::npos)
        bad_file(path, "voxels in many files (ElementDataFile = {:.40}) are not read: save the volume as one .mha", data);
    const bool local = data == "LOCAL" || data == "Local" || data == "local";
    c.data_path = local ? path : beside(path, data);
    c.offset = local ? h.bytes : 0;
    if (is_true(h, "CompressedData", false))
        c.coding = Container::Coding::deflated;
    else if (!is_true(h, "BinaryData", true))
        c.coding = Container::Coding::text;
    const std::uint64_t size = std::filesystem::file_size(c.data_path), bytes = check_dims(c.dims, c.frames, c.type, path).bytes;
    const auto skip = parse_integers(optional_tag(h, "HeaderSize", "0"), 1, -1, "HeaderSize", path).front();
    if (skip != 0 && (local || c.coding != Container::Coding::plain)) bad_file(path, "HeaderSize {} is not read here: expected 0", skip);
    if (skip >= 0)
        c.offset += static_cast<std::uint64_t>(skip);
    else // the voxels are the last bytes of the file
        c.offset = size >= bytes ? size - bytes : size;
    if (c.coding == Container::Coding::deflated && h.tags.count("CompressedDataSize")) {
        const auto packed = parse_integers(h.tags.at("CompressedDataSize"), 1, 0, "CompressedDataSize", path).front();
        if (c.offset > size || static_cast<std::uint64_t>(packed) > size - c.offset)
            bad_file(path, "expected {} bytes of compressed voxels, found {}: the file is truncated", packed,
                     size - std::min(size, c.offset));
    }
    if (c.coding == Container::Coding::plain && size > c.offset && size - c.offset > bytes)
        c.notes.push_back(fmt::format("{} bytes after the voxels were ignored: is the header right?", size - c.offset - bytes));
}

} // namespace

Voxels read_metaimage(const std::string& path, const VolumeReadOptions& options) {
    const MetaHeader h = parse_header(path);
    if (const std::string kind = optional_tag(h, "ObjectType", "Image"); kind != "Image")
        bad_file(path, "the file holds a MetaIO {}: expected an Image", kind);
    const auto dimensions = parse_integers(required(h, "NDims", path), 1, 1, "NDims", path).front();
    if (dimensions < 2 || dimensions > 4) bad_file(path, "the image has {} dimensions: expected 2, 3, or 4 with time", dimensions);
    const auto sizes = parse_integers(required(h, "DimSize", path), static_cast<std::size_t>(dimensions), 1, "DimSize", path);
    if (const auto channels =
            parse_integers(optional_tag(h, "ElementNumberOfChannels", "1"), 1, 1, "ElementNumberOfChannels", path).front();
        channels > 1)
        bad_file(path, "each voxel has {} values: clvr renders scalar volumes, extract one channel", channels);

    Container c;
    c.type = sample_type(required(h, "ElementType", path), path);
    for (std::size_t i = 0; i < sizes.size(); ++i) (i < 3 ? c.dims[i] : c.frames) = sizes[i];
    check_axes(c, h, sizes.size(), path);
    c.slope = number_of(h, "ElementToIntensityFunctionSlope", 1, path);
    c.intercept = number_of(h, "ElementToIntensityFunctionOffset", 0, path);
    if (const std::string m = optional_tag(h, "Modality"); m.rfind("MET_MOD_", 0) == 0 && m != "MET_MOD_UNKNOWN" && m != "MET_MOD_OTHER")
        c.modality = m.substr(8);
    if (const std::string unit = optional_tag(h, "DistanceUnits"); unit == "um")
        c.unit_mm = 1e-3;
    else if (unit == "cm")
        c.unit_mm = 10;
    place_payload(c, h, path);
    return decode_with_itk(ItkReader::metaimage, c, path, "MetaImage", options.frame);
}

} // namespace clvr

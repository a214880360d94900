// NRRD, attached and detached (teem.sourceforge.net/nrrd/format.html).
#include "host/io/volume/file_list.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/nrrd_axes.hpp"
#include "host/io/volume/payload.hpp"
#include "host/io/volume/readers.hpp"

#include <map>

namespace clvr {

namespace {

using Encoding = Payload::Encoding;

Encoding encoding_of(const NrrdHeader& h, const std::string& path) {
    static const std::map<std::string, Encoding> encodings{
        {"raw", Encoding::raw},     {"txt", Encoding::text},      {"text", Encoding::text},   {"ascii", Encoding::text},
        {"hex", Encoding::hex},     {"gzip", Encoding::deflated}, {"gz", Encoding::deflated}, {"gzi", Encoding::deflated},
        {"bzip2", Encoding::bzip2}, {"bz2", Encoding::bzip2}};
    if (!h.fields.count("encoding")) bad_file(path, "the NRRD header has no \"encoding\"");
    const auto found = encodings.find(lower_case(h.field("encoding")));
    if (found == encodings.end())
        bad_file(path, "NRRD encoding \"{:.40}\" is not read: expected raw, text, hex, gzip or bzip2", h.field("encoding"));
    return found->second;
}

/// The data files in order: of a list, of a pattern ("name%03d.raw min max step [subdim]"), or one.
std::vector<std::string> data_files(const NrrdHeader& h, const std::vector<std::int64_t>& sizes, const std::string& path) {
    const std::string value = h.field("datafile");
    if (value.empty()) return {path};
    std::vector<std::string> names;
    std::int64_t subdim = static_cast<std::int64_t>(sizes.size()) - 1;
    if (!h.listed.empty() || lower_case(value) == "list") {
        names = h.listed;
        if (value.size() > 4) subdim = parse_integers(value.substr(4), 1, 1, "the number behind LIST", path).front();
    } else if (const auto numbered = numbered_files(value, 3)) {
        // A name may end in a number, too: the numbers of the pattern are three, or four with how many axes each file has.
        const auto& n = numbered->numbers;
        names = names_of(numbered->pattern, n[0], n[1], n[2], path);
        if (n.size() == 4) subdim = n[3];
    } else {
        return {beside(path, value)};
    }
    check_file_count(names.size(), sizes, std::max<std::int64_t>(subdim, 1), path);
    for (std::string& name : names) name = beside(path, name);
    return names;
}

Payload payload_of(const NrrdHeader& h, const std::vector<std::int64_t>& sizes, SampleType type, const std::string& path) {
    Payload p;
    p.encoding = encoding_of(h, path);
    p.files = data_files(h, sizes, path);
    p.offset = h.fields.count("datafile") ? 0 : h.bytes;
    p.line_skip = parse_integers(h.field("lineskip", "0"), 1, 0, "\"line skip\"", path).front();
    p.byte_skip = parse_integers(h.field("byteskip", "0"), 1, -(std::int64_t{1} << 40), "\"byte skip\"", path).front();
    if (p.byte_skip < 0 && p.encoding != Encoding::raw) bad_file(path, "\"byte skip\" is {}: below 0 is for raw data alone", p.byte_skip);
    const std::string endian = lower_case(h.field("endian"));
    p.big_endian = endian == "big";
    if (sample_bytes(type) > 1 && p.encoding != Encoding::text && endian != "big" && endian != "little")
        bad_file(path, "\"endian\" is \"{:.40}\": expected little or big", endian);
    return p;
}

} // namespace

Voxels read_nrrd(const std::string& path, const VolumeReadOptions& options) {
    const NrrdHeader h = parse_nrrd_header(path);
    if (h.segmentation) bad_file(path, "the file is a segmentation of 3D Slicer (a label map): clvr renders measured values, not labels");
    if (!h.fields.count("type")) bad_file(path, "the NRRD header has no \"type\"");
    const auto type = parse_sample_type(lower_case(h.field("type")));
    if (!type) bad_file(path, "NRRD type \"{:.40}\" is not read: expected an integer, float or double", h.field("type"));

    Voxels v;
    describe(v, path, "NRRD", *type);
    const NrrdAxes axes = nrrd_axes(h, options, v);
    FileDims dims{1, 1, 1};
    for (std::size_t j = 0; j < axes.spatial.size(); ++j) dims[j] = axes.sizes[axes.spatial[j]];
    v.dims = check_dims(dims, 1, *type, path).dims;
    place_nrrd(h, axes, v);
    read_payload(payload_of(h, axes.sizes, *type, path), *type, axes.others, v);
    return v;
}

} // namespace clvr

// RAW volumes: bare samples, described by the file's name, a JSON sidecar or the command line.
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace clvr {

namespace {

struct Description {
    std::optional<FileDims> dims;
    std::string type, endian = "little", modality;
    Geometry geometry;
    bool has_spacing = false;
    double slope = 1, intercept = 0;
};

constexpr const char* how_to_describe =
    "name it name_WxHxD_type.raw, put a JSON file with \"dims\" and \"type\" beside it, or give --dims WxHxD --type TYPE";

/// "name", "256x256x128" and "uint16" of name_256x256x128_uint16.raw or .raw.gz, the names of the Open SciVis Datasets.
void from_name(Description& d, std::filesystem::path name) {
    if (lower_case(name.extension().string()) == ".gz") name.replace_extension();
    const std::string stem = lower_case(name.stem().string());
    const auto type = stem.rfind('_'), dims = type == std::string::npos || type == 0 ? type : stem.rfind('_', type - 1);
    if (type == std::string::npos || dims == std::string::npos) return;
    FileDims size;
    const char *at = stem.data() + dims, *const end = stem.data() + type;
    for (std::int64_t& n : size) {
        const auto [next, error] = std::from_chars(at + 1, end, n);
        if (error != std::errc() || (next != end && *next != 'x')) return;
        at = next;
    }
    if (at != end) return;
    d.dims = size;
    d.type = stem.substr(type + 1);
}

template <std::size_t N>
std::array<double, N> numbers(const nlohmann::json& j, const char* key, const std::string& where) {
    if (!j.is_array() || j.size() != N || !std::all_of(j.begin(), j.end(), [](const auto& x) { return x.is_number(); }))
        bad_file(where, "\"{}\" is not a list of {} numbers", key, N);
    std::array<double, N> values;
    for (std::size_t i = 0; i < N; ++i) values[i] = j[i].template get<double>();
    return values;
}

/// Fields: dims (or size), type, endian, spacing [mm], origin [mm, LPS], direction (9 numbers, rows), slope, intercept, modality. Others
/// are left alone, so that the metadata files of the Open SciVis Datasets serve as they are.
void from_sidecar(Description& d, const std::string& path) {
    std::ifstream in(path);
    const auto j = nlohmann::json::parse(in, nullptr, false);
    if (!j.is_object()) bad_file(path, "not a JSON object: expected {{\"dims\": [W, H, D], \"type\": \"uint8\", \"spacing\": [1, 1, 1]}}");
    for (const auto& [key, value] : j.items()) {
        if (key == "dims" || key == "size") {
            const Double3 dims = numbers<3>(value, key.c_str(), path);
            for (const double n : dims)
                if (!(n >= 1 && n < 2147483648.0) || n != static_cast<double>(static_cast<std::int64_t>(n)))
                    bad_file(path, "\"{}\" holds {:g}: expected whole numbers above 0", key, n);
            d.dims = FileDims{static_cast<std::int64_t>(dims[0]), static_cast<std::int64_t>(dims[1]), static_cast<std::int64_t>(dims[2])};
        } else if (key == "spacing") {
            d.geometry.spacing = numbers<3>(value, key.c_str(), path);
            d.has_spacing = true;
        } else if (key == "origin") {
            d.geometry.origin = numbers<3>(value, key.c_str(), path);
        } else if (key == "direction") {
            const auto m = numbers<9>(value, key.c_str(), path);
            for (std::size_t i = 0; i < 9; ++i) d.geometry.direction.row[i / 3][i % 3] = m[i];
        } else if (key == "slope" || key == "intercept") {
            if (!value.is_number()) bad_file(path, "\"{}\" is not a number", key);
            (key == "slope" ? d.slope : d.intercept) = value.get<double>();
        } else if (key == "type" || key == "endian" || key == "modality") {
            if (!value.is_string()) bad_file(path, "\"{}\" is not a text", key);
            (key == "type" ? d.type : key == "endian" ? d.endian : d.modality) = value.get<std::string>();
        }
    }
}

std::string sidecar_of(const std::string& path) {
    std::filesystem::path p(path);
    if (lower_case(p.extension().string()) == ".gz") p.replace_extension();
    return p.replace_extension(".json").string();
}

Description describe_raw(const std::string& path, const VolumeReadOptions& options) {
    Description d;
    from_name(d, std::filesystem::path(path).filename());
    if (const std::string sidecar = sidecar_of(path); std::filesystem::is_regular_file(sidecar)) from_sidecar(d, sidecar);
    if (options.dims) d.dims = FileDims{(*options.dims)[0], (*options.dims)[1], (*options.dims)[2]};
    if (!options.type.empty()) d.type = options.type;
    if (!options.endian.empty()) d.endian = options.endian;
    if (options.spacing) d.geometry.spacing = *options.spacing;
    d.has_spacing = d.has_spacing || options.spacing;
    return d;
}

} // namespace

Voxels read_raw(const std::string& path, const VolumeReadOptions& options) {
    const Description d = describe_raw(path, options);
    if (!d.dims) bad_file(path, "a RAW file does not say its size: {}", how_to_describe);
    const auto type = parse_sample_type(d.type);
    if (!type)
        bad_file(path, "\"{}\" is no type of voxels (uint8, int8, uint16, int16, uint32, int32, float32, float64): {}", d.type,
                 how_to_describe);
    if (d.endian != "little" && d.endian != "big") bad_file(path, "\"{}\" is no byte order: expected little or big", d.endian);
    check_frame(options.frame, 1, path);
    const CheckedDims dims = check_dims(*d.dims, 1, *type, path);

    Voxels v;
    describe(v, path, "RAW", *type);
    v.dims = dims.dims;
    v.geometry = d.geometry;
    v.slope = d.slope;
    v.intercept = d.intercept;
    v.modality = d.modality;
    check_geometry(v.geometry, path);
    if (!d.has_spacing) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed (--spacing sets it)");

    const auto wrong_size = [&](std::uint64_t found) {
        bad_file(path, "expected {} bytes ({} x {} x {} {}), found {}: correct --dims or --type", dims.bytes, v.dims[0], v.dims[1],
                 v.dims[2], sample_type_name(*type), found);
    };
    const bool packed = is_gzip(path);
    ByteStream stream(path, packed ? ByteStream::Coding::deflated : ByteStream::Coding::plain);
    if (packed ? stream.capacity() < dims.bytes : stream.capacity() != dims.bytes) wrong_size(packed ? stream.drain() : stream.capacity());
    read_samples(stream, *type, must_swap(d.endian == "big"), v);
    stream.drain();
    if (stream.position() != dims.bytes) wrong_size(stream.position());
    return v;
}

} // namespace clvr

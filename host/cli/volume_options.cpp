#include "host/cli/volume_options.hpp"
#include "runtime/error.hpp"

#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <vector>

namespace clvr {

namespace {

/// "256x256x128" or "0.5,0.5,1" as numbers; nothing where a part is no number.
template <class T>
std::vector<T> parts_of(const std::string& text) {
    std::vector<T> parts;
    const char *at = text.data(), *const end = at + text.size();
    while (true) {
        T value{};
        const auto [next, error] = std::from_chars(at, end, value);
        if (error != std::errc()) return {};
        parts.push_back(value);
        if (next == end) return parts;
        if (*next != 'x' && *next != ',') return {};
        at = next + 1;
    }
}

Double3 parse_spacing(const std::string& text) {
    auto s = parts_of<double>(text);
    if (s.size() == 1) s.assign(3, s.front());
    const bool usable = s.size() == 3 && std::isfinite(s[0] + s[1] + s[2]) && s[0] > 0 && s[1] > 0 && s[2] > 0;
    if (!usable)
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected SXxSYxSZ or one number, above 0, in mm", text), "--spacing");
    return {s[0], s[1], s[2]};
}

} // namespace

Int3 parse_dims(const std::string& text) {
    const auto n = parts_of<int>(text);
    if (n.size() != 3 || n[0] < 1 || n[1] < 1 || n[2] < 1)
        throw Error(ErrorKind::usage, fmt::format("is \"{}\"; expected WxHxD, for instance 256x256x128", text), "--dims");
    return {n[0], n[1], n[2]};
}

void override_reading(VolumeReadOptions& options, const VolumeReadOptions& given) {
    if (given.frame) options.frame = given.frame;
    if (given.channel) options.channel = given.channel;
    if (!given.array.empty()) options.array = given.array;
    if (!given.series.empty()) options.series = given.series;
    options.allow_gaps |= given.allow_gaps;
    options.recursive |= given.recursive;
    if (given.dims) options.dims = given.dims;
    if (given.spacing) options.spacing = given.spacing;
    if (!given.type.empty()) options.type = given.type;
    if (!given.endian.empty()) options.endian = given.endian;
}

void add_volume_options(CLI::App& command, VolumeReadOptions& options) {
    constexpr const char* group = "Reading the volume";
    command.add_option("--frame", options.frame, "Which volume of a time series, counted from 0 [0]")->type_name("N")->group(group);
    command.add_option("--channel", options.channel, "Which channel of several, counted from 0 [0, and clvr says so]")
        ->type_name("N")
        ->group(group);
    command.add_option("--array", options.array, "VTK: the data array of this name [the active one]")->type_name("NAME")->group(group);
    command.add_option("--series", options.series, "DICOM: the series with this UID [the one with the most slices that make a volume]")
        ->type_name("UID")
        ->group(group);
    command.add_flag("--allow-gaps", options.allow_gaps, "DICOM: interpolate missing slices")->group(group);
    command.add_flag("--recursive", options.recursive, "A folder: look into the folders inside it too")->group(group);
    command
        .add_option_function<std::string>(
            "--dims", [&options](const std::string& text) { options.dims = parse_dims(text); }, "RAW: size in voxels")
        ->type_name("WxHxD")
        ->group(group);
    command.add_option("--type", options.type, "RAW: type of the voxels")
        ->type_name("uint8|int8|uint16|int16|uint32|int32|float32|float64")
        ->group(group);
    command
        .add_option_function<std::string>(
            "--spacing", [&options](const std::string& text) { options.spacing = parse_spacing(text); },
            "Voxel size in mm where the file gives none (RAW, TIFF, PNG, NumPy, HDF5)")
        ->type_name("SXxSYxSZ")
        ->group(group);
    command.add_option("--endian", options.endian, "RAW: byte order [little]")->type_name("little|big")->group(group);
}

} // namespace clvr

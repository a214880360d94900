// HDF5 files, data set by data set: a child process asks the library, this one stores the samples.
#include "host/io/volume/dataset_path.hpp"
#include "host/io/volume/decoding_child.hpp"
#include "host/io/volume/hdf5_volume.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace clvr {

namespace {

using nlohmann::json;

/// What the child tells before the samples: which block of samples follows, and all that is known of it.
json to_json(const Hdf5Volume& h) {
    json size = json::array(), stride = json::array();
    for (const auto& axis : h.axis) {
        std::uint64_t step = 1;
        for (std::size_t i = axis ? *axis + 1 : 0; i < h.count.size(); ++i) step *= h.count[i];
        size.push_back(axis ? h.count[*axis] : 1);
        stride.push_back(step); // an axis that does not exist has one entry: a step over all values
    }
    const Voxels& v = h.described;
    std::vector<double> direction;
    for (const auto& row : v.geometry.direction.row) direction.insert(direction.end(), row.begin(), row.end());
    return {{"type", static_cast<int>(h.scales.empty() ? *h.data.type : SampleType::f32)},
            {"size", size},
            {"stride", stride},
            {"format", v.format},
            {"spacing", v.geometry.spacing},
            {"origin", v.geometry.origin},
            {"direction", direction},
            {"slope", v.slope},
            {"intercept", v.intercept},
            {"notes", v.notes},
            {"decisions", v.decisions}};
}

/// The same, as this process understands it.
struct Told {
    SampleType type = SampleType::u8;
    FileDims size{};
    SampleOrder order{};
    Voxels described; ///< all but dims and bytes
};

Told parse(const std::string& text, const std::string& path) {
    try {
        const json j = json::parse(text);
        Told told;
        told.type = static_cast<SampleType>(j.at("type").get<int>());
        told.size = j.at("size");
        told.order.stride = j.at("stride");
        Voxels& v = told.described;
        v.source = path;
        v.format = j.at("format");
        v.type = kept_type(told.type);
        v.geometry.spacing = j.at("spacing");
        v.geometry.origin = j.at("origin");
        for (std::size_t i = 0; i < 9; ++i) v.geometry.direction.row[i / 3][i % 3] = j.at("direction").at(i);
        v.slope = j.at("slope");
        v.intercept = j.at("intercept");
        v.notes = j.at("notes");
        v.decisions = j.at("decisions");
        return told;
    } catch (const json::exception&) {
        bad_file(path, "libhdf5 cannot read it: the file is damaged");
    }
}

/// Sends samples of the block as f32, each scaled by its entry of the slowest axis.
void send_scaled(const Hdf5File& file, const Hdf5Volume& h, const DecodingChild::Send& send) {
    const SampleType type = *h.data.type;
    std::size_t slice = 1, at = 0;
    for (const auto n : h.count) slice *= static_cast<std::size_t>(n);
    slice /= h.scales.size();
    Voxels piece;
    piece.type = VoxelType::f32;
    file.read(h.data, h.start, h.count, [&](const void* samples, std::size_t bytes) {
        const std::size_t n = bytes / sample_bytes(type);
        piece.bytes.resize(n * sizeof(float));
        store_samples(samples, type, n, piece, 0);
        auto* values = reinterpret_cast<float*>(piece.bytes.data());
        for (std::size_t i = 0; i < n; ++i, ++at) {
            const auto& [slope, intercept] = h.scales[at / slice];
            values[i] = static_cast<float>(slope * double{values[i]} + intercept);
        }
        send(values, piece.bytes.size());
    });
}

void send_volume(const DatasetPath& path, const VolumeReadOptions& options, const DecodingChild::Send& send) {
    const Hdf5File file(path.file);
    const bool whole = path.inside.empty();
    const Hdf5Volume h = whole && is_imaris(file) ? imaris_volume(file, options)
                         : whole && is_minc(file) ? minc_volume(file, options)
                                                  : plain_hdf5_volume(file, path.inside, options);
    check_geometry(h.described.geometry, path.file);
    if (!std::isfinite(h.described.slope) || !std::isfinite(h.described.intercept))
        bad_file(path.file, "its scale of values is not finite");
    const std::string text = to_json(h).dump(-1, ' ', false, json::error_handler_t::replace);
    const std::uint64_t length = text.size();
    send(&length, sizeof length);
    send(text.data(), text.size());
    if (h.scales.empty())
        file.read(h.data, h.start, h.count, send);
    else
        send_scaled(file, h, send);
}

} // namespace

Voxels read_hdf5(const std::string& path, const VolumeReadOptions& options) {
    const DatasetPath place = split_dataset_path(path);
    const auto memory = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    DecodingChild child(place.file, "libhdf5", memory, [&](const DecodingChild::Send& send) { send_volume(place, options, send); });

    constexpr std::uint64_t longest = std::uint64_t{1} << 20;
    std::uint64_t length = 0;
    std::string text;
    if (child.read(&length, sizeof length) == sizeof length && length <= longest) text.resize(length);
    child.read(text.data(), text.size());
    const Told told = parse(text, path);
    const CheckedDims dims = check_dims(told.size, 1, told.type, path);
    Voxels v = told.described;
    v.dims = dims.dims;
    const auto read = [&](void* to, std::size_t bytes) { return child.read(to, bytes); };
    if (told.order.stride == SampleOrder::plain(v.dims).stride)
        read_samples(read, told.type, false, v);
    else
        read_reordered(read, told.type, false, dims.bytes / sample_bytes(told.type), told.order, v);
    return v;
}

} // namespace clvr

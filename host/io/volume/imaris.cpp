// Imaris files (.ims): HDF5 with a fixed layout; data are padded to whole chunks, sizes and extents are texts of single letters.
#include "host/io/volume/hdf5_volume.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/reading_options.hpp"

#include <algorithm>
#include <map>

namespace clvr {

namespace {

constexpr const char *level = "/DataSet/ResolutionLevel 0", *image = "/DataSetInfo/Image";

std::string place(std::int64_t time, std::int64_t channel) { return fmt::format("{}/TimePoint {}/Channel {}", level, time, channel); }

double number(const Hdf5File& file, const std::string& attribute) {
    const std::string text = file.text(image, attribute);
    const auto values = parse_numbers(text);
    if (!values || values->size() != 1) bad_file(file.path(), "{} of its {} is \"{:.40}\": expected a number", attribute, image, text);
    return values->front();
}

/// How many groups "/... N/..." there are, counted from N = 0.
template <class Name>
std::int64_t count_groups(const Hdf5File& file, Name&& name) {
    constexpr std::int64_t most = 100000;
    std::int64_t n = 0;
    while (n < most && file.is_group(name(n))) ++n;
    return n;
}

double unit_mm(const Hdf5File& file, Voxels& v) {
    static const std::map<std::string, double> units{{"m", 1e3},          {"mm", 1},       {"um", 1e-3},
                                                     {"\xc2\xb5m", 1e-3}, {"\xb5m", 1e-3}, {"nm", 1e-6}};
    const std::string unit = file.text(image, "Unit");
    const auto found = units.find(std::string(trimmed(unit)));
    if (found != units.end()) return found->second;
    v.notes.push_back(fmt::format("its unit of length is \"{:.20}\": micrometres are assumed", unit));
    return 1e-3;
}

} // namespace

bool is_imaris(const Hdf5File& file) { return file.is_group(level) && file.is_group(image); }

Hdf5Volume imaris_volume(const Hdf5File& file, const VolumeReadOptions& options) {
    Hdf5Volume h;
    Voxels& v = h.described;
    const std::int64_t times = count_groups(file, [](std::int64_t t) { return fmt::format("{}/TimePoint {}", level, t); });
    const std::int64_t channels = count_groups(file, [](std::int64_t c) { return place(0, c); });
    if (times == 0 || channels == 0) bad_file(file.path(), "the Imaris file holds no times or no channels");
    check_frame(options.frame, times, file.path());
    const std::int64_t channel = chosen_channel(options, channels, file.path(), v.notes);
    const std::string data = place(options.frame, channel) + "/Data";
    if (!file.is_dataset(data)) bad_file(file.path(), "there is no data set {} in it", data);
    h.data = file.dataset(data);
    if (h.data.dims.size() != 3) bad_file(file.path(), "data set {} has {} axes, expected 3", data, h.data.dims.size());
    file.check_readable(h.data);
    describe(v, file.path(), "Imaris", *h.data.type);
    v.frames = say_frame(options.frame, times, "the time points", v.decisions);

    h.start = {0, 0, 0};
    h.axis = {2, 1, 0};
    const double unit = unit_mm(file, v);
    Double3 spacing{1, 1, 1};
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string text = file.text(image, std::string(1, "XYZ"[i]));
        const auto size = parse_integers(text, 1, 1, "the size in DataSetInfo/Image", file.path()).front();
        if (size > h.data.dims[2 - i])
            bad_file(file.path(), "{} is {}, but data set {} has {} along it", "XYZ"[i], size, data, h.data.dims[2 - i]);
        h.count.insert(h.count.begin(), static_cast<std::uint64_t>(size));
        // Extents reach from edge to edge of the voxels.
        const double from = number(file, fmt::format("ExtMin{}", i)), to = number(file, fmt::format("ExtMax{}", i));
        spacing[i] = (to - from) / static_cast<double>(size) * unit;
        v.geometry.origin[i] = from * unit + spacing[i] / 2;
    }
    if (options.spacing) v.geometry.origin = {0, 0, 0};
    set_spacing(v, options, spacing);
    v.decisions.push_back(fmt::format("data set {}, spacing from the extents of DataSetInfo/Image", data));
    return h;
}

} // namespace clvr

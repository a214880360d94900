// MINC 2 (.mnc): HDF5 with a fixed layout. World is RAS mm; integers are scaled slice by slice.
#include "host/io/volume/hdf5_volume.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/reading_options.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <tuple>

namespace clvr {

namespace {

constexpr const char *minc_image = "/minc-2.0/image/0/image", *least = "/minc-2.0/image/0/image-min",
                     *greatest = "/minc-2.0/image/0/image-max";

/// The names of an object's axes, slowest first.
std::vector<std::string> axes_of(const Hdf5File& file, const std::string& object) {
    std::vector<std::string> names;
    std::istringstream text(file.text(object, "dimorder"));
    for (std::string name; std::getline(text, name, ',');) names.emplace_back(trimmed(name));
    return names;
}

/// Which real values the valid range of each slice means: one for all, or one for each entry of the slowest axis but time.
void set_scale(const Hdf5File& file, Hdf5Volume& h, const std::vector<std::string>& names, std::size_t frame) {
    if (*h.data.type == SampleType::f32 || *h.data.type == SampleType::f64) return; // floats are real values
    std::vector<double> range = file.numbers(minc_image, "valid_range");
    if (range.size() != 2) {
        const double bits = 8.0 * static_cast<double>(sample_bytes(*h.data.type));
        const bool is_signed = sample_type_name(*h.data.type)[0] == 'i';
        range =
            is_signed ? std::vector<double>{-std::exp2(bits - 1), std::exp2(bits - 1) - 1} : std::vector<double>{0, std::exp2(bits) - 1};
    }
    if (range[0] > range[1]) std::swap(range[0], range[1]);
    const std::vector<double> low = file.values(least), high = file.values(greatest);
    if (low.empty() && high.empty()) {
        h.described.notes.push_back("the file gives no image-min and image-max: its values are taken as stored");
        return;
    }
    const bool timed = !names.empty() && names.front() == "time";
    const std::size_t slowest = timed ? 1 : 0, slices = names.size() > slowest + 2 ? h.count[slowest] : 1;
    const std::vector<std::string> scale_axes = axes_of(file, least);
    const std::size_t times = timed && !scale_axes.empty() && scale_axes.front() == "time" ? static_cast<std::size_t>(h.data.dims[0]) : 1;
    if (low.size() != high.size() || !(range[1] > range[0]) || (low.size() != 1 && low.size() != slices * times))
        bad_file(file.path(), "its image-min has {} values and image-max {}, valid_range {:g} to {:g}: expected one or {} of each",
                 low.size(), high.size(), range[0], range[1], slices * times);
    const std::size_t first = times > 1 ? frame * slices : 0, n = low.size() == 1 ? 1 : slices;
    for (std::size_t i = first; i < first + n; ++i) {
        const double slope = (high[i] - low[i]) / (range[1] - range[0]);
        h.scales.emplace_back(slope, low[i] - slope * range[0]);
    }
    if (std::any_of(h.scales.begin(), h.scales.end(), [&](const auto& s) { return s != h.scales.front() || s.first == 0; })) {
        h.described.type = VoxelType::f32;
        h.described.decisions.push_back("each slice has a scale of its own: values are kept as f32");
    } else {
        std::tie(h.described.slope, h.described.intercept) = h.scales.front();
        h.scales.clear();
    }
}

} // namespace

bool is_minc(const Hdf5File& file) { return file.is_dataset(minc_image); }

Hdf5Volume minc_volume(const Hdf5File& file, const VolumeReadOptions& options) {
    Hdf5Volume h;
    Voxels& v = h.described;
    h.data = file.dataset(minc_image);
    file.check_readable(h.data);
    describe(v, file.path(), "MINC 2", *h.data.type);
    const std::vector<std::string> names = axes_of(file, minc_image);
    if (names.size() != h.data.dims.size())
        bad_file(file.path(), "its image has {} axes, and names for {} (dimorder)", h.data.dims.size(), names.size());
    const Double3 to_lps{-1, -1, 1};
    v.geometry.origin = {0, 0, 0};
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto size = static_cast<std::uint64_t>(h.data.dims[i]);
        const bool spatial = names[i].size() == 6 && names[i].compare(1, 5, "space") == 0 && names[i][0] >= 'x' && names[i][0] <= 'z';
        if (!spatial) {
            std::int64_t entry = 0;
            if (names[i] == "time") {
                check_frame(options.frame, h.data.dims[i], file.path());
                v.frames = say_frame(entry = options.frame, h.data.dims[i], "time", v.decisions);
            } else if (names[i] == "vector_dimension") {
                entry = chosen_channel(options, h.data.dims[i], file.path(), v.notes);
            } else if (size > 1) {
                bad_file(file.path(), "its image has the axis {}: expected xspace, yspace, zspace, time or vector_dimension", names[i]);
            }
            h.start.push_back(static_cast<std::uint64_t>(entry));
            h.count.push_back(1);
            continue;
        }
        const auto axis = static_cast<std::size_t>(names[i][0] - 'x');
        if (h.axis[axis]) bad_file(file.path(), "its image has the axis {} twice", names[i]);
        h.axis[axis] = i;
        h.start.push_back(0);
        h.count.push_back(size);
        const std::string dimension = "/minc-2.0/dimensions/" + names[i];
        const auto number = [&](const char* attribute, double otherwise) {
            const auto values = file.numbers(dimension, attribute);
            return values.size() == 1 ? values.front() : otherwise;
        };
        if (file.text(dimension, "spacing") == "irregular")
            bad_file(file.path(), "its slices along {} are not equally far apart: resample it with mincresample", names[i]);
        const double step = number("step", 1), start = number("start", 0);
        std::vector<double> cosines = file.numbers(dimension, "direction_cosines");
        if (cosines.size() != 3) cosines = {axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
        const double length = norm({cosines[0], cosines[1], cosines[2]});
        for (double& c : cosines) c /= length;
        v.geometry.spacing[axis] = std::abs(step);
        for (std::size_t k = 0; k < 3; ++k) {
            v.geometry.direction.row[k][axis] = to_lps[k] * cosines[k] * (step < 0 ? -1 : 1);
            v.geometry.origin[k] += to_lps[k] * cosines[k] * start;
        }
    }
    if (std::find(names.begin(), names.end(), "time") == names.end()) check_frame(options.frame, 1, file.path());
    set_scale(file, h, names, static_cast<std::size_t>(options.frame));
    return h;
}

} // namespace clvr

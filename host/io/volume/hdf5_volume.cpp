// Data sets of HDF5 files that follow no layout but their own: axes by their labels or their number, spacing by element_size_um.
#include "host/io/volume/hdf5_volume.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/reading_options.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

namespace clvr {

namespace {

enum class AxisRole { x, y, z, frame, channel, unknown };

std::string shape_of(const Hdf5Dataset& d) { return d.dims.empty() ? "one value" : fmt::format("{}", fmt::join(d.dims, " x ")); }

/// What a label means: "z", "time", "c".
AxisRole role_named(const std::string& label) {
    const std::string name = lower_case(trimmed(label));
    for (const auto& [names, role] : {std::pair{std::vector<std::string>{"x"}, AxisRole::x},
                                      {std::vector<std::string>{"y"}, AxisRole::y},
                                      {std::vector<std::string>{"z"}, AxisRole::z},
                                      {std::vector<std::string>{"t", "time", "frame"}, AxisRole::frame},
                                      {std::vector<std::string>{"c", "ch", "channel"}, AxisRole::channel}})
        if (std::find(names.begin(), names.end(), name) != names.end()) return role;
    return AxisRole::unknown;
}

/// One label an axis: by HDF5's dimension scales, or by vigra's and ilastik's "axistags". Empty where there are none.
std::vector<std::string> labels_of(const Hdf5File& file, const Hdf5Dataset& d) {
    std::vector<std::string> labels = file.texts(d.path, "DIMENSION_LABELS");
    if (labels.empty()) {
        const auto tags = nlohmann::json::parse(file.text(d.path, "axistags"), nullptr, false);
        if (tags.is_object() && tags.contains("axes") && tags["axes"].is_array())
            for (const auto& axis : tags["axes"])
                labels.push_back(axis.is_object() && axis.contains("key") && axis["key"].is_string() ? axis["key"].get<std::string>() : "");
    }
    const bool any = std::any_of(labels.begin(), labels.end(), [](const std::string& l) { return !l.empty(); });
    return any && labels.size() == d.dims.size() ? labels : std::vector<std::string>{};
}

/// Roles by labels; empty unless every axis of more than one entry has a role of its own, x and y among them.
std::vector<AxisRole> roles_by_label(const Hdf5Dataset& d, const std::vector<std::string>& labels) {
    std::vector<AxisRole> roles;
    for (const std::string& label : labels) roles.push_back(role_named(label));
    for (std::size_t i = 0; i < roles.size(); ++i)
        if ((roles[i] == AxisRole::unknown && d.dims[i] > 1) ||
            (roles[i] != AxisRole::unknown && std::count(roles.begin(), roles.end(), roles[i]) > 1))
            return {};
    const auto has = [&](AxisRole r) { return std::find(roles.begin(), roles.end(), r) != roles.end(); };
    return has(AxisRole::x) && has(AxisRole::y) ? roles : std::vector<AxisRole>{};
}

/// Roles by number: (z, y, x) or (y, x) once axes of one entry are left out; a fourth axis only where --channel says what it is.
std::vector<AxisRole> roles_by_number(const Hdf5File& file, const Hdf5Dataset& d, const std::vector<std::string>& labels,
                                      const VolumeReadOptions& options) {
    std::vector<std::size_t> axes(d.dims.size());
    std::iota(axes.begin(), axes.end(), std::size_t{0});
    for (std::size_t i = 0; axes.size() > 3 && i < axes.size();) // axes of one entry say nothing
        if (d.dims[axes[i]] == 1)
            axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(i));
        else
            ++i;
    std::vector<AxisRole> roles(d.dims.size(), AxisRole::unknown);
    if (axes.size() == 4 && options.channel && labels.empty()) { // few entries behind many: channels of each voxel
        const auto size = [&](std::size_t i) { return d.dims[axes[i]]; };
        const std::size_t channels = size(3) <= 4 && std::min({size(0), size(1), size(2)}) > 4 ? 3 : 0;
        roles[axes[channels]] = AxisRole::channel;
        axes.erase(axes.begin() + static_cast<std::ptrdiff_t>(channels));
    }
    if (axes.size() < 2 || axes.size() > 3)
        bad_file(file.path(), "data set {} has the shape {}{}: expected (z, y, x) or labelled axes among t, c, z, y, x{}", d.path,
                 shape_of(d), labels.empty() ? std::string(" and no labels") : fmt::format(" with the axes {}", fmt::join(labels, ", ")),
                 axes.size() == 4 && labels.empty() ? "; --channel N takes entry N of the axis beyond three" : "");
    const AxisRole order[] = {AxisRole::z, AxisRole::y, AxisRole::x};
    for (std::size_t i = 0; i < axes.size(); ++i) roles[axes[i]] = order[3 - axes.size() + i];
    return roles;
}

/// element_size_um of ilastik and Fiji's HDF5 plugin: micrometres an axis, or z, y, x. Nothing where there is none.
std::optional<Double3> element_size(const Hdf5File& file, const Hdf5Volume& h) {
    const std::vector<double> sizes = file.numbers(h.data.path, "element_size_um");
    if (sizes.empty()) return std::nullopt;
    if (sizes.size() != 3 && sizes.size() != h.data.dims.size())
        bad_file(file.path(), "element_size_um of data set {} has {} values: expected 3 (z, y, x)", h.data.path, sizes.size());
    std::vector<std::size_t> spatial; // axes in the file's order
    for (const auto& a : h.axis)
        if (a) spatial.push_back(*a);
    std::sort(spatial.begin(), spatial.end());
    Double3 spacing{1, 1, 1};
    for (std::size_t i = 0; i < 3; ++i) {
        std::size_t at = 2 - i; // z, y, x
        if (h.axis[i] && sizes.size() == h.data.dims.size())
            at = *h.axis[i];
        else if (h.axis[i] && spatial.size() == 3)
            at = static_cast<std::size_t>(std::find(spatial.begin(), spatial.end(), *h.axis[i]) - spatial.begin());
        else if (!h.axis[i] && sizes.size() != 3)
            continue;
        spacing[i] = sizes[at] * 1e-3;
    }
    return spacing;
}

/// Notes an attribute that may hold voxel sizes in a unit that is not stated.
void say_unknown_sizes(const Hdf5File& file, Hdf5Volume& h) {
    for (const char* name : {"spacing", "resolution", "voxel_size", "voxelsize", "pixel_size", "element_size"})
        if (!file.numbers(h.data.path, name).empty())
            h.described.notes.push_back(
                fmt::format("the attribute {} of data set {} is not taken as voxel size: its unit is not known", name, h.data.path));
}

/// "FILE:/a (3 x 4 x 5 u16), FILE:/b (...)": what to name.
std::string list_of(const Hdf5File& file, const std::vector<Hdf5Dataset>& sets) {
    constexpr std::size_t most = 12;
    std::string list;
    for (std::size_t i = 0; i < sets.size() && i < most; ++i)
        list += fmt::format("{}{}:{} ({} {})", i == 0 ? "" : ", ", file.path(), sets[i].path, shape_of(sets[i]), sets[i].type_name);
    return sets.size() > most ? list + fmt::format(" and {} more", sets.size() - most) : list;
}

Hdf5Dataset find_dataset(const Hdf5File& file, const std::string& inside, std::vector<std::string>& decisions) {
    const std::string name = inside.empty() || inside.front() == '/' ? inside : "/" + inside;
    if (!name.empty() && file.is_dataset(name)) return file.dataset(name);
    const bool group = name.empty() || file.is_group(name);
    const std::string place = group && !name.empty() ? name : "/";
    std::vector<Hdf5Dataset> all = file.datasets(place), volumes;
    std::copy_if(all.begin(), all.end(), std::back_inserter(volumes), [](const Hdf5Dataset& d) {
        return d.type && d.dims.size() >= 3 && std::find(d.dims.begin(), d.dims.end(), 0) == d.dims.end();
    });
    const std::string list = list_of(file, volumes.empty() ? all : volumes);
    if (!group) bad_file(file.path(), "there is no data set {} in it{}{}", name, list.empty() ? "" : ", but ", list);
    if (all.empty()) bad_file(file.path(), "there is no data set in {}", place);
    if (volumes.empty()) bad_file(file.path(), "there is no data set of numbers on three axes in {}, only {}", place, list);
    if (volumes.size() > 1)
        bad_file(file.path(), "{} holds {} data sets, name one of them: {}", place == "/" ? "the file" : place, volumes.size(), list);
    decisions.push_back(fmt::format("data set {}, the only one of three axes", volumes.front().path));
    return volumes.front();
}

} // namespace

Hdf5Volume plain_hdf5_volume(const Hdf5File& file, const std::string& inside, const VolumeReadOptions& options) {
    Hdf5Volume h;
    Voxels& v = h.described;
    h.data = find_dataset(file, inside, v.decisions);
    file.check_readable(h.data);
    describe(v, file.path(), "HDF5", *h.data.type);
    const std::vector<std::string> labels = labels_of(file, h.data);
    std::vector<AxisRole> roles = roles_by_label(h.data, labels);
    const bool by_label = !roles.empty();
    if (!by_label) roles = roles_by_number(file, h.data, labels, options);

    std::int64_t frames = 1, channels = 1;
    for (std::size_t i = 0; i < roles.size(); ++i) {
        if (roles[i] == AxisRole::frame) frames = h.data.dims[i];
        if (roles[i] == AxisRole::channel) channels = h.data.dims[i];
    }
    check_frame(options.frame, frames, file.path());
    const auto channel = chosen_channel(options, channels, file.path(), v.notes);
    v.frames = say_frame(options.frame, frames, "t", v.decisions);
    std::string order;
    for (std::size_t i = 0; i < roles.size(); ++i) {
        const bool spatial = roles[i] == AxisRole::x || roles[i] == AxisRole::y || roles[i] == AxisRole::z;
        h.start.push_back(static_cast<std::uint64_t>(roles[i] == AxisRole::frame     ? options.frame
                                                     : roles[i] == AxisRole::channel ? channel
                                                                                     : 0));
        h.count.push_back(spatial ? static_cast<std::uint64_t>(h.data.dims[i]) : 1);
        if (spatial) h.axis[static_cast<std::size_t>(roles[i])] = i;
        static constexpr const char* names[] = {"x", "y", "z", "t", "c", "-"};
        order += fmt::format("{}{}", i == 0 ? "" : ", ", names[static_cast<std::size_t>(roles[i])]);
    }
    v.decisions.push_back(fmt::format("data set {} of shape {} is ({}), {}", h.data.path, shape_of(h.data), order,
                                      by_label ? "by its labels" : "by its number of axes"));
    const auto spacing = element_size(file, h);
    if (spacing && !options.spacing) v.decisions.push_back("spacing from element_size_um");
    set_spacing(v, options, spacing);
    if (!spacing && !options.spacing) say_unknown_sizes(file, h);
    return h;
}

} // namespace clvr

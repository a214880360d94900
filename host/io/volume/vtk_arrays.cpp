#include "host/io/volume/vtk_arrays.hpp"

#include <algorithm>

namespace clvr {

namespace {

std::string names_of(const std::vector<VtkArray>& arrays) {
    constexpr std::size_t most = 12;
    std::string names;
    for (std::size_t i = 0; i < std::min(most, arrays.size()); ++i)
        names += fmt::format("{}\"{:.60}\"{}", i ? ", " : "", arrays[i].name, arrays[i].of_cells ? " (of cells)" : "");
    return names + (arrays.size() > most ? ", ..." : "");
}

} // namespace

std::size_t choose_array(const std::vector<VtkArray>& arrays, const VolumeReadOptions& options, Voxels& v) {
    if (arrays.empty()) bad_file(v.source, "it holds no data array of points or cells: nothing to show");
    std::vector<const VtkArray*> order; // points first
    for (const bool cells : {false, true})
        for (const VtkArray& a : arrays)
            if (a.of_cells == cells) order.push_back(&a);
    const auto first = [&](const auto& fits) {
        const auto found = std::find_if(order.begin(), order.end(), [&](const VtkArray* a) { return fits(*a); });
        return found == order.end() ? nullptr : *found;
    };
    const VtkArray* taken = nullptr;
    if (!options.array.empty()) {
        taken = first([&](const VtkArray& a) { return a.name == options.array; });
        if (!taken) bad_file(v.source, "it has no data array \"{:.60}\": it has {}", options.array, names_of(arrays));
    } else {
        taken = first([](const VtkArray& a) { return a.active && a.type; });
        if (!taken) taken = first([](const VtkArray& a) { return a.type && a.components == 1; });
        if (!taken) taken = first([](const VtkArray& a) { return a.type.has_value(); });
        if (!taken) taken = order.front();
        if (arrays.size() > 1)
            v.notes.push_back(
                fmt::format("the file has the arrays {}: \"{:.60}\" is taken (--array chooses)", names_of(arrays), taken->name));
    }
    if (!taken->type)
        bad_file(v.source, "the data array \"{:.60}\" has the type \"{:.40}\": expected integers, float or double", taken->name,
                 taken->type_name);
    if (taken->of_cells) v.decisions.push_back("the voxels are the cells of the grid, not its points");
    return static_cast<std::size_t>(taken - arrays.data());
}

FileDims VtkGrid::samples(bool of_cells) const {
    FileDims n = points;
    for (std::int64_t& i : n)
        if (of_cells && i > 1) --i;
    return n;
}

Geometry VtkGrid::placed(bool of_cells) const {
    Geometry g = geometry;
    Double3 step{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i)
        if (of_cells && points[i] > 1) step[i] = 0.5;
    g.origin = g.to_world(step);
    return g;
}

} // namespace clvr

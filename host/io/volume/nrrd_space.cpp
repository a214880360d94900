// Where a NRRD volume lies: space, directions, spacings, units.
#include "host/io/volume/axes.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/length_unit.hpp"
#include "host/io/volume/nrrd_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clvr {

namespace {

/// A world: which of its axes is x, y and z of LPS, which are turned round, and the millimetres of each.
struct World {
    std::array<std::size_t, 3> axis{0, 1, 2}; ///< LPS axis of each world axis
    Double3 sign{1, 1, 1}, unit{1, 1, 1};     ///< of each world axis
    std::size_t dimension = 3;

    bool one_unit() const { return unit[0] == unit[1] && unit[1] == unit[2]; }
    /// A vector or point in LPS, in the world's own units.
    Double3 to_lps(const std::vector<double>& v) const {
        Double3 lps{0, 0, 0};
        for (std::size_t i = 0; i < std::min<std::size_t>(3, v.size()); ++i) lps[axis[i]] = sign[i] * v[i];
        return lps;
    }
    /// Millimetres, of a vector that to_lps gave.
    Double3 millimetres(Double3 lps) const {
        for (std::size_t i = 0; i < 3; ++i) lps[axis[i]] *= unit[i];
        return lps;
    }
};

/// "left-anterior-superior" or "LAS", in any order; nothing for other words.
std::optional<World> anatomical(const std::string& space) {
    std::string letters;
    if (space.size() == 3)
        letters = space;
    else
        for (std::size_t at = 0; at != std::string::npos;) {
            const auto end = space.find('-', at);
            const std::string word = space.substr(at, end - at);
            if (word != "left" && word != "right" && word != "anterior" && word != "posterior" && word != "superior" && word != "inferior")
                return std::nullopt;
            letters += word[0];
            at = end == std::string::npos ? end : end + 1;
        }
    static const std::string known = "lrpasi"; // pairs: to the left, to the right, ...
    World w;
    std::array<bool, 3> seen{};
    if (letters.size() != 3) return std::nullopt;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto letter = known.find(letters[i]);
        if (letter == std::string::npos || seen[letter / 2]) return std::nullopt;
        seen[letter / 2] = true;
        w.axis[i] = letter / 2;
        w.sign[i] = letter % 2 ? -1 : 1;
    }
    return w;
}

World world_of(const NrrdHeader& h, Voxels& v) {
    const std::string given = lower_case(h.field("space"));
    std::string space = given;
    bool timed = false;
    for (const char* end : {"-time", "t"}) // "RAST" is "right-anterior-superior-time"
        if (const std::size_t n = std::string(end).size();
            space.size() > n && space.compare(space.size() - n, n, end) == 0 && (n > 1 || space.size() == 4)) {
            space.erase(space.size() - n);
            timed = true;
            break;
        }
    World w;
    if (const auto found = anatomical(space)) {
        w = *found;
    } else if (space == "scanner-xyz" || space == "3d-right-handed" || space == "3d-left-handed") {
        v.decisions.push_back(fmt::format("NRRD space \"{}\" says nothing of the body: its axes are taken as LPS", given));
    } else if (!given.empty()) {
        bad_file(v.source, "the NRRD space \"{:.60}\" is not known: expected left-posterior-superior, RAS, scanner-xyz, ...", given);
    } else if (h.fields.count("spacedirections")) {
        v.decisions.push_back("the NRRD header names no space: its axes are taken as LPS");
    }
    if (timed) w.dimension = 4;
    if (given.empty() && h.fields.count("spacedimension"))
        w.dimension = static_cast<std::size_t>(
            std::min<std::int64_t>(parse_integers(h.field("spacedimension"), 1, 1, "\"space dimension\"", v.source).front(), 100));
    const auto units = nrrd_words(h.field("spaceunits"));
    if (!units.empty() && units.size() != w.dimension)
        bad_file(v.source, "\"space units\" has {} entries for a space of {} dimensions", units.size(), w.dimension);
    for (std::size_t i = 0; i < std::min<std::size_t>(3, units.size()); ++i)
        if (units[i] != "none" && units[i] != "???") w.unit[i] = unit_or_millimetre(units[i], v.notes);
    for (std::size_t i = units.size(); i < 3 && !units.empty(); ++i) w.unit[i] = w.unit[0];
    return w;
}

/// Millimetres of each axis of space by "units"; 1 where there are none.
Double3 axis_units(const NrrdHeader& h, const NrrdAxes& axes, Voxels& v) {
    const auto words = nrrd_words_per_axis(h, "units", axes.sizes.size(), v.source);
    Double3 units{1, 1, 1};
    for (std::size_t j = 0; j < axes.spatial.size() && !words.empty(); ++j)
        if (const std::string& word = words[axes.spatial[j]]; word != "none" && word != "???") units[j] = unit_or_millimetre(word, v.notes);
    return units;
}

void place_by_directions(const NrrdHeader& h, const NrrdAxes& axes, Voxels& v) {
    World world = world_of(h, v);
    const auto words = nrrd_words_per_axis(h, "spacedirections", axes.sizes.size(), v.source);
    if (!h.fields.count("space") && !h.fields.count("spacedimension"))
        world.dimension = parse_numbers(words[axes.spatial[0]]).value_or(std::vector<double>(3)).size();
    if (!h.fields.count("spaceunits")) { // older files give a unit an axis
        const Double3 units = axis_units(h, axes, v);
        if (!std::all_of(units.begin(), units.begin() + static_cast<std::ptrdiff_t>(axes.spatial.size()),
                         [&](double u) { return u == units[0]; }))
            bad_file(v.source, "\"units\" differ among its axes, but \"space directions\" need \"space units\"");
        world.unit = {units[0], units[0], units[0]};
    }
    if (world.dimension > 4) bad_file(v.source, "its space has {} dimensions: expected at most three and time", world.dimension);
    Geometry& g = v.geometry;
    for (std::size_t j = 0; j < axes.spatial.size(); ++j) {
        const std::string& word = words[axes.spatial[j]];
        const auto numbers = parse_numbers(word);
        double squares = 0;
        if (numbers && numbers->size() == world.dimension)
            for (const double x : *numbers) squares += x * x;
        if (!(squares > 0) || !std::isfinite(squares) || (numbers->size() > 3 && numbers->back() != 0))
            bad_file(v.source, "\"space directions\" holds {:.60}: expected vectors of {} numbers that are finite and not 0", word,
                     world.dimension);
        Double3 step = world.to_lps(*numbers);
        if (!world.one_unit()) step = world.millimetres(step);
        const double length = norm(step);
        if (!(length > 0)) bad_file(v.source, "\"space directions\" holds {:.60}: expected vectors that are not 0", word);
        g.spacing[j] = length * (world.one_unit() ? world.unit[0] : 1.0);
        for (std::size_t i = 0; i < 3; ++i) g.direction.row[i][j] = step[i] * (1.0 / length);
    }
    if (h.fields.count("spaceorigin"))
        g.origin = world.millimetres(world.to_lps(parse_finite(h.field("spaceorigin"), world.dimension, "\"space origin\"", v.source)));
}

bool is_given(const std::vector<std::string>& words, std::size_t axis) {
    if (words.empty()) return false;
    const std::string word = lower_case(words[axis]);
    return word != "nan" && word != "none" && word != "???";
}

void place_by_spacings(const NrrdHeader& h, const NrrdAxes& axes, Voxels& v) {
    const std::size_t count = axes.sizes.size();
    const auto spacings = nrrd_words_per_axis(h, "spacings", count, v.source), mins = nrrd_words_per_axis(h, "axismins", count, v.source),
               maxs = nrrd_words_per_axis(h, "axismaxs", count, v.source), centers = nrrd_words_per_axis(h, "centerings", count, v.source);
    const Double3 units = axis_units(h, axes, v);
    bool given = false;
    for (std::size_t j = 0; j < axes.spatial.size(); ++j) {
        const std::size_t i = axes.spatial[j];
        const double n = static_cast<double>(axes.sizes[i]);
        const bool node = !centers.empty() && lower_case(centers[i]) == "node"; // the ends are the outer samples, not their outer faces
        double spacing = 1, min = 0;
        if (is_given(mins, i)) min = parse_finite(mins[i], 1, "\"axis mins\"", v.source).front();
        if (!spacings.empty()) {
            spacing = parse_spacing(spacings[i], 1, "\"spacings\"", v.source).front();
            given = true;
        } else if (is_given(mins, i) && is_given(maxs, i) && (!node || n > 1)) {
            spacing = (parse_finite(maxs[i], 1, "\"axis maxs\"", v.source).front() - min) / (node ? n - 1 : n);
            if (spacing == 0) bad_file(v.source, "\"axis mins\" and \"axis maxs\" are the same, {:g}", min);
            v.decisions.push_back(fmt::format("spacing of axis {} from \"axis mins\" and \"axis maxs\"", i));
            given = true;
        }
        v.geometry.spacing[j] = spacing * units[j];
        if (is_given(mins, i)) v.geometry.origin[j] = (node ? min : min + 0.5 * spacing) * units[j];
    }
    if (!given) v.notes.push_back("the file gives no voxel spacing: 1 mm is assumed");
}

} // namespace

void place_nrrd(const NrrdHeader& h, const NrrdAxes& axes, Voxels& v) {
    if (!nrrd_words(h.field("spacedirections")).empty())
        place_by_directions(h, axes, v);
    else
        place_by_spacings(h, axes, v);
    settle_axes(v.geometry);
    complete_axes(v.geometry, static_cast<int>(axes.spatial.size()));
    check_geometry(v.geometry, v.source);
}

} // namespace clvr

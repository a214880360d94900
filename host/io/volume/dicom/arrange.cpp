#include "host/io/volume/dicom/arrange.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

namespace clvr {

namespace {

constexpr double same_place_mm = 1e-3;
/// A slice is where it should be when it is within this share of the slice distance.
constexpr double tolerance = 0.1;

bool alike(const DicomSlice& a, const DicomSlice& b) {
    constexpr double same_direction = 1e-3;
    const DicomPixels &p = a.pixels, &q = b.pixels;
    return p.columns == q.columns && p.rows == q.rows && p.bits_allocated == q.bits_allocated && p.is_signed == q.is_signed &&
           norm(a.row - b.row) < same_direction && norm(a.column - b.column) < same_direction &&
           std::abs(a.spacing_i - b.spacing_i) < 1e-3 * a.spacing_i && std::abs(a.spacing_j - b.spacing_j) < 1e-3 * a.spacing_j;
}

/// Indices of the largest group of slices that are alike.
std::vector<std::size_t> largest_group(const std::vector<DicomSlice>& slices, std::vector<std::string>& notes) {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < slices.size(); ++i) {
        const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) { return alike(slices[g.front()], slices[i]); });
        if (group == groups.end())
            groups.push_back({i});
        else
            group->push_back(i);
    }
    const auto largest = std::max_element(groups.begin(), groups.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
    if (groups.size() > 1)
        notes.push_back(fmt::format("{} of {} slices have another size or orientation and were left out", slices.size() - largest->size(),
                                    slices.size()));
    return *largest;
}

/// The slices at one place along the normal [mm].
struct Place {
    double along;
    std::vector<std::size_t> slices;
};

std::vector<Place> places_of(const std::vector<DicomSlice>& slices, std::vector<std::size_t> chosen, const Double3& normal,
                             std::vector<std::string>& notes) {
    const auto along = [&](std::size_t i) { return inner(slices[i].position, normal); };
    std::sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
        const DicomSlice &x = slices[a], &y = slices[b];
        return std::make_tuple(along(a), x.acquisition, x.instance, x.path) < std::make_tuple(along(b), y.acquisition, y.instance, y.path);
    });
    std::vector<Place> places;
    std::set<std::string> seen;
    std::size_t copies = 0;
    for (const std::size_t i : chosen) {
        if (!slices[i].instance_uid.empty() && !seen.insert(slices[i].instance_uid).second) {
            ++copies;
            continue;
        }
        if (places.empty() || along(i) - places.back().along > same_place_mm) places.push_back({along(i), {}});
        places.back().slices.push_back(i);
    }
    if (copies > 0)
        notes.push_back(
            fmt::format("{} duplicate file{} (the same SOPInstanceUID twice) left out", copies, copies == 1 ? " was" : "s were"));
    return places;
}

/// One slice a place: time `frame` where every place has as many, else the first.
std::vector<std::size_t> choose_frame(std::vector<Place>& places, const std::vector<DicomSlice>& slices, int frame,
                                      std::vector<std::string>& notes, const std::string& where) {
    const std::size_t frames = places.front().slices.size();
    const bool regular = std::all_of(places.begin(), places.end(), [&](const Place& p) { return p.slices.size() == frames; });
    check_frame(frame, regular ? static_cast<std::int64_t>(frames) : 1, where);
    if (regular && frames > 1)
        notes.push_back(fmt::format("every slice is there {} times (times, echoes): frame {} is shown, --frame chooses", frames, frame));
    std::vector<std::size_t> chosen;
    std::size_t duplicates = 0;
    for (Place& p : places) {
        std::stable_sort(p.slices.begin(), p.slices.end(), [&](std::size_t a, std::size_t b) {
            return std::make_pair(slices[a].acquisition, slices[a].instance) < std::make_pair(slices[b].acquisition, slices[b].instance);
        });
        chosen.push_back(p.slices[regular ? static_cast<std::size_t>(frame) : 0]);
        if (!regular) duplicates += p.slices.size() - 1;
    }
    if (duplicates > 0)
        notes.push_back(fmt::format("{} duplicate slice{} at the place of another left out", duplicates, duplicates == 1 ? "" : "s"));
    return chosen;
}

/// The distance of neighbours: the median of the largest group of distances that are alike (others are gaps or slices out of step).
double slice_step(const std::vector<Place>& places) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < places.size(); ++k) steps.push_back(places[k].along - places[k - 1].along);
    std::sort(steps.begin(), steps.end());
    auto first = steps.begin(), last = first;
    for (auto begin = steps.begin(); begin != steps.end(); ++begin)
        if (const auto end = std::upper_bound(begin, steps.end(), *begin * (1 + tolerance)); end - begin > last - first)
            first = begin, last = end;
    return first[(last - first) / 2];
}

/// Lays the places on a regular lattice; a lattice slice without a file is a gap.
std::vector<SlicePlace> lay_out(const std::vector<Place>& places, const std::vector<std::size_t>& chosen, double step, bool allow_gaps,
                                std::vector<std::string>& notes, const std::string& where) {
    const double span = places.back().along - places.front().along;
    constexpr double most_slices = 1e5;
    if (span / step > most_slices)
        bad_file(where, "the slices lie {:g} mm apart at a distance of {:g} mm: their positions are not those of a volume", span, step);
    const auto count = static_cast<std::size_t>(std::lround(span / step)) + 1;
    std::vector<SlicePlace> slices;
    std::size_t missing = 0, at = 0;
    double first_gap = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double wanted =
            places.front().along + span * static_cast<double>(k) / static_cast<double>(std::max<std::size_t>(count - 1, 1));
        while (at + 1 < places.size() && places[at + 1].along <= wanted) ++at;
        const std::size_t next = std::min(at + 1, places.size() - 1);
        const double below = wanted - places[at].along, above = places[next].along - wanted;
        if (below <= tolerance * step || next == at) {
            slices.push_back({chosen[at], chosen[at], 0});
        } else if (above <= tolerance * step) {
            slices.push_back({chosen[next], chosen[next], 0});
        } else {
            if (missing++ == 0) first_gap = wanted;
            slices.push_back({chosen[at], chosen[next], below / (below + above)});
        }
    }
    if (missing > 0 && !allow_gaps)
        bad_file(where,
                 "{} of {} slices are missing or out of step, the first {:.2f} mm from the lowest (distance of slices {:g} mm): "
                 "--allow-gaps interpolates them",
                 missing, count, first_gap - places.front().along, step);
    if (missing > 0) notes.push_back(fmt::format("{} of {} slices are missing: interpolated between their neighbours", missing, count));
    return slices;
}

} // namespace

Arrangement arrange(const std::vector<DicomSlice>& slices, int frame, bool allow_gaps, const std::string& where) {
    Arrangement a;
    const std::vector<std::size_t> group = largest_group(slices, a.notes);
    const DicomSlice& first = slices[group.front()];
    const Double3 normal = unit(cross(first.row, first.column));
    std::vector<Place> places = places_of(slices, group, normal, a.notes);
    const std::vector<std::size_t> chosen = choose_frame(places, slices, frame, a.notes, where);

    const DicomSlice &low = slices[chosen.front()], &high = slices[chosen.back()];
    Double3 axis = normal;
    if (places.size() == 1) {
        a.slices = {{chosen.front(), chosen.front(), 0}};
        a.geometry.spacing[2] = first.thickness > 0 ? first.thickness : 1;
        if (!(first.thickness > 0)) a.notes.push_back("one slice without a thickness: 1 mm is assumed");
    } else {
        a.slices = lay_out(places, chosen, slice_step(places), allow_gaps, a.notes, where);
        const Double3 way = high.position - low.position;
        a.geometry.spacing[2] = norm(way) / static_cast<double>(a.slices.size() - 1);
        axis = unit(way);
        const double tilt = std::acos(std::min(1.0, inner(axis, normal))) * 180 / M_PI;
        if (tilt > 0.5)
            a.notes.push_back(
                fmt::format("the slices are stacked {:.1f} degrees off their normal (gantry tilt): the volume is kept sheared", tilt));
        for (std::size_t k = 0; k < chosen.size(); ++k) {
            const double share = (places[k].along - places.front().along) / (places.back().along - places.front().along);
            const Double3 off = slices[chosen[k]].position - (low.position + way * share);
            if (norm(off) > 0.5 * std::min(first.spacing_i, first.spacing_j)) {
                a.notes.push_back(fmt::format("slices lie up to {:.2f} mm or more beside the line from the first to the last", norm(off)));
                break;
            }
        }
    }
    a.geometry.origin = low.position;
    a.geometry.spacing[0] = first.spacing_i;
    a.geometry.spacing[1] = first.spacing_j;
    for (int i = 0; i < 3; ++i) a.geometry.direction.row[i] = {first.row[i], first.column[i], axis[i]};
    return a;
}

} // namespace clvr

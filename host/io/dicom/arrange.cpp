#include "host/io/dicom/arrange.hpp"
#include "host/io/dicom/lattice.hpp"
#include "host/io/dicom/place.hpp"
#include "host/io/dicom/places.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

using Frames = std::vector<DicomFrame>;

/// The last decimal of positions along the normal [mm]; the finest text of each coordinate counts, as zeros at the end may be missing.
double rounding_along(const Frames& frames, const std::vector<std::size_t>& stack, const Double3& normal) {
    Double3 finest = frames[stack.front()].place.rounding;
    for (const std::size_t i : stack)
        for (int c = 0; c < 3; ++c) finest[c] = std::min(finest[c], frames[i].place.rounding[c]);
    double along = 0;
    for (int c = 0; c < 3; ++c) along += std::abs(normal[c]) * finest[c];
    return along;
}

/// Lays the places on their lattice; a lattice slice without a frame is a gap.
void lay_out(const std::vector<SlicesAtPlace>& places, const std::vector<std::size_t>& chosen, const SliceLattice& lattice, bool allow_gaps,
             Arrangement& a, const std::string& where) {
    const double lowest = places.front().along;
    std::size_t missing = 0, at = 0;
    double first_gap = 0;
    for (std::size_t k = 0; k < lattice.count; ++k) {
        const double wanted = lowest + lattice.step * static_cast<double>(k);
        while (at + 1 < places.size() && lattice.index[at + 1] <= k) ++at;
        if (lattice.index[at] == k && lattice.in_step[at]) {
            a.slices.push_back({chosen[at], chosen[at], 0});
            continue;
        }
        if (missing++ == 0) first_gap = wanted;
        // Between the nearest below and above, wherever they lie exactly.
        std::size_t below = at;
        while (below > 0 && places[below].along > wanted) --below;
        while (below + 1 < places.size() && places[below + 1].along <= wanted) ++below;
        const std::size_t above = std::min(below + 1, places.size() - 1);
        const double under = std::max(0.0, wanted - places[below].along), over = std::max(0.0, places[above].along - wanted);
        a.slices.push_back({chosen[below], chosen[above], under + over > 0 ? under / (under + over) : 0});
    }
    if (missing > 0 && !allow_gaps)
        bad_file(where,
                 "{} of {} slices are missing or out of step, the first {:.2f} mm from the lowest (distance of slices {:g} mm): "
                 "--allow-gaps interpolates them",
                 missing, lattice.count, first_gap - lowest, lattice.step);
    if (missing > 0)
        a.notes.push_back(fmt::format("{} of {} slices are missing: interpolated between their neighbours", missing, lattice.count));
}

/// Refuses slices that lie closer than the regular distance, or that rounded positions put at one place.
void check_crowding(const std::vector<SlicesAtPlace>& places, const SliceLattice& lattice, double rounding, std::size_t times,
                    bool allow_gaps, const std::string& where) {
    std::size_t between = 0;
    for (std::size_t k = 1; k < places.size(); ++k) between += lattice.index[k] == lattice.index[k - 1];
    if (between > 0 && !allow_gaps)
        bad_file(where,
                 "{} slice{} between the places of the others (distance of slices {:g} mm): choose one series with --series, or leave them "
                 "out with --allow-gaps",
                 between, between == 1 ? " lies" : "s lie", lattice.step);
    const std::size_t doubled = slices_in(places) - times * places.size();
    if (rounding > 0.5 * lattice.step && doubled > 2 && 20 * doubled > places.size())
        bad_file(where,
                 "the positions of the slices are rounded to {:g} mm, which puts {} of them at the place of another: their order and "
                 "distance are not known",
                 rounding, doubled);
}

void say_steps(const std::vector<SlicesAtPlace>& places, const SliceLattice& lattice, Arrangement& a) {
    double least = lattice.step, greatest = lattice.step;
    for (std::size_t k = 1; k < places.size(); ++k) {
        if (lattice.index[k] != lattice.index[k - 1] + 1) continue;
        least = std::min(least, places[k].along - places[k - 1].along);
        greatest = std::max(greatest, places[k].along - places[k - 1].along);
    }
    if (greatest - least > same_place_mm)
        a.decisions.push_back(fmt::format("slice distance {:.6g} mm from the whole span (single distances are {:.6g} to {:.6g} mm)",
                                          lattice.step, least, greatest));
}

/// Origin, spacing and direction along the slices; notes what is unusual.
void place_slices(const Frames& frames, const std::vector<SlicesAtPlace>& places, const std::vector<std::size_t>& chosen,
                  const SliceLattice& lattice, const Double3& normal, Arrangement& a) {
    const DicomPlace &low = frames[chosen.front()].place, &high = frames[chosen.back()].place;
    const Double3 way = high.position - low.position;
    a.geometry.spacing[2] = norm(way) / static_cast<double>(a.slices.size() - 1);
    const Double3 axis = unit(way);
    const double tilt = std::acos(std::min(1.0, inner(axis, normal))) * 180 / M_PI;
    if (tilt > 0.5)
        a.notes.push_back(
            fmt::format("the slices are stacked {:.1f} degrees off their normal (gantry tilt): the volume is kept sheared", tilt));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const double share = (places[k].along - places.front().along) / (places.back().along - places.front().along);
        const Double3 off = frames[chosen[k]].place.position - (low.position + way * share);
        if (norm(off) > 0.5 * std::min(low.spacing_i, low.spacing_j)) {
            a.notes.push_back(fmt::format("slices lie up to {:.2f} mm or more beside the line from the first to the last", norm(off)));
            break;
        }
    }
    say_steps(places, lattice, a);
    for (int i = 0; i < 3; ++i) a.geometry.direction.row[i][2] = axis[i];
}

void place_single(const DicomPlace& place, const Double3& normal, Arrangement& a, const std::string& where) {
    if (std::isnan(place.thickness))
        throw DicomSliceError(ErrorKind::input, "SliceThickness or SpacingBetweenSlices of the only slice is no number", where);
    a.geometry.spacing[2] = place.thickness > 0 ? place.thickness : 1;
    if (!(place.thickness > 0)) a.notes.push_back("one slice without a thickness: 1 mm is assumed");
    for (int i = 0; i < 3; ++i) a.geometry.direction.row[i][2] = normal[i];
}

} // namespace

Arrangement arrange(const Frames& frames, const std::vector<std::size_t>& stack, int frame, bool allow_gaps, const std::string& where) {
    Arrangement a;
    const DicomPlace& first = frames[stack.front()].place;
    const Double3 normal = normal_of(first);
    std::vector<SlicesAtPlace> places = places_of(frames, stack, normal, a.notes);
    const FrameChoice choice = choose_frame(places, frames, frame, where);
    a.places = places.size();
    const std::vector<std::size_t>& chosen = choice.slices;
    a.notes.insert(a.notes.end(), choice.notes.begin(), choice.notes.end());
    if (places.size() == 1) {
        a.slices = {{chosen.front(), chosen.front(), 0}};
        place_single(first, normal, a, where);
    } else {
        std::vector<double> along;
        for (const SlicesAtPlace& p : places) along.push_back(p.along);
        const double span = along.back() - along.front(), rounding = rounding_along(frames, stack, normal);
        constexpr double most_slices = 1e5, most_mm = 1e7;
        if (!(span < most_mm)) bad_file(where, "the slices lie up to {:g} mm apart: their positions are not those of a volume", span);
        const SliceLattice lattice = lattice_of(along, rounding);
        if (span / lattice.step > most_slices)
            bad_file(where, "the slices lie {:g} mm apart at a distance of {:g} mm: their positions are not those of a volume", span,
                     lattice.step);
        check_crowding(places, lattice, rounding, choice.times, allow_gaps, where);
        lay_out(places, chosen, lattice, allow_gaps, a, where);
        place_slices(frames, places, chosen, lattice, normal, a);
    }
    a.geometry.origin = frames[chosen.front()].place.position;
    a.geometry.spacing[0] = first.spacing_i;
    a.geometry.spacing[1] = first.spacing_j;
    for (int i = 0; i < 3; ++i) {
        a.geometry.direction.row[i][0] = first.row[i];
        a.geometry.direction.row[i][1] = first.column[i];
    }
    return a;
}

} // namespace clvr

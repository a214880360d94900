#include "host/io/volume/dicom/arrange.hpp"
#include "host/io/volume/dicom/lattice.hpp"
#include "host/io/volume/dicom/place.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace clvr {

namespace {

using Frames = std::vector<DicomFrame>;
constexpr double same_place_mm = 1e-3;

/// The slices at one place along the normal [mm].
struct Place {
    double along;
    std::vector<std::size_t> slices;
};

auto order_in_place(const DicomFrame& f) { return std::make_tuple(f.image->acquisition, f.time, f.image->instance, f.number); }

/// Whether b is a copy of a's file: what a file says of itself agrees, not its UID alone (some programs write one UID into all files).
bool is_copy(const DicomFrame& a, const DicomFrame& b) {
    return !a.image->instance_uid.empty() && a.image->instance_uid == b.image->instance_uid && order_in_place(a) == order_in_place(b) &&
           a.labels == b.labels && a.stack == b.stack && norm(a.place.position - b.place.position) <= same_place_mm;
}

std::vector<Place> places_of(const Frames& frames, std::vector<std::size_t> stack, const Double3& normal, std::vector<std::string>& notes) {
    const auto along = [&](std::size_t i) { return inner(frames[i].place.position, normal); };
    std::sort(stack.begin(), stack.end(), [&](std::size_t a, std::size_t b) {
        return std::make_tuple(along(a), order_in_place(frames[a]), frames[a].image->path) <
               std::make_tuple(along(b), order_in_place(frames[b]), frames[b].image->path);
    });
    std::vector<Place> places;
    std::size_t copies = 0;
    for (const std::size_t i : stack) {
        if (places.empty() || along(i) - places.back().along > same_place_mm) places.push_back({along(i), {}});
        auto& here = places.back().slices;
        if (std::any_of(here.begin(), here.end(), [&](std::size_t other) { return is_copy(frames[other], frames[i]); }))
            ++copies;
        else
            here.push_back(i);
    }
    if (copies > 0)
        notes.push_back(
            fmt::format("{} duplicate file{} (the same SOPInstanceUID twice) left out", copies, copies == 1 ? " was" : "s were"));
    return places;
}

using Labels = std::map<std::string, std::string>;

/// Orders each place by acquisition, time and number. Where that mixes what the labels tell apart (numbers that go on from slice to slice
/// in another order), the labels come first, in the order in which they appear.
void sort_places(std::vector<Place>& places, const Frames& frames) {
    const auto by_number = [&](std::size_t a, std::size_t b) { return order_in_place(frames[a]) < order_in_place(frames[b]); };
    for (Place& p : places) std::stable_sort(p.slices.begin(), p.slices.end(), by_number);
    const auto agree = [&] {
        return std::all_of(places.begin(), places.end(), [&](const Place& p) {
            return std::equal(p.slices.begin(), p.slices.end(), places.front().slices.begin(), places.front().slices.end(),
                              [&](std::size_t a, std::size_t b) { return frames[a].labels == frames[b].labels; });
        });
    };
    if (agree()) return;
    std::vector<std::size_t> all;
    for (const Place& p : places) all.insert(all.end(), p.slices.begin(), p.slices.end());
    std::stable_sort(all.begin(), all.end(), by_number);
    std::map<Labels, std::size_t> rank;
    for (const std::size_t i : all) rank.emplace(frames[i].labels, rank.size());
    std::vector<Place> by_label = places;
    for (Place& p : by_label)
        std::stable_sort(p.slices.begin(), p.slices.end(),
                         [&](std::size_t a, std::size_t b) { return rank.at(frames[a].labels) < rank.at(frames[b].labels); });
    by_label.swap(places);
    if (!agree()) by_label.swap(places);
}

/// "EchoTime 4.9, 9.8; time": in what the slices of a place differ.
std::string differences(const Place& place, const Frames& frames) {
    std::map<std::string, std::vector<std::string>> values;
    const auto keep = [&](const std::string& name, const std::string& value) {
        auto& known = values[name];
        if (std::find(known.begin(), known.end(), value) == known.end()) known.push_back(value);
    };
    std::set<std::pair<double, double>> times;
    for (const std::size_t i : place.slices) {
        const DicomFrame& f = frames[i];
        for (const auto& [name, value] : f.labels) keep(name, value);
        keep("StackID", f.stack);
        times.emplace(f.image->acquisition, f.time);
    }
    std::string text;
    constexpr std::size_t most = 8;
    for (const auto& [name, known] : values) {
        if (known.size() < 2) continue;
        text += (text.empty() ? "" : "; ") + name;
        for (std::size_t i = 0; i < std::min(known.size(), most); ++i) text += (i == 0 ? " " : ", ") + known[i];
        if (known.size() > most) text += ", ...";
    }
    if (times.size() > 1) text += text.empty() ? "time" : "; time";
    return text.empty() ? "time or echo" : text;
}

/// What makes slices one set: all but their number.
auto set_of(const DicomFrame& f) { return std::make_tuple(f.labels, f.stack, f.image->acquisition, f.time); }

/// Where places hold different numbers of slices: those of the set that is at every place, the first such; else all stay.
bool keep_whole_set(std::vector<Place>& places, const Frames& frames) {
    for (const std::size_t candidate : places.front().slices) {
        const auto set = set_of(frames[candidate]);
        const auto belongs = [&](std::size_t i) { return set_of(frames[i]) == set; };
        if (!std::all_of(places.begin(), places.end(),
                         [&](const Place& p) { return std::any_of(p.slices.begin(), p.slices.end(), belongs); }))
            continue;
        for (Place& p : places)
            p.slices.erase(std::remove_if(p.slices.begin(), p.slices.end(), [&](std::size_t i) { return !belongs(i); }), p.slices.end());
        return true;
    }
    return false;
}

std::size_t slices_in(const std::vector<Place>& places) {
    std::size_t n = 0;
    for (const Place& p : places) n += p.slices.size();
    return n;
}

/// One slice a place: frame `frame` where every place has as many, else the first.
std::vector<std::size_t> choose_frame(std::vector<Place>& places, const Frames& frames, int frame, Arrangement& a,
                                      const std::string& where) {
    sort_places(places, frames);
    const auto regular = [&] {
        return std::all_of(places.begin(), places.end(), [&](const Place& p) { return p.slices.size() == places.front().slices.size(); });
    };
    const std::size_t before = slices_in(places);
    if (!regular() && keep_whole_set(places, frames) && slices_in(places) < before)
        a.notes.push_back(fmt::format("{} slices of another acquisition, echo or type, which are not at every place, were left out",
                                      before - slices_in(places)));
    if (regular()) a.times = places.front().slices.size();
    check_frame(frame, static_cast<std::int64_t>(a.times), where);
    if (a.times > 1)
        a.notes.push_back(fmt::format("every slice is there {} times (differing in {}): frame {} is shown, --frame chooses", a.times,
                                      differences(places.front(), frames), frame));
    std::vector<std::size_t> chosen;
    for (const Place& p : places) chosen.push_back(p.slices[regular() ? static_cast<std::size_t>(frame) : 0]);
    const std::size_t duplicates = regular() ? 0 : slices_in(places) - places.size();
    if (duplicates > 0)
        a.notes.push_back(fmt::format("{} duplicate slice{} at the place of another left out", duplicates, duplicates == 1 ? "" : "s"));
    return chosen;
}

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
void lay_out(const std::vector<Place>& places, const std::vector<std::size_t>& chosen, const SliceLattice& lattice, bool allow_gaps,
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
void check_crowding(const std::vector<Place>& places, const SliceLattice& lattice, double rounding, std::size_t times, bool allow_gaps,
                    const std::string& where) {
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

void say_steps(const std::vector<Place>& places, const SliceLattice& lattice, Arrangement& a) {
    double least = lattice.step, greatest = lattice.step;
    for (std::size_t k = 1; k < places.size(); ++k) {
        if (lattice.index[k] != lattice.index[k - 1] + 1) continue;
        least = std::min(least, places[k].along - places[k - 1].along);
        greatest = std::max(greatest, places[k].along - places[k - 1].along);
    }
    if (greatest - least > same_place_mm)
        a.decisions.push_back(fmt::format("slice distance {:.6g} mm from the whole span (single distances are {:.6g} to {:.6g} mm)",
                                          a.geometry.spacing[2], least, greatest));
}

/// Origin, spacing and direction along the slices; notes what is unusual.
void place_slices(const Frames& frames, const std::vector<Place>& places, const std::vector<std::size_t>& chosen,
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
    std::vector<Place> places = places_of(frames, stack, normal, a.notes);
    a.places = places.size();
    const std::vector<std::size_t> chosen = choose_frame(places, frames, frame, a, where);
    if (places.size() == 1) {
        a.slices = {{chosen.front(), chosen.front(), 0}};
        place_single(first, normal, a, where);
    } else {
        std::vector<double> along;
        for (const Place& p : places) along.push_back(p.along);
        const double span = along.back() - along.front(), rounding = rounding_along(frames, stack, normal);
        constexpr double most_slices = 1e5, most_mm = 1e7;
        if (!(span < most_mm)) bad_file(where, "the slices lie up to {:g} mm apart: their positions are not those of a volume", span);
        const SliceLattice lattice = lattice_of(along, rounding);
        if (span / lattice.step > most_slices)
            bad_file(where, "the slices lie {:g} mm apart at a distance of {:g} mm: their positions are not those of a volume", span,
                     lattice.step);
        check_crowding(places, lattice, rounding, a.times, allow_gaps, where);
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

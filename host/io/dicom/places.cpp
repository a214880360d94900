#include "host/io/dicom/places.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace clvr {

namespace {

using Frames = std::vector<DicomFrame>;

auto order_in_place(const DicomFrame& f) { return std::make_tuple(f.image->acquisition, f.time, f.image->instance, f.number); }

/// Whether b is a copy of a's file: what the files say about themselves agrees. The UID alone does not tell, as some programs write one UID
/// into all files.
bool is_copy(const DicomFrame& a, const DicomFrame& b) {
    return !a.image->instance_uid.empty() && a.image->instance_uid == b.image->instance_uid && order_in_place(a) == order_in_place(b) &&
           a.labels == b.labels && a.stack == b.stack && norm(a.place.position - b.place.position) <= same_place_mm;
}

using Labels = std::map<std::string, std::string>;

/// Orders the slices of each place by acquisition, time and number. Where that would mix what the labels tell apart (numbers that continue
/// from slice to slice in another order), the labels come first, in the order in which they appear.
void sort_places(std::vector<SlicesAtPlace>& places, const Frames& frames) {
    const auto by_number = [&](std::size_t a, std::size_t b) { return order_in_place(frames[a]) < order_in_place(frames[b]); };
    for (SlicesAtPlace& p : places) std::stable_sort(p.slices.begin(), p.slices.end(), by_number);
    const auto agree = [&] {
        return std::all_of(places.begin(), places.end(), [&](const SlicesAtPlace& p) {
            return std::equal(p.slices.begin(), p.slices.end(), places.front().slices.begin(), places.front().slices.end(),
                              [&](std::size_t a, std::size_t b) { return frames[a].labels == frames[b].labels; });
        });
    };
    if (agree()) return;
    std::vector<std::size_t> all;
    for (const SlicesAtPlace& p : places) all.insert(all.end(), p.slices.begin(), p.slices.end());
    std::stable_sort(all.begin(), all.end(), by_number);
    std::map<Labels, std::size_t> rank;
    for (const std::size_t i : all) rank.emplace(frames[i].labels, rank.size());
    std::vector<SlicesAtPlace> by_label = places;
    for (SlicesAtPlace& p : by_label)
        std::stable_sort(p.slices.begin(), p.slices.end(),
                         [&](std::size_t a, std::size_t b) { return rank.at(frames[a].labels) < rank.at(frames[b].labels); });
    by_label.swap(places);
    if (!agree()) by_label.swap(places);
}

/// How the slices of a place differ: "EchoTime 4.9, 9.8; time".
std::string differences(const SlicesAtPlace& place, const Frames& frames) {
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

/// For places with different numbers of slices: keeps the slices of the first set that is at every place; keeps all where there is no such
/// set.
bool keep_whole_set(std::vector<SlicesAtPlace>& places, const Frames& frames) {
    for (const std::size_t candidate : places.front().slices) {
        const auto set = set_of(frames[candidate]);
        const auto belongs = [&](std::size_t i) { return set_of(frames[i]) == set; };
        if (!std::all_of(places.begin(), places.end(),
                         [&](const SlicesAtPlace& p) { return std::any_of(p.slices.begin(), p.slices.end(), belongs); }))
            continue;
        for (SlicesAtPlace& p : places)
            p.slices.erase(std::remove_if(p.slices.begin(), p.slices.end(), [&](std::size_t i) { return !belongs(i); }), p.slices.end());
        return true;
    }
    return false;
}

/// Where no set is at every place: echoes and types are not mixed; those at the most places stay. Returns whether any slice was dropped.
bool keep_largest_kind(std::vector<SlicesAtPlace>& places, const Frames& frames) {
    std::map<Labels, std::size_t> at; // how many places have it
    for (const SlicesAtPlace& p : places) {
        std::set<Labels> here;
        for (const std::size_t i : p.slices) here.insert(frames[i].labels);
        for (const Labels& labels : here) ++at[labels];
    }
    if (at.size() < 2) return false;
    const Labels kept = std::max_element(at.begin(), at.end(), [](const auto& a, const auto& b) { return a.second < b.second; })->first;
    for (SlicesAtPlace& p : places)
        p.slices.erase(std::remove_if(p.slices.begin(), p.slices.end(), [&](std::size_t i) { return frames[i].labels != kept; }),
                       p.slices.end());
    places.erase(std::remove_if(places.begin(), places.end(), [](const SlicesAtPlace& p) { return p.slices.empty(); }), places.end());
    return true;
}

} // namespace

std::vector<SlicesAtPlace> places_of(const Frames& frames, std::vector<std::size_t> stack, const Double3& normal,
                                     std::vector<std::string>& notes) {
    const auto along = [&](std::size_t i) { return inner(frames[i].place.position, normal); };
    std::sort(stack.begin(), stack.end(), [&](std::size_t a, std::size_t b) {
        return std::make_tuple(along(a), order_in_place(frames[a]), frames[a].image->path) <
               std::make_tuple(along(b), order_in_place(frames[b]), frames[b].image->path);
    });
    std::vector<SlicesAtPlace> places;
    std::size_t copies = 0;
    for (const std::size_t i : stack) {
        if (places.empty() || along(i) - places.back().along > same_place_mm) places.push_back({along(i), {}});
        auto& here = places.back().slices;
        const auto other = std::find_if(here.rbegin(), here.rend(), [&](std::size_t o) {
            return order_in_place(frames[o]) != order_in_place(frames[i]) || is_copy(frames[o], frames[i]);
        });
        if (other != here.rend() && is_copy(frames[*other], frames[i]))
            ++copies;
        else
            here.push_back(i);
    }
    if (copies > 0)
        notes.push_back(
            fmt::format("{} duplicate file{} (the same SOPInstanceUID twice) left out", copies, copies == 1 ? " was" : "s were"));
    return places;
}

std::size_t slices_in(const std::vector<SlicesAtPlace>& places) {
    std::size_t n = 0;
    for (const SlicesAtPlace& p : places) n += p.slices.size();
    return n;
}

FrameChoice choose_frame(std::vector<SlicesAtPlace>& places, const Frames& frames, int frame, const std::string& where) {
    FrameChoice a;
    sort_places(places, frames);
    const auto is_regular = [&] {
        return std::all_of(places.begin(), places.end(),
                           [&](const SlicesAtPlace& p) { return p.slices.size() == places.front().slices.size(); });
    };
    const std::size_t before = slices_in(places);
    if (!is_regular() && (keep_whole_set(places, frames) || keep_largest_kind(places, frames)) && slices_in(places) < before)
        a.notes.push_back(fmt::format("{} slices of another acquisition, echo or type, which are not at every place, were left out",
                                      before - slices_in(places)));
    const bool regular = is_regular();
    if (regular) a.times = places.front().slices.size();
    check_frame(frame, static_cast<std::int64_t>(a.times), where);
    if (a.times > 1)
        a.notes.push_back(fmt::format("every slice is there {} times (differing in {}): frame {} is shown, --frame chooses", a.times,
                                      differences(places.front(), frames), frame));
    for (const SlicesAtPlace& p : places) a.slices.push_back(p.slices[regular ? static_cast<std::size_t>(frame) : 0]);
    const std::size_t duplicates = regular ? 0 : slices_in(places) - places.size();
    if (duplicates > 0)
        a.notes.push_back(fmt::format("{} duplicate slice{} at the place of another left out", duplicates, duplicates == 1 ? "" : "s"));
    return a;
}

} // namespace clvr

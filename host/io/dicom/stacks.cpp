#include "host/io/dicom/stacks.hpp"
#include "host/io/dicom/place.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace clvr {

namespace {

using Stack = std::vector<std::size_t>;

bool is_localizer(const DicomFrame& f) { return f.image->image_type.find("LOCALIZER") != std::string::npos; }

/// Whether two slices can lie in one stack, apart from their StackID.
bool alike(const DicomFrame& a, const DicomFrame& b) {
    constexpr double same_direction = 2e-3; // a rounding of 1e-3 in each coordinate
    const DicomPixels &p = a.image->pixels, &q = b.image->pixels;
    const DicomPlace &x = a.place, &y = b.place;
    return a.columns == b.columns && a.rows == b.rows && p.bits_allocated == q.bits_allocated && p.is_signed == q.is_signed &&
           p.is_float == q.is_float && norm(x.row - y.row) < same_direction && norm(x.column - y.column) < same_direction &&
           std::abs(x.spacing_i - y.spacing_i) < 1e-3 * x.spacing_i && std::abs(x.spacing_j - y.spacing_j) < 1e-3 * x.spacing_j &&
           is_localizer(a) == is_localizer(b);
}

/// Places along the normal, in hundredths of a millimetre.
std::set<long> places(const std::vector<DicomFrame>& frames, const Stack& stack) {
    const Double3 normal = normal_of(frames[stack.front()].place);
    std::set<long> all;
    for (const std::size_t i : stack) all.insert(std::lround(std::clamp(inner(frames[i].place.position, normal), -1e9, 1e9) * 100));
    return all;
}

} // namespace

std::vector<std::vector<std::size_t>> stacks_of(const std::vector<DicomFrame>& frames) {
    std::vector<Stack> stacks;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const auto stack = std::find_if(stacks.begin(), stacks.end(), [&](const Stack& s) {
            return alike(frames[s.front()], frames[i]) && frames[s.front()].stack == frames[i].stack;
        });
        if (stack == stacks.end())
            stacks.push_back({i});
        else
            stack->push_back(i);
    }
    std::vector<Stack> joined;
    for (const Stack& s : stacks) {
        const auto same = std::find_if(joined.begin(), joined.end(), [&](const Stack& t) {
            return alike(frames[t.front()], frames[s.front()]) && places(frames, t) == places(frames, s);
        });
        if (same == joined.end())
            joined.push_back(s);
        else
            same->insert(same->end(), s.begin(), s.end());
    }
    return joined;
}

} // namespace clvr

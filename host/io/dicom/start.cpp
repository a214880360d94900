#include "host/io/dicom/start.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace clvr {

namespace {

constexpr std::array<std::string_view, 34> types{"AE", "AS", "AT", "CS", "DA", "DS", "DT", "FL", "FD", "IS", "LO", "LT",
                                                 "OB", "OD", "OF", "OL", "OV", "OW", "PN", "SH", "SL", "SQ", "SS", "ST",
                                                 "SV", "TM", "UC", "UI", "UL", "UN", "UR", "US", "UT", "UV"};
constexpr std::array<std::string_view, 13> long_types{"OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC", "UN", "UR", "UT", "UV"};

template <class List>
bool holds(const List& list, std::string_view s) {
    return std::find(list.begin(), list.end(), s) != list.end();
}

/// Reads elements of the head without leaving it.
struct HeadElements {
    std::string_view head;
    bool implicit, big;

    std::uint32_t whole(std::size_t at, std::size_t n) const {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < n; ++i) value |= std::uint32_t{static_cast<unsigned char>(head[at + (big ? n - 1 - i : i)])} << (8 * i);
        return value;
    }
    struct Element {
        std::uint32_t group, element;
        std::size_t next;
    };
    /// A plausible element of the first groups at `at`; `next` may lie beyond the head.
    std::optional<Element> element(std::size_t at) const {
        if (at + 12 > head.size()) return std::nullopt;
        Element e{whole(at, 2), whole(at + 2, 2), 0};
        std::size_t length = 0, start = at + 8;
        const std::string_view type = head.substr(at + 4, 2);
        if (implicit) {
            length = whole(at + 4, 4);
        } else if (!holds(types, type)) {
            return std::nullopt;
        } else if (holds(long_types, type)) {
            if (head[at + 6] != 0 || head[at + 7] != 0) return std::nullopt;
            length = whole(at + 8, 4);
            start = at + 12;
        } else {
            length = whole(at + 6, 2);
        }
        constexpr std::size_t longest = 4096; // of what stands first: a group's length, character sets, image type, UIDs
        if (length > longest || length % 2 != 0) return std::nullopt;
        e.next = start + length;
        return e;
    }
};

/// Two elements in a row, the first of group 2 or 8.
bool begins_data_set(std::string_view head, bool implicit, bool big) {
    const HeadElements elements{head, implicit, big};
    const auto first = elements.element(0);
    if (!first || (first->group != 2 && first->group != 8) || (first->group == 2 && (implicit || big))) return false;
    constexpr std::uint32_t last_of_group_2 = 0x0102, last_of_group_8 = 0x0080;
    if (first->element > (first->group == 2 ? last_of_group_2 : last_of_group_8)) return false;
    const auto second = elements.element(first->next);
    if (!second) return false;
    return (second->group == first->group && second->element > first->element) || (second->group > first->group && second->group <= 0x20);
}

std::optional<DicomStart> start_of_data_set(std::string_view head) {
    for (const bool big : {false, true})
        for (const bool implicit : {false, true})
            if (!(implicit && big) && begins_data_set(head, implicit, big)) return DicomStart{0, !big && head[0] == 2, implicit, big};
    return std::nullopt;
}

} // namespace

std::optional<DicomStart> dicom_start(const std::string& head) {
    for (const std::size_t mark : {std::size_t{128}, std::size_t{0}})
        if (head.size() >= mark + 4 && head.compare(mark, 4, "DICM") == 0) {
            const std::string rest = head.substr(mark + 4);
            DicomStart start = dicom_syntax_of(rest);
            start.offset = mark + 4;
            start.has_meta = rest.size() < 2 || (rest[0] == 2 && rest[1] == 0);
            return start;
        }
    return start_of_data_set(head);
}

DicomStart dicom_syntax_of(const std::string& head) {
    if (const auto start = start_of_data_set(head)) return *start;
    DicomStart start;
    start.implicit = head.size() >= 6 && !holds(types, std::string_view(head).substr(4, 2));
    start.big_endian = !start.implicit && head.size() >= 2 && head[0] == 0 && head[1] != 0;
    return start;
}

} // namespace clvr

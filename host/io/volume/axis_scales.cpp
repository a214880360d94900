#include "host/io/volume/axis_scales.hpp"
#include "host/io/volume/length_unit.hpp"

#include <cmath>
#include <fmt/format.h>
#include <optional>

namespace clvr {

namespace {

constexpr const char* axis_names = "xyz";
constexpr const char* no_spacing = "the file gives no voxel spacing: 1 mm is assumed (--spacing sets it)";

bool is_given(const AxisScale& s) { return s.value > 0 && std::isfinite(s.value); }

/// Lengths where at least one axis has a known unit: the others take the unit of an earlier axis, else of a later one.
ResolvedSpacing with_units(const AxisScales& scales, const std::array<std::optional<double>, 3>& mm, std::size_t slices) {
    ResolvedSpacing r;
    for (std::size_t i = 0; i < 3; ++i) {
        if (mm[i]) {
            r.spacing[i] = *mm[i];
            r.decisions.push_back(
                fmt::format("spacing {} from {}: {:g} {}", axis_names[i], scales[i].source, scales[i].value, scales[i].unit));
            continue;
        }
        std::size_t other = 0;
        while (other == i || !mm[other]) ++other;
        r.spacing[i] = *mm[other];
        std::string text =
            is_given(scales[i])
                ? fmt::format("the unit \"{}\" of {} is no known length: spacing {} is taken as that of {} (--spacing sets it)",
                              scales[i].unit, scales[i].source, axis_names[i], axis_names[other])
                : fmt::format("the file gives no spacing {}: it is taken as that of {}, {:g} mm (--spacing sets it)", axis_names[i],
                              axis_names[other], r.spacing[i]);
        (i == 2 && slices == 1 ? r.decisions : r.notes).push_back(std::move(text));
    }
    return r;
}

} // namespace

ResolvedSpacing resolve_spacing(const AxisScales& scales, std::size_t slices) {
    std::array<std::optional<double>, 3> mm;
    for (std::size_t i = 0; i < 3; ++i)
        if (const auto unit = millimetres_of(scales[i].unit); unit && is_given(scales[i])) mm[i] = scales[i].value * *unit;
    if (mm[0] || mm[1] || mm[2]) return with_units(scales, mm, slices);

    ResolvedSpacing r;
    if (!is_given(scales[0])) {
        r.notes.push_back(no_spacing);
        return r;
    }
    for (std::size_t i = 1; i < 3; ++i)
        if (is_given(scales[i])) r.spacing[i] = scales[i].value / scales[0].value;
    const std::string& unit = scales[0].unit;
    if (r.spacing == Double3{1, 1, 1})
        r.notes.push_back(no_spacing);
    else
        r.notes.push_back(fmt::format("{}: the proportions {:g} : {:g} : {:g} are kept, and 1 mm a pixel is assumed (--spacing sets it)",
                                      unit.empty() ? std::string("the file gives no unit of length")
                                                   : fmt::format("the file's unit \"{}\" is no known length", unit),
                                      r.spacing[0], r.spacing[1], r.spacing[2]));
    return r;
}

} // namespace clvr

// Units of length as microscopes and image programs spell them.
#pragma once
#include <optional>
#include <string_view>

namespace clvr {

/// How many millimetres the unit has: symbols ("um", "µm" in UTF-8 or Latin-1, "\u00B5m" as ImageJ escapes it, "mm", "Å") are taken as
/// they are written, words ("micron", "Millimeters", "inch") in any case. Nothing for what is no length ("pixel") or not known.
std::optional<double> millimetres_of(std::string_view unit);

} // namespace clvr

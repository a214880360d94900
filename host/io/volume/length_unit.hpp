// Units of length as files name them.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clvr {

/// Millimetres of a unit by its symbol or its English name, in any case, singular or plural ("mm", "micrometers", "µm" in UTF-8 or
/// Latin-1, "inch", ...); nothing for a word that is no unit of length.
std::optional<double> millimetres_of(std::string_view unit);

/// As millimetres_of; 1 for an empty text, and with a note for a word that is no unit of length.
double unit_or_millimetre(std::string_view unit, std::vector<std::string>& notes);

} // namespace clvr

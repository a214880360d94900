// Names that a mistyped one may mean.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// The name that differs least from the word, where it begins with the word or takes at most two changes (one in words of one or two
/// letters): a letter more, less, or another, or two swapped. Empty: none is near.
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);

} // namespace clvr

// Names that a mistyped one may mean.
#pragma once
#include <string>
#include <vector>

namespace clvr {

/// The name closest to the word: one that begins with the word, or that takes at most two changes (one for words of one or two letters). A
/// change is a letter more, a letter less, another letter, or two letters swapped. Empty where no name is close.
std::string nearest_name(const std::string& word, const std::vector<std::string>& names);

} // namespace clvr

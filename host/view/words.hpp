// What went wrong, for people.
#pragma once
#include <string>

namespace clvr::view {

/// One line about the exception that is being handled.
std::string words_of_exception();

} // namespace clvr::view

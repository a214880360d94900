// What was thrown, as clvr's one type of error: for threads that live on.
#pragma once
#include "runtime/error.hpp"

namespace clvr {

/// The exception that is being handled: an Error as it is, anything else as one that says it.
Error caught_error();

} // namespace clvr

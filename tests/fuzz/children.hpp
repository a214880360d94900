// What readers do in processes that they fork (libhdf5, the codecs of DICOM), seen by libFuzzer.
#pragma once
#include <string>

namespace clvr::test {

/// From now on a child's edges count as this process's, and a sanitizer's report of a child is a file in `folder`, an empty one.
void watch_children(const std::string& folder);

/// Aborts where a child's report blames clvr: its text goes to standard error. A library that crashes is what the child is for.
void end_at_childs_report();

} // namespace clvr::test

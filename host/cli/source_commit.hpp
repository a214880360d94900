// Which state of the source the program was built from.
#pragma once

namespace clvr {

/// The commit's abbreviated hash, "-dirty" after it where files differed; empty where there was no repository. Defined by
/// tools/commit.cmake.
const char* source_commit();

} // namespace clvr

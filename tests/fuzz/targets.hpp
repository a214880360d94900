// Every reader of clvr's own as a function of bytes: what libFuzzer runs, and the test that plays the samples and their mutations.
#pragma once
#include "runtime/error.hpp"

#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace clvr::test {

/// A reader under test. A new format is one line of the table in targets.cpp.
struct FuzzTarget {
    std::string name;
    std::vector<std::string> files;        ///< the names under which the bytes are put: an input is cut into so many at file_mark
    void (*read)(const std::string& path); ///< of the first of the files; throws Error for a file that it refuses
    ErrorKind refusal = ErrorKind::input;  ///< the kind of that error
    std::string format = {};               ///< the volume formats of tests/io whose name starts so are its samples; empty: `name`

    friend void PrintTo(const FuzzTarget& t, std::ostream* out) { *out << t.name; }
};

const std::vector<FuzzTarget>& fuzz_targets();
/// Throws std::out_of_range.
const FuzzTarget& fuzz_target(const std::string& name);

/// Stands between the files of one input.
constexpr std::string_view file_mark = "\n--8<--\n";

/// Puts the bytes into files below `folder` and reads them. True: read; false: refused as it should be. Throws std::logic_error for what no
/// reader may do: an error of another kind, of several lines or without a place, a result whose parts do not fit together; lets through
/// what the reader throws beside Error.
bool read_bytes(const FuzzTarget& target, const std::string& folder, std::string_view bytes);

} // namespace clvr::test

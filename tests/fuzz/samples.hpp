// Sound inputs of every fuzz target, from the writers of the tests.
#pragma once
#include "tests/fuzz/targets.hpp"

#include <string>
#include <vector>

namespace clvr::test {

struct FuzzSample {
    std::string name, bytes; ///< several files with file_mark between them
};
/// At least one; each is read by the target.
std::vector<FuzzSample> fuzz_samples(const FuzzTarget& target);

} // namespace clvr::test

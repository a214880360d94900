// Volumes as the samples of fuzz targets.
#pragma once
#include "tests/fuzz/samples.hpp"

#include <vector>

namespace clvr::test {

/// Of the formats of tests/io that the target reads, those with as many files as it takes; and what these formats may hold beside.
std::vector<FuzzSample> volume_samples(const FuzzTarget& target);

} // namespace clvr::test

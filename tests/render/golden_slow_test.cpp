// The same bits, in the variants that take long to compile.
#include "tests/render/golden.hpp"

namespace clvr::testing {
namespace {

TEST(Golden, FourAndEightPoolsGiveTheSameBits) {
    expect_golden_in_pools("automatic", 4, "1500k");
    expect_golden_in_pools("automatic", 8, "750k");
}

TEST(Golden, EveryModeGivesTheSameBitsAtEveryWidth) {
    for (int width : {1, 4, 8, 16})
        for (const auto& [name, hash] : golden_hashes) expect_golden(name, {{"packet", width}, {"brick_log2", 4}});
}

} // namespace
} // namespace clvr::testing

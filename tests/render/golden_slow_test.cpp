// The same bits, in the variants that take long to compile.
#include "tests/contracting_kernels.hpp"
#include "tests/render/golden.hpp"

namespace clvr::testing {
namespace {

TEST(Golden, FourAndEightPoolsGiveTheSameBits) {
    expect_golden_in_pools("automatic", 4, "1500k");
    expect_paths_in_pools("automatic", 8, "750k");
}

TEST(Golden, EveryModeGivesTheSameBitsAtEveryWidth) {
    for (int width : {1, 4, 8, 16})
        for (const auto& [name, hash] : golden_hashes) expect_golden(name, {{"packet", width}, {"brick_log2", 4}});
}

/// Compilers may contract a * b + c unless they are told not to, and some do it even then: no bit of clvr may depend on it.
TEST(Golden, ContractionChangesNoBit) {
    const TemporaryFolder folder;
    int allowed = 0;
    for (const auto& [path, text] : contracting_kernels(allowed)) folder.write(path, text);
    ASSERT_GT(allowed, 1);
    const ScopedKernels kernels(folder);
    for (const auto& [name, hash] : golden_hashes) expect_golden(name);
}

} // namespace
} // namespace clvr::testing

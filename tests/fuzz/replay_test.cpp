// Every fuzz target without libFuzzer: its samples are read, and a fixed set of damaged ones is read or refused properly. tools/fuzz.sh
// goes further.
#include "tests/fuzz/mutation.hpp"
#include "tests/fuzz/samples.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

namespace clvr::test {
namespace {

class EveryReader : public ::testing::TestWithParam<FuzzTarget> {
protected:
    TemporaryFolder folder;
    std::vector<FuzzSample> samples = fuzz_samples(GetParam());
    bool read(const std::string& bytes) const { return read_bytes(GetParam(), folder.path().string(), bytes); }
};

TEST_P(EveryReader, ReadsItsSamples) {
    ASSERT_FALSE(samples.empty());
    for (const FuzzSample& sample : samples) EXPECT_TRUE(read(sample.bytes)) << sample.name;
}

TEST_P(EveryReader, SurvivesDamage) {
    EXPECT_NO_THROW(read(""));
    std::mt19937_64 random(13);
    for (int i = 0; i < 400; ++i) {
        const std::string bytes = mutated(samples[random() % samples.size()].bytes, samples[random() % samples.size()].bytes, random);
        EXPECT_NO_THROW(read(bytes)) << "damage " << i;
    }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, EveryReader, ::testing::ValuesIn(fuzz_targets()), [](const auto& p) { return p.param.name; });

} // namespace
} // namespace clvr::test

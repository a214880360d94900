// The workarounds, each tested where its driver is installed.
#include "runtime/drivers/quirks.hpp"

#include "runtime/drivers/facts.hpp"
#include "runtime/opencl/program.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clvr {
namespace {

constexpr const char *pocl = "Portable Computing Language", *oclgrind = "Oclgrind";

TEST(Quirks, GoByThePlatform) {
    for (const char* other : {"NVIDIA CUDA", "rusticl", "Intel(R) OpenCL", ""}) {
        EXPECT_FALSE(quirks::pocl_aborts_on_broken_binaries(other));
        EXPECT_FALSE(quirks::pocl_reads_a_header_of_all_builtins(other, "3.1"));
        EXPECT_FALSE(quirks::oclgrind_claims_every_device_type(other));
        EXPECT_FALSE(quirks::oclgrind_ignores_line_directives(other));
        EXPECT_FALSE(quirks::oclgrind_knows_no_noalias_scopes(other));
    }
    EXPECT_TRUE(quirks::pocl_aborts_on_broken_binaries(pocl));
    EXPECT_TRUE(quirks::pocl_reads_a_header_of_all_builtins(pocl, "3.1+debian"));
    EXPECT_FALSE(quirks::pocl_reads_a_header_of_all_builtins(pocl, "6.0+debian"));
    EXPECT_TRUE(quirks::oclgrind_claims_every_device_type(oclgrind));
    EXPECT_TRUE(quirks::oclgrind_ignores_line_directives(oclgrind));
    EXPECT_TRUE(quirks::oclgrind_knows_no_noalias_scopes(oclgrind));
}

TEST(Quirks, StampsThatRunBackwardsAreNoTime) {
    EXPECT_DOUBLE_EQ(quirks::milliseconds_though_stamps_run_backwards(1000, 2001000), 2);
    EXPECT_EQ(quirks::milliseconds_though_stamps_run_backwards(2000, 1000), 0) << "not 2^64 ns";
    EXPECT_EQ(quirks::milliseconds_though_stamps_run_backwards(7, 7), 0);
}

TEST(Quirks, OclgrindIsBuiltWithoutInlining) {
    DeviceFacts facts;
    facts.platform = oclgrind;
    EXPECT_THAT(build_options(facts, {}), testing::HasSubstr("-fno-inline"));
    facts.platform = pocl;
    EXPECT_THAT(build_options(facts, {}), testing::Not(testing::HasSubstr("-fno-inline")));
}

/// For the installed drivers: clvr recognises each by what it claims to be.
TEST(Quirks, InstalledDrivers) {
    for (const DeviceFacts& d : list_devices()) {
        EXPECT_EQ(d.simulator, d.platform == oclgrind) << d.platform;
        EXPECT_EQ(d.pocl, d.platform == pocl) << d.platform;
        if (d.simulator) {
            EXPECT_EQ(d.type, DeviceType::cpu) << "whatever it claims";
        }
    }
}

} // namespace
} // namespace clvr

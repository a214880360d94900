#include "runtime/trust/trust.hpp"

#include "runtime/choose/select.hpp"
#include "runtime/opencl/device.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clvr {
namespace {

DeviceFacts chosen() { return select_devices().devices.at(0); }

/// A kernel folder in which the device's list of operations has one expression replaced, so that the device computes what a faulty one
/// would; the host keeps the right list, which is compiled in.
void write_faulty_operations(const TemporaryFolder& folder, const std::string& right, const std::string& wrong) {
    std::string list = read_kernel_file("shared/trust_operations.h").value();
    const std::size_t at = list.find(right);
    ASSERT_NE(at, std::string::npos) << right;
    folder.write("shared/trust_operations.h", list.replace(at, right.size(), wrong));
}

TEST(Trust, ThisDevicePasses) {
    const Trust trust = probe_trust(chosen());
    EXPECT_EQ(trust.failures, std::vector<std::string>{});
    EXPECT_EQ(trust.text(), "ok");
}

struct Fault {
    const char *operation, *right, *wrong;
};

class FaultyDevice : public testing::TestWithParam<Fault> {};

TEST_P(FaultyDevice, IsFoundByTheOperation) {
    const TemporaryFolder folder;
    write_faulty_operations(folder, GetParam().right, GetParam().wrong);
    const ScopedKernels kernels(folder);
    const Trust trust = probe_trust(chosen());
    ASSERT_EQ(trust.failures.size(), 2u) << trust.text(); // at both widths
    EXPECT_THAT(trust.failures, testing::Each(testing::StartsWith(std::string(GetParam().operation) + " (")));
    EXPECT_FALSE(trust.ok());
}

INSTANTIATE_TEST_SUITE_P(, FaultyDevice,
                         testing::Values(Fault{"contraction", "a* b + c", "fma(a, b, c)"}, Fault{"divide", "a / b", "a * (1.0f / b)"},
                                         Fault{"rint", "rint(r)", "floor(r + 0.5f)"},
                                         Fault{"multiply_64_bit", "high_of_product(u, v)", "u* v"}),
                         [](const auto& fault) { return std::string(fault.param.operation); });

TEST(Trust, FaultyDeviceIsRefusedByNameUnlessRelaxed) {
    const TemporaryFolder folder;
    write_faulty_operations(folder, "a / b", "a * (1.0f / b)");
    const ScopedKernels kernels(folder);
    const DeviceFacts facts = chosen();
    try {
        open_trusted(facts);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::device);
        EXPECT_EQ(error.where(), facts.name);
        EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("divide ("), testing::HasSubstr("--relaxed")));
    }
    EXPECT_NO_THROW(Device::open_untested(facts));
}

TEST(Trust, IsStoredPerProbeAndDriver) {
    const TemporaryFolder cache, kernels_folder;
    const ScopedVariable variable("XDG_CACHE_HOME", cache.path().string());
    // Another text, so another key than what this process may know already.
    kernels_folder.write("probe/trust.cl", "// " + cache.path().string() + "\n" + read_kernel_file("probe/trust.cl").value());
    const ScopedKernels kernels(kernels_folder);
    DeviceFacts facts = chosen();
    EXPECT_FALSE(stored_trust(facts));
    EXPECT_TRUE(trust_of(facts).ok());
    ASSERT_TRUE(stored_trust(facts));
    EXPECT_TRUE(stored_trust(facts)->ok());
    for (const auto& entry : std::filesystem::directory_iterator(cache.path() / "clvr" / "trust"))
        std::ofstream(entry.path()) << "{\"failures\": 3";
    EXPECT_FALSE(stored_trust(facts)) << "a broken file is no answer";
    facts.driver_version += ".1";
    EXPECT_FALSE(stored_trust(facts)) << "another driver is probed anew";
}

} // namespace
} // namespace clvr

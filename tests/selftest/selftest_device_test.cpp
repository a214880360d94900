// The self-test's checks as one suite over every device here, whole and divided, and the proof that each of them can fail.
#include "host/selftest/golden.hpp"
#include "host/selftest/selftest.hpp"
#include "runtime/error.hpp"
#include "runtime/opencl/source.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace clvr::selftest {
namespace {

using testing::HasSubstr;

/// The usable devices but simulators (those run in tests/cli/conformance_slow_test.cpp), and a part of each that can be divided.
std::vector<DeviceFacts> devices_here() {
    std::vector<DeviceFacts> devices;
    for (const DeviceFacts& d : list_devices()) {
        if (d.simulator || !why_unusable(d).empty()) continue;
        devices.push_back(d);
        if (d.max_sub_devices >= 2) devices.push_back(divide(d, 2).back());
    }
    return devices;
}

TEST(Checks, PassOnEveryDevice) {
    const auto devices = devices_here();
    ASSERT_FALSE(devices.empty());
    for (const DeviceFacts& d : devices)
        for (const Result& r : run_checks(d, chosen_checks({})))
            EXPECT_TRUE(r.outcome.ok) << r.check->name << " on " << d.name << ", part " << d.sub_device << ": expected "
                                      << r.outcome.expected << "; found " << r.outcome.found;
}

/// A driver's fault, as a change of one kernel file, and the checks that must find it.
struct Fault {
    const char *name, *file, *right, *wrong;
    std::vector<std::string> found_by;
};

class Faulty : public testing::TestWithParam<Fault> {};

TEST_P(Faulty, IsFound) {
    const Fault& fault = GetParam();
    std::string text = read_kernel_file(fault.file).value();
    const std::size_t at = text.find(fault.right);
    ASSERT_NE(at, std::string::npos) << fault.file << " has no " << fault.right;
    const TemporaryFolder folder;
    folder.write(fault.file, text.replace(at, std::string(fault.right).size(), fault.wrong));
    const clvr::ScopedKernels kernels(folder);
    for (const Result& r : run_checks(devices_here().front(), chosen_checks(fault.found_by))) {
        EXPECT_FALSE(r.outcome.ok) << r.check->name << " found " << r.outcome.found;
        EXPECT_NE(r.outcome.found, r.outcome.expected);
        EXPECT_THAT(r.outcome.expected, testing::Not(HasSubstr("to run"))) << "it should run, and give something else: " << r.outcome.found;
    }
}

const Fault faults[] = {
    {"divide", "shared/trust_operations.h", "a / b", "a * (1.0f / b)", {"trust"}},
    {"layout", "shared/render_params.h", "int width, height;", "int height, width;", {"layout"}},
    {"philox", "lib/random.clh", "0xD2511F53ul", "0xD2511F55ul", {"random"}},
    {"log", "lib/math.clh", "0.128791735f", "0.1287f", {"functions"}},
    {"bricks",
     "lib/volume.clh",
     "return fma(t, b - a, a);",
     "return fma(t * 0.999f, b - a, a);",
     {"seams", "picture", "frame-mip", "frame-dvr", "frame-phase", "frame-automatic", "frame-gradient"}},
    {"cells", "lib/volume.clh", "+ cell.y) * p->cells.x", "+ (cell.y ^ 1)) * p->cells.x", {"majorants"}},
    {"march", "render/march.cl", "-vol->p->extinction * step", "-vol->p->extinction * step * 0.999f", {"slab"}},
    {"albedo",
     "render/shade.cl",
     "throughput = product(throughput, albedo);",
     "throughput = scaled(product(throughput, albedo), 0.9f);",
     {"furnace"}},
    {"splat", "denoise/splat.cl", "(float4)(lower[i])", "(float4)(lower[i] * 0.999f)", {"denoised"}},
    {"backward", "train/guide_gradient.cl", "fma(-a.w, colour.w", "fma(a.w, colour.w", {"gradient"}},
    {"order", "train/sum_runs.cl", "(size_t)j * step", "(size_t)(run - 1 - j) * step", {"training"}},
    {"moments", "train/adam.cl", "rates.y * g", "rates.x * g", {"training"}},
};
INSTANTIATE_TEST_SUITE_P(Devices, Faulty, testing::ValuesIn(faults), [](const auto& fault) { return std::string(fault.param.name); });

TEST(Faults, CoverEveryCheck) {
    std::set<std::string> covered, all;
    for (const Fault& f : faults) covered.insert(f.found_by.begin(), f.found_by.end());
    for (const Check& c : checks()) all.insert(c.name);
    EXPECT_EQ(covered, all);
}

TEST(Checks, OfAKernelThatDoesNotBuildFailWithTheCompilersWords) {
    const TemporaryFolder folder;
    folder.write("lib/random.clh", "static int wrong(void) { return undeclared_name; }\n");
    const clvr::ScopedKernels kernels(folder);
    const auto results = run_checks(devices_here().front(), chosen_checks({"random", "trust"}));
    EXPECT_EQ(failed_names(results), "random");
    EXPECT_THAT(results.back().outcome.found,
                testing::AllOf(HasSubstr("does not build"), HasSubstr("undeclared_name"), testing::Not(HasSubstr("\n"))));
}

TEST(Checks, AreChosenByNameAndUnknownOnesRefused) {
    ASSERT_EQ(chosen_checks({"layout", "trust"}).size(), 2u);
    EXPECT_STREQ(chosen_checks({"layout", "trust"})[0]->name, "trust") << "in the order of the suite";
    try {
        chosen_checks({"trust", "nonsense"});
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::usage);
        EXPECT_THAT(e.what(), testing::AllOf(HasSubstr("\"nonsense\""), HasSubstr("frame-phase")));
    }
}

} // namespace
} // namespace clvr::selftest

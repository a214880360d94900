// `clvr selftest` as a user sees it: lines, JSON, exit codes; devices that fail, drivers that end the program.
#include "runtime/opencl/source.hpp"
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Selftest : public Program {
protected:
    /// A kernel folder in which one file has a part replaced.
    Environment with_kernel(const std::string& file, const std::string& right, const std::string& wrong) const {
        std::string text = read_kernel_file(file).value();
        const std::size_t at = text.find(right);
        EXPECT_NE(at, std::string::npos);
        home.write("kernels/" + file, text.replace(at, right.size(), wrong));
        return {{"CLVR_KERNEL_DIR", (home.path() / "kernels").string()}};
    }
};

TEST_F(Selftest, PassesWithALineEach) {
    const Outcome outcome = run({"selftest", "--check", "layout,random"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("device 0: "), HasSubstr("every check passed")));
    EXPECT_THAT(outcome.out, testing::ContainsRegex("  layout  .* ok  .*\n  random  .* ok  .*\n"));
    EXPECT_EQ(outcome.err, "");
}

TEST_F(Selftest, WritesJson) {
    const Outcome outcome = run({"selftest", "--json", "--check", "layout"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const auto device = nlohmann::json::parse(outcome.out).at("devices").at(0);
    EXPECT_EQ(device.at("ok"), true);
    const auto& check = device.at("checks").at(0);
    EXPECT_EQ(check.at("name"), "layout");
    EXPECT_EQ(check.at("ok"), true);
    EXPECT_EQ(check.at("expected"), check.at("found"));
    EXPECT_GE(check.at("seconds"), 0);
}

TEST_F(Selftest, NamesTheCheckThatFails) {
    const auto faulty = with_kernel("lib/math.clh", "0.128791735f", "0.1287f");
    const Outcome outcome = run({"selftest", "--check", "functions,layout"}, faulty);
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_THAT(outcome.out,
                testing::ContainsRegex("  layout  .* ok  .*\n  functions  .* FAILED expected log [0-9a-f]*.*; found log [0-9a-f]* at"));
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("cannot be trusted, it fails: functions"), Not(HasSubstr("layout"))));
    const Outcome json = run({"selftest", "--check", "functions", "--json"}, faulty);
    EXPECT_EQ(json.exit_code, 4);
    EXPECT_EQ(nlohmann::json::parse(json.out).at("devices").at(0).at("ok"), false);
}

/// Everything else refuses such a device.
TEST_F(Selftest, TestsADeviceThatTheTrustProbeRefuses) {
    const auto faulty = with_kernel("shared/trust_operations.h", "a / b", "a * (1.0f / b)");
    EXPECT_EQ(run({"render", ball(), "--size", "8x8", "--spp", "1", "-o", (home.path() / "x.png").string()}, faulty).exit_code, 4);
    const Outcome outcome = run({"selftest", "--check", "trust,layout"}, faulty);
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_THAT(outcome.out, testing::ContainsRegex("  trust  .* FAILED expected ok; found fails divide \\(.*\n  layout  .* ok "));
    EXPECT_THAT(outcome.err, HasSubstr("it fails: trust"));
}

TEST_F(Selftest, SaysWhenTheDriverEndsTheProgram) {
    const auto crashing = with_kernel("selftest/struct_layout.cl", "uint n = 0;", "uint n = 0; *(volatile __global uint*)1 = 7u;");
    const Outcome outcome = run({"selftest", "--check", "layout"}, crashing);
    EXPECT_EQ(outcome.exit_code, 4) << outcome.out;
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("the driver ended the program"), HasSubstr("check \"layout\" on ")));
}

TEST_F(Selftest, RefusesUnknownChecksAndDevices) {
    const Outcome check = run({"selftest", "--check", "nonsense"});
    EXPECT_EQ(check.exit_code, 2);
    EXPECT_THAT(check.err, AllOf(HasSubstr("\"nonsense\""), HasSubstr("furnace")));
    EXPECT_EQ(run({"selftest", "--device", "77"}).exit_code, 4);
}

} // namespace
} // namespace clvr

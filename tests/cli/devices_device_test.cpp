// `clvr devices` and what every subcommand shares: exit codes, unusual machines, the caches.
#include "runtime/opencl/program_cache.hpp"
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST_F(Program, UsageErrorsAreOneLineAndExitCode2) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"nonsense"},
                                                      {"devices", "--nonsense"},
                                                      {"devices", "--device"},
                                                      {"--config", "/none.ini", "devices"},
                                                      {"--kernel-dir", "/none", "devices"},
                                                      {"devices", "--device", "cpu/1"}}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, 2) << outcome.err;
        EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
        EXPECT_THAT(outcome.err, testing::StartsWith("clvr: "));
    }
}

TEST_F(Program, HelpAndVersionAreNoErrors) {
    EXPECT_EQ(run({"--version"}).exit_code, 0);
    EXPECT_EQ(run({"--version"}).out, CLVR_VERSION "\n");
    EXPECT_EQ(run({"devices", "--help"}).exit_code, 0);
    EXPECT_THAT(run({"--help"}).out, HasSubstr("devices"));
    EXPECT_EQ(run({}).exit_code, 0);
    EXPECT_EQ(run({}).out, run({"--help"}).out);
}

TEST_F(Program, ConfigFilesAreReadAndUnknownKeysRefused) {
    home.write("good.ini", "[devices]\ndevice=\"no such device\"\n");
    home.write("bad.ini", "[devices]\nnonsense=1\n");
    home.write("top.ini", "nonsense=1\n");
    EXPECT_EQ(run({"devices", "--config", (home.path() / "good.ini").string()}).exit_code, 4);
    EXPECT_EQ(run({"devices", "--config", (home.path() / "bad.ini").string()}).exit_code, 2);
    EXPECT_EQ(run({"devices", "--config", (home.path() / "top.ini").string()}).exit_code, 2);
}

TEST_F(Program, DevicesAreListedWithTheRule) {
    const Outcome text = run({"devices"});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_THAT(text.out, AllOf(HasSubstr("  > "), HasSubstr("\nclvr uses device "), HasSubstr("  ok")));
    const Outcome chosen = run({"devices", "--json"}, {{"CLVR_DEVICE", "0"}});
    ASSERT_EQ(chosen.exit_code, 0) << chosen.err;
    const auto json = nlohmann::json::parse(chosen.out);
    EXPECT_EQ(json["selection"]["devices"][0]["index"], 0);
    EXPECT_THAT(json["selection"]["rule"].get<std::string>(), HasSubstr("CLVR_DEVICE=0"));
    EXPECT_EQ(json["platforms"][0]["devices"][0]["trust"], "ok");
    EXPECT_EQ(run({"devices", "--device", "77"}).exit_code, 4);
}

TEST_F(Program, RememberedDeviceThatIsGoneIsSaid) {
    home.write(".config/clvr/device.json", R"({"devices": [{"platform": "None", "name": "Lost GPU"}]})");
    EXPECT_THAT(run({"devices"}).out, HasSubstr("the remembered \"Lost GPU\" is gone"));
    home.write(".config/clvr/device.json", "{");
    const Outcome broken = run({"devices"});
    EXPECT_EQ(broken.exit_code, 0);
    EXPECT_EQ(line_count(broken.err), 1) << broken.err;
    EXPECT_THAT(broken.err, AllOf(HasSubstr("warning: "), HasSubstr("device.json: is not a list of devices")));
}

TEST_F(Program, NoPlatform) {
    std::filesystem::create_directory(home.path() / "none");
    const Outcome outcome = run({"devices"}, {{"OCL_ICD_VENDORS", (home.path() / "none").string()}});
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(line_count(outcome.err), 1);
    EXPECT_THAT(outcome.err, HasSubstr("pocl-opencl-icd"));
}

TEST_F(Program, LibraryThatIsNoDriver) {
    const Outcome outcome = run({"devices"}, {{"OCL_ICD_VENDORS", "/usr/lib/x86_64-linux-gnu/libz.so.1"}});
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 2) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(testing::StartsWith("clvr: warning: "), HasSubstr("libz.so.1 is no OpenCL driver")));
    EXPECT_THAT(run({"render", ball(), "-o", "x.png"}, {{"OCL_ICD_VENDORS", "/usr/lib/x86_64-linux-gnu/libz.so.1"}}).err,
                HasSubstr("no OpenCL platform on this machine (/usr/lib/x86_64-linux-gnu/libz.so.1 is no OpenCL driver)"));
}

/// The loader skips it in silence and shows the others.
TEST_F(Program, DriverThatCannotBeLoadedIsNamed) {
    home.write("drivers/gone.icd", "libnone-such.so.1\n");
    home.write("drivers/empty.icd", "\n");
    home.write("drivers/pocl.icd", "libpocl.so.2\n");
    const Outcome outcome = run({"devices", "--json"}, {{"OCL_ICD_VENDORS", (home.path() / "drivers").string()}});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["platforms"].size(), 1u);
    EXPECT_EQ(line_count(outcome.err), 2) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("empty.icd names no library"), HasSubstr("libnone-such.so.1, which "),
                                   HasSubstr("gone.icd names, cannot be loaded")));
}

TEST_F(Program, NonsenseInTheEnvironmentIsNamed) {
    EXPECT_EQ(run({"devices"}, {{"CLVR_DEVICE", "none such"}}).exit_code, 4);
    EXPECT_THAT(run({"devices"}, {{"CLVR_DEVICE", "none such"}}).err,
                AllOf(testing::StartsWith("clvr: CLVR_DEVICE: "), HasSubstr("there are 0 \"")));
    EXPECT_EQ(run({"devices"}, {{"CLVR_DEVICE", "0+"}}).exit_code, 2);
}

TEST_F(Program, KernelThatDoesNotBuildIsShownWithTheCompilersLog) {
    home.write("kernels/render/march.cl", "// one\nint wrong = undeclared_name;\n");
    const Outcome outcome = run({"render", ball(), "--size", "8x8", "--spp", "1", "--mode", "dvr", "-o", (home.path() / "x.png").string()},
                                {{"CLVR_KERNEL_DIR", (home.path() / "kernels").string()}});
    EXPECT_EQ(outcome.exit_code, 4) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("render/march.cl:2:"), HasSubstr("undeclared_name")));
    EXPECT_FALSE(std::filesystem::exists(home.path() / "x.png"));
}

/// Memory runs out in the middle: the volume is on the device already when the paths need memory.
TEST_F(Program, OutOfDeviceMemoryIsOneLineAndLeavesNoFile) {
    const Outcome outcome =
        run({"render", ball(), "--size", "512x512", "--spp", "1", "--memory", "600K", "-o", (home.path() / "x.png").string()});
    EXPECT_EQ(outcome.exit_code, 5) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(" wants "), HasSubstr("--memory")));
    EXPECT_FALSE(std::filesystem::exists(home.path() / "x.png"));
}

/// A cache whose every file is nonsense gives what an empty one gives.
TEST_F(Program, CorruptCachesAreMadeAnew) {
    ASSERT_EQ(run({"devices"}).exit_code, 0);
    std::size_t files_seen = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(home.path() / ".cache/clvr"))
        if (entry.is_regular_file()) std::ofstream(entry.path()) << "{\"nonsense\": ", ++files_seen;
    ASSERT_GE(files_seen, 1u);
    const Outcome outcome = run({"devices"});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("  ok"));
}

TEST_F(Program, PlatformWithoutDevices) {
    const std::string clover = "/etc/OpenCL/vendors/mesa.icd";
    if (!std::filesystem::exists(clover)) GTEST_SKIP() << "mesa-opencl-icd is not installed";
    const Outcome outcome = run({"devices"}, {{"OCL_ICD_VENDORS", clover}});
    EXPECT_EQ(outcome.exit_code, 4);
    EXPECT_THAT(outcome.out, HasSubstr("Clover: no devices"));
    EXPECT_EQ(line_count(outcome.err), 1);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("\"Clover\""), HasSubstr("pocl-opencl-icd")));
}

TEST_F(Program, UnwritableHomeAndCacheIsOneWarning) {
    const Outcome outcome = run({"devices", "--json"}, {{"HOME", "/dev/null"}, {"POCL_CACHE_DIR", std::nullopt}});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(line_count(outcome.err), 1) << outcome.err;
    EXPECT_THAT(outcome.err,
                AllOf(testing::StartsWith("clvr: warning: "), HasSubstr("/dev/null/.cache/clvr"), HasSubstr("XDG_CACHE_HOME")));
    const auto usual = nlohmann::json::parse(run({"devices", "--json"}).out), here = nlohmann::json::parse(outcome.out);
    ASSERT_EQ(here["platforms"].size(), usual["platforms"].size());
    for (std::size_t i = 0; i < usual["platforms"].size(); ++i)
        EXPECT_EQ(here["platforms"][i]["devices"].size(), usual["platforms"][i]["devices"].size());
    EXPECT_EQ(run({"devices", "--quiet"}, {{"HOME", std::nullopt}, {"POCL_CACHE_DIR", std::nullopt}}).err, "");
}

/// With Oclgrind as the only driver: a simulator, and one that keeps no programs of its own.
class Simulator : public Program {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(oclgrind)) GTEST_SKIP() << "oclgrind is not installed";
    }
    Environment environment(const Environment& more = {}) const {
        Environment all{{"OCL_ICD_VENDORS", oclgrind}};
        all.insert(more.begin(), more.end());
        return all;
    }
};

TEST_F(Simulator, IsUsedOnlyWhenNamed) {
    for (const char* selector : {"", "cpu", "gpu"}) {
        const Outcome refused = run({"devices", "--device", selector}, environment());
        EXPECT_EQ(refused.exit_code, 4) << selector;
        EXPECT_THAT(refused.out, HasSubstr("not probed (simulator)"));
    }
    const Outcome named = run({"devices", "--device", "oclgrind"}, environment());
    EXPECT_EQ(named.exit_code, 0) << named.err;
    EXPECT_THAT(named.out, HasSubstr("ok (simulator)"));
}

TEST_F(Simulator, ProgramsAreCachedAndBrokenEntriesRebuilt) {
    const std::vector<std::string> arguments{"devices", "--device", "0", "--verbose"};
    const auto probe_again = [&] {
        std::filesystem::remove_all(home.path() / ".cache/clvr/trust");
        const Outcome outcome = run(arguments, environment());
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_THAT(outcome.out, HasSubstr("ok (simulator)"));
        EXPECT_THAT(outcome.err, Not(HasSubstr("warning")));
        return outcome.err;
    };
    EXPECT_THAT(probe_again(), AllOf(HasSubstr("was built from source"), Not(HasSubstr("came from the cache"))));
    const auto entries = files(".cache/clvr/programs");
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_THAT(probe_again(), AllOf(Not(HasSubstr("was built from source")), HasSubstr("came from the cache")));

    std::filesystem::resize_file(entries[0], std::filesystem::file_size(entries[0]) - 1);
    std::filesystem::copy_file(entries[0], entries[1], std::filesystem::copy_options::overwrite_existing);
    EXPECT_THAT(probe_again(), AllOf(HasSubstr("is broken and will be built anew"), HasSubstr("was built from source"),
                                     Not(HasSubstr("came from the cache"))));
    EXPECT_THAT(probe_again(), HasSubstr("came from the cache"));
}

TEST_F(Simulator, BinaryThatTheDriverRejectsIsRebuilt) {
    const std::vector<std::string> arguments{"devices", "--device", "0", "--verbose"};
    ASSERT_EQ(run(arguments, environment()).exit_code, 0);
    // An entry whose sums are right but whose content is no program.
    for (const auto& entry : files(".cache/clvr/programs"))
        std::ofstream(entry) << encode_entry(entry.filename().string(), "no program at all");
    std::filesystem::remove_all(home.path() / ".cache/clvr/trust");
    const Outcome outcome = run(arguments, environment());
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("rejected a cached program"), HasSubstr("was built from source")));
}

TEST_F(Simulator, TwoProcessesFillTheCacheAtOnce) {
    std::vector<Child> children;
    for (int i = 0; i < 3; ++i) children.push_back(start({"devices", "--device", "0"}, environment()));
    for (Child& child : children) EXPECT_EQ(child.wait().exit_code, 0);
    EXPECT_EQ(files(".cache/clvr/programs").size(), 2u);
    EXPECT_EQ(files(".cache/clvr/trust").size(), 1u);
}

TEST_F(Simulator, BuildLogsShowFileAndLineThoughLineDirectivesAreIgnored) {
    home.write("kernels/shared/trust_operations.h", "// one\n// two\nint wrong = undeclared_name;\n");
    const Outcome outcome = run({"devices", "--device", "0", "--kernel-dir", (home.path() / "kernels").string()}, environment());
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("cannot be probed"), HasSubstr("shared/trust_operations.h:3:"), HasSubstr("undeclared_name")));
}

} // namespace
} // namespace clvr

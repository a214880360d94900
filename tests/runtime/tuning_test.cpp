// Tuning files: what is read and refused, what wins over what.
#include "runtime/tuning.hpp"

#include "runtime/embedded.hpp"
#include "runtime/error.hpp"
#include "tests/runtime/scoped.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace clvr {
namespace {

using testing::HasSubstr;

DeviceFacts pocl(unsigned width = 16, const std::string& driver = "3.1") {
    DeviceFacts d;
    d.platform = "Portable Computing Language";
    d.name = "pthread-test";
    d.driver_version = driver;
    d.native_float_width = width;
    return d;
}

/// A configuration folder of its own, and no CLVR_TUNE.
class TuningFiles : public testing::Test {
protected:
    TemporaryFolder folder;
    ScopedVariable config{"XDG_CONFIG_HOME", folder.path().string()};
    ScopedVariable environment{"CLVR_TUNE", std::nullopt};

    void write(const DeviceFacts& d, const std::string& text) const {
        folder.write(tuning_path(d).value().lexically_relative(folder.path()).string(), text);
    }
};

TEST_F(TuningFiles, SavedAndFoundAgainForThisDriverOnly) {
    EXPECT_FALSE(measured_tuning(pocl()));
    save_tuning(pocl(), {{{"packet", 8}, {"zero", 0}}, {"packet 8: 1.2 x as fast"}});
    const auto found = measured_tuning(pocl());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->values, (Tunables{{"packet", 8}, {"zero", 0}}));
    EXPECT_THAT(found->evidence, testing::ElementsAre("packet 8: 1.2 x as fast"));
    EXPECT_FALSE(measured_tuning(pocl(16, "3.2"))) << "another driver";
    save_tuning(pocl(), {{{"packet", 4}}, {}});
    EXPECT_EQ(measured_tuning(pocl())->values.at("packet"), 4) << "replaced";
}

TEST_F(TuningFiles, BrokenFilesAreLeftOutAndRefused) {
    const std::string good = R"({"format": "clvr tuning 1", "tunables": {"a": 1}})";
    EXPECT_EQ(parse_tuning(good, "x").values.at("a"), 1);
    for (const std::string& text : std::vector<std::string>{
             "", "{", "[]", "null", "\x80\xff", "{\"format\": \"clvr tuning 2\", \"tunables\": {}}", "{\"tunables\": {\"a\": 1}}",
             "{\"format\": \"clvr tuning 1\"}", "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a\": 1.5}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a\": \"1\"}}", "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a\": -1}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a\": 4000000000}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a b\": 1}}", "{\"format\": \"clvr tuning 1\", \"tunables\": 3}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a\": 1}, \"evidence\": [1]}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a\": " + std::string(100000, '[') + std::string(100000, ']') + "}}"}) {
        try {
            parse_tuning(text, "file.json");
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input) << text;
            EXPECT_EQ(error.where(), "file.json");
        }
        write(pocl(), text);
        testing::internal::CaptureStdout();
        EXPECT_FALSE(measured_tuning(pocl())) << text;
        EXPECT_EQ(tuning_in_force(pocl(1)).values, Tunables()) << "a run goes on";
        testing::internal::GetCapturedStdout(); // the warning
    }
}

TEST_F(TuningFiles, UnreadableAndUnwritable) {
    std::filesystem::create_directories(tuning_path(pocl()).value()); // a folder where the file should be
    testing::internal::CaptureStdout();
    EXPECT_FALSE(measured_tuning(pocl()));
    EXPECT_THAT(testing::internal::GetCapturedStdout(), testing::AllOf(HasSubstr("cannot be read"), HasSubstr("tuning/")));
    EXPECT_THROW(save_tuning(pocl(), {}), Error);
    const ScopedVariable unwritable("XDG_CONFIG_HOME", "/dev/null");
    try {
        save_tuning(pocl(), {});
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_THAT(error.where(), HasSubstr("/dev/null"));
    }
}

TEST_F(TuningFiles, NoFolder) {
    const ScopedVariable config_home("XDG_CONFIG_HOME", std::nullopt), home("HOME", std::nullopt);
    EXPECT_FALSE(tuning_path(pocl()));
    EXPECT_FALSE(measured_tuning(pocl()));
    EXPECT_THROW(save_tuning(pocl(), {}), Error);
}

TEST_F(TuningFiles, EnvironmentBeforeFileBeforeShipped) {
    const auto shipped = shipped_tuning(pocl());
    ASSERT_TRUE(shipped);
    EXPECT_THAT(tuning_in_force(pocl()).rule, HasSubstr("shipped for " + shipped->name));
    Tunables values = shipped->tuning.values;
    for (auto& [name, value] : values) value += 1000;
    values["only_measured"] = 1, values["both"] = 2;
    save_tuning(pocl(), {values, {}});
    for (const auto& [name, value] : values) EXPECT_EQ(tuning_in_force(pocl()).values.at(name), value) << name;
    const ScopedVariable tune("CLVR_TUNE", "both=3,only_here=-4");
    const TuningInForce all = tuning_in_force(pocl());
    EXPECT_EQ(all.values.at("both"), 3);
    EXPECT_EQ(all.values.at("only_here"), -4);
    EXPECT_EQ(all.values.at("only_measured"), 1);
    EXPECT_THAT(all.rule, testing::AllOf(HasSubstr("CLVR_TUNE"), HasSubstr("measured here"), HasSubstr("shipped")));
}

TEST_F(TuningFiles, NothingKnown) {
    DeviceFacts other = pocl();
    other.platform = "Other";
    EXPECT_EQ(tuning_in_force(other).values, Tunables());
    EXPECT_THAT(tuning_in_force(other).rule, HasSubstr("built in"));
}

TEST(Shipped, EachFileIsUnderstoodAndFitsOneKindOfDevice) {
    ASSERT_GE(embedded_tuning().size(), 3u);
    DeviceFacts nvidia = pocl(1);
    nvidia.platform = "NVIDIA CUDA", nvidia.type = DeviceType::gpu;
    const std::vector<DeviceFacts> kinds{pocl(1), pocl(4), pocl(8), pocl(16), nvidia};
    for (const auto& [name, text] : embedded_tuning()) {
        const ShippedTuning s = parse_shipped_tuning(text, name);
        EXPECT_FALSE(s.name.empty() || s.platform.empty()) << name;
        EXPECT_EQ(std::count_if(kinds.begin(), kinds.end(), [&](const DeviceFacts& d) { return s.fits(d); }), 1) << name;
    }
    EXPECT_TRUE(shipped_tuning(pocl(16)) && shipped_tuning(pocl(8)) && shipped_tuning(nvidia));
    EXPECT_FALSE(shipped_tuning(pocl(4)));
    DeviceFacts gpu = pocl(16);
    gpu.type = DeviceType::gpu;
    EXPECT_FALSE(shipped_tuning(gpu));
    for (const char* text : {"{}", "{\"name\": \"x\", \"match\": {}, \"tunables\": {}}", "[]",
                             R"({"name": "x", "match": {"platform": "p", "type": "cpu", "native_float_width": 1e300}, "tunables": {}})"})
        EXPECT_THROW(parse_shipped_tuning(text, "x"), Error) << text;
}

TEST(TuneVariable, Malformed) {
    EXPECT_EQ(parse_tunables("a=1,b=-2", "x"), (Tunables{{"a", 1}, {"b", -2}}));
    for (const char* text : {"a", "=1", "a=", "a=1x", "a=1,,b=2", "a=4294967297"})
        EXPECT_THROW(parse_tunables(text, "CLVR_TUNE"), Error) << text;
}

} // namespace
} // namespace clvr

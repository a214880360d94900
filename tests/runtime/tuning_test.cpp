// Tuning files: what is read and refused, what wins over what.
#include "runtime/tune/tuning.hpp"

#include "runtime/error.hpp"
#include "runtime/system/embedded.hpp"
#include "tests/runtime/scoped.hpp"
#include "tests/runtime/warnings.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <regex>
#include <set>
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
    save_tuning(pocl(), {{{"packet", 8}, {"splat_bins", 7}}, {"packet 8: 1.2 x as fast"}});
    const auto found = measured_tuning(pocl());
    ASSERT_TRUE(found);
    EXPECT_EQ(found->values, (Tunables{{"packet", 8}, {"splat_bins", 7}}));
    EXPECT_THAT(found->evidence, testing::ElementsAre("packet 8: 1.2 x as fast"));
    EXPECT_FALSE(measured_tuning(pocl(16, "3.2"))) << "another driver";
    save_tuning(pocl(), {{{"packet", 4}}, {}});
    EXPECT_EQ(measured_tuning(pocl())->values.at("packet"), 4) << "replaced";
}

TEST_F(TuningFiles, BrokenFilesAreLeftOutAndRefused) {
    const std::string good = R"({"format": "clvr tuning 1", "tunables": {"packet": 1}})";
    EXPECT_EQ(parse_tuning(good, "x").values.at("packet"), 1);
    for (const std::string& text : std::vector<std::string>{
             "", "{", "[]", "null", "\x80\xff", "{\"format\": \"clvr tuning 2\", \"tunables\": {}}", "{\"tunables\": {\"packet\": 1}}",
             "{\"format\": \"clvr tuning 1\"}", "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": 1.5}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": \"1\"}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": -1}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": 4000000000}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"a b\": 1}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": 2}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": 18446744073709551615}}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": 3}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": 1}, \"evidence\": [1]}",
             "{\"format\": \"clvr tuning 1\", \"tunables\": {\"packet\": " + std::string(100000, '[') + std::string(100000, ']') + "}}"}) {
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
    save_tuning(pocl(), {{{"packet", 4}, {"packet_run", 2}}, {}});
    EXPECT_EQ(tuning_in_force(pocl()).values.at("packet"), 4);
    const ScopedVariable tune("CLVR_TUNE", "packet=1,tile_pixels=100");
    const TuningInForce all = tuning_in_force(pocl());
    EXPECT_EQ(all.values.at("packet"), 1);
    EXPECT_EQ(all.values.at("tile_pixels"), 100);
    EXPECT_EQ(all.values.at("packet_run"), 2);
    EXPECT_THAT(all.rule, testing::AllOf(HasSubstr("CLVR_TUNE"), HasSubstr("measured here"), HasSubstr("shipped")));
}

TEST_F(TuningFiles, AnUndeclaredNameOrValueIsIgnoredWithAWarningOnce) {
    const Warnings warnings;
    for (const char* tunables : {R"({"packat": 8})", R"({"packet_run": 2, "conv_vectors": 0})"})
        for (int again = 0; again < 2; ++again) {
            write(pocl(), fmt::format(R"({{"format": "clvr tuning 1", "tunables": {}}})", tunables));
            EXPECT_FALSE(measured_tuning(pocl()));
        }
    EXPECT_THAT(warnings.text(), testing::AllOf(HasSubstr("there is no tunable \"packat\" (did you mean packet?)"),
                                                HasSubstr("\"conv_vectors\" is 0, but must be a whole number from 1 to 6")));
    EXPECT_EQ(warnings.lines(), 2);
}

TEST_F(TuningFiles, NothingKnown) {
    DeviceFacts other = pocl();
    other.platform = "Other";
    EXPECT_EQ(tuning_in_force(other).values, Tunables());
    EXPECT_THAT(tuning_in_force(other).rule, HasSubstr("built in"));
}

TEST(Declared, AreSound) {
    std::set<std::string> names;
    for (const DeviceType type : {DeviceType::cpu, DeviceType::gpu})
        for (const bool simulator : {false, true})
            for (const unsigned width : {1u, 8u, 16u}) {
                DeviceFacts d = pocl(width);
                d.type = type, d.simulator = simulator;
                for (const Tunable* t : declared_tunables()) {
                    EXPECT_TRUE(t->allowed.hold(value_of(*t, d, {}))) << t->name << "'s default";
                    EXPECT_TRUE(t->allowed.hold(value_of(*t, d, {{"packet", 1}, {"conv_width", 1}}))) << t->name;
                    for (const int value : t->tried(d)) EXPECT_TRUE(t->allowed.hold(value)) << t->name << ' ' << value;
                    for (const int value : t->allowed.samples()) EXPECT_TRUE(t->allowed.hold(value)) << t->name << ' ' << value;
                    names.insert(t->name);
                }
            }
    EXPECT_EQ(names.size(), declared_tunables().size()) << "two of one name";
}

/// Each that a header of host/ declares is in the list of host/tunables.cpp.
TEST(Declared, NoneIsForgotten) {
    std::set<std::string> listed, declared;
    for (const Tunable* t : declared_tunables()) listed.insert(t->name);
    const std::regex declaration("constexpr Tunable ([a-z_0-9]+)\\{\\s*\"([a-z_0-9]+)\"");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(CLVR_TEST_DATA) / "../host")) {
        if (entry.path().filename() != "tunables.hpp") continue;
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        for (std::sregex_iterator at(text.begin(), text.end(), declaration), none; at != none; ++at) {
            EXPECT_EQ((*at)[1], (*at)[2]);
            declared.insert((*at)[2]);
        }
    }
    EXPECT_EQ(listed, declared);
}

TEST(Declared, SayWhatIsAllowed) {
    EXPECT_EQ(why_refused("packet", 8), "");
    EXPECT_EQ(why_refused("packet", 2), "\"packet\" is 2, but must be 1, 4, 8 or 16");
    EXPECT_EQ(why_refused("packet_group", 100000), "\"packet_group\" is 100000, but must be a power of two from 1 to 256");
    EXPECT_EQ(why_refused("splat_bins", 0), "\"splat_bins\" is 0, but must be a whole number from 1 to 256");
    EXPECT_THAT(why_refused("pakcet", 8),
                testing::AllOf(HasSubstr("did you mean packet?"), HasSubstr("there are band_pixels, brick_log2, ")));
    EXPECT_THAT(why_refused("", 8), HasSubstr("there is no tunable \"\"; there are"));
}

TEST(Declared, TextsAreReadAndRefused) {
    EXPECT_EQ(parse_tunables("packet=8,conv_width=1,packet=4", "x"), (Tunables{{"packet", 4}, {"conv_width", 1}}));
    EXPECT_EQ(parse_tunables("", "x"), Tunables());
    for (const std::string& text :
         {std::string("packet"), std::string("packet="), std::string("packet=x"), std::string("packet=8x"), std::string("=3"),
          std::string("packet=8,,"), std::string("packet=2"), std::string("packet=99999999999999999999"), std::string("packet=4294967304"),
          std::string("packet=8\0", 9), std::string("Packet=8"), std::string(" ")}) {
        try {
            parse_tunables(text, "CLVR_TUNE");
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage) << text;
            EXPECT_EQ(error.where(), "CLVR_TUNE");
        }
    }
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

} // namespace
} // namespace clvr

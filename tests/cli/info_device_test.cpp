// `clvr info` as a user sees it.
#include "tests/cli/program.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace clvr {
namespace {

class Info : public ::testing::Test {
protected:
    Info() : folder(std::filesystem::temp_directory_path() / ("clvr_info_" + std::to_string(getpid()))) {
        std::filesystem::create_directories(folder);
        std::string voxels;
        for (int i = 0; i < 32 * 24 * 20; ++i) voxels += static_cast<char>(i * 7 % 200 + 10);
        std::ofstream(raw(), std::ios::binary) << voxels;
        std::ofstream(folder / "head_32x24x20_uint8.json")
            << R"({"spacing": [0.5, 1, 2], "slope": 2, "intercept": -1000, "modality": "CT", "origin": [1, 2, 3],
            "direction": [0, -0.8, 0.6, 1, 0, 0, 0, 0.6, 0.8]})";
    }
    ~Info() override { std::filesystem::remove_all(folder); }
    std::string raw() const { return (folder / "head_32x24x20_uint8.raw").string(); }
    Outcome run(std::vector<std::string> arguments, const Environment& environment = {}) {
        arguments.insert(arguments.begin(), "info");
        return Child(arguments, environment, folder).wait();
    }
    std::filesystem::path folder;
};

TEST_F(Info, TextShowsGeometryRangeHistogramAndPlan) {
    const Outcome o = run({raw()});
    EXPECT_EQ(o.exit_code, 0) << o.err;
    for (const char* part :
         {"RAW, CT", "32 x 24 x 20 u8", "0.5 x 1 x 2 mm", "16 x 24 x 40 mm", "i A->P, j L->R, k I->S", "oblique by 36.9 degrees",
          "1, 2, 3 mm (LPS)", "-980 to -582 = 2 x stored - 1000, stored 10 to 209", "in the tallest bar", "█", "voxels an edge", "fits:"})
        EXPECT_NE(o.out.find(part), std::string::npos) << part << "\nis not in\n" << o.out;
}

TEST_F(Info, JsonHoldsTheSame) {
    const Outcome o = run({raw(), "--json"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const auto j = nlohmann::json::parse(o.out);
    EXPECT_EQ(j["dims"], (std::vector<int>{32, 24, 20}));
    EXPECT_EQ(j["type"], "u8");
    EXPECT_EQ(j["slope"], 2);
    EXPECT_EQ(j["intercept"], -1000);
    EXPECT_EQ(j["spacing_mm"], (std::vector<double>{0.5, 1, 2}));
    EXPECT_EQ(j["direction"][0][2], 0.6);
    EXPECT_EQ(j["axes"], (std::vector<std::string>{"A->P", "L->R", "I->S"}));
    EXPECT_EQ(j["range"], (std::vector<double>{-980, -582}));
    EXPECT_EQ(j["histogram"].size(), 1024u);
    EXPECT_LT(std::count(o.out.begin(), o.out.end(), '\n'), 60); // numbers of an array share a line
    EXPECT_EQ(j["sha256"].get<std::string>().size(), 64u);
    ASSERT_EQ(j["memory_plan"].size(), 1u);
    EXPECT_TRUE(j["memory_plan"][0]["fits"]);
    EXPECT_GE(j["memory_plan"][0]["bricks"]["stored_bytes"], 32 * 24 * 20);
}

TEST_F(Info, ReadingOptionsReachTheReader) {
    const Outcome o = run({raw(), "--json", "--dims", "24x32x20", "--type", "int8", "--spacing", "3", "--endian", "big"});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    const auto j = nlohmann::json::parse(o.out);
    EXPECT_EQ(j["dims"], (std::vector<int>{24, 32, 20}));
    EXPECT_EQ(j["type"], "i8");
    EXPECT_EQ(j["spacing_mm"], (std::vector<double>{3, 3, 3}));
}

TEST_F(Info, SmallLimitsAreNoFit) {
    const Outcome o = run({raw(), "--json"}, {{"CLVR_MAX_MEMORY", "8K"}});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_FALSE(nlohmann::json::parse(o.out)["memory_plan"][0]["fits"]);
}

TEST_F(Info, WithoutADeviceTheFileIsStillDescribed) {
    const Environment none{{"OCL_ICD_VENDORS", (folder / "none").string()}, {"CLVR_DEVICE", std::nullopt}};
    const Outcome o = run({raw()}, none);
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_NE(o.out.find("device      none"), std::string::npos) << o.out;
    EXPECT_EQ(run({raw(), "--device", "gpu"}, none).exit_code, 4);
}

TEST_F(Info, WrongUseAndWrongFilesHaveTheirExitCodes) {
    EXPECT_EQ(run({}).exit_code, 2);
    for (const char* dims : {"1x2", "0x1x1", "axbxc", "1x2x3x4", "99999999999x1x1"}) {
        const Outcome o = run({raw(), "--dims", dims});
        EXPECT_EQ(o.exit_code, 2) << dims;
        EXPECT_NE(o.err.find("--dims"), std::string::npos) << o.err;
    }
    EXPECT_EQ(run({raw(), "--spacing", "1x0x1"}).exit_code, 2);
    EXPECT_EQ(run({raw(), "--frame", "x"}).exit_code, 2);
    const Outcome gone = run({(folder / "gone.nii").string()});
    EXPECT_EQ(gone.exit_code, 3);
    EXPECT_NE(gone.err.find("gone.nii"), std::string::npos);
    const Outcome wrong = run({raw(), "--dims", "32x24x21"});
    EXPECT_EQ(wrong.exit_code, 3);
    EXPECT_NE(wrong.err.find("expected 16128 bytes"), std::string::npos) << wrong.err;
    EXPECT_NE(wrong.err.find("found 15360"), std::string::npos) << wrong.err;
}

} // namespace
} // namespace clvr

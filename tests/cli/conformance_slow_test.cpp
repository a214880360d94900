// The same bits from other compilers and interpreters: PoCL's two ways to make work-groups, contraction left on, Oclgrind, Mesa's rusticl.
#include "tests/cli/conformance.hpp"
#include "tests/contracting_kernels.hpp"

namespace clvr {
namespace {

using OtherCompilers = Conformance;

TEST_F(OtherCompilers, PoclLoopsOverWorkItems) {
    for (const char* method : {"loops", "loopvec"})
        expect_golden({{"POCL_WORK_GROUP_METHOD", method}, {"CLVR_TUNE", narrow}}, {"--device", "portable"});
}

TEST_F(OtherCompilers, PoclContracts) {
    int allowed = 0;
    for (const auto& [path, text] : contracting_kernels(allowed)) home.write("kernels/" + path, text);
    ASSERT_GT(allowed, 1);
    expect_golden({{"CLVR_KERNEL_DIR", (home.path() / "kernels").string()}}, {"--device", "portable"});
}

/// As a driver beside PoCL in one process.
TEST_F(OtherCompilers, OclgrindInterprets) {
    if (!installed(oclgrind)) GTEST_SKIP() << "oclgrind is not installed";
    home.write("drivers/oclgrind.icd", std::string(oclgrind) + "\n");
    home.write("drivers/pocl.icd", "libpocl.so.2\n");
    const auto report = tested({{"OCL_ICD_VENDORS", (home.path() / "drivers").string()}, {"CLVR_TUNE", narrow}},
                               {"--device", "oclgrind+portable", "--check", "picture,training"});
    ASSERT_EQ(report.at("devices").size(), 2u);
    for (const auto& device : report.at("devices")) {
        EXPECT_EQ(device.at("checks").at(0).at("found"), selftest::golden_picture_hash) << device.at("platform");
        EXPECT_EQ(device.at("checks").at(1).at("found"), selftest::golden_training_hash) << device.at("platform");
    }
}

class Races : public Conformance {
protected:
    void SetUp() override {
        if (!installed(oclgrind)) GTEST_SKIP() << "oclgrind is not installed";
    }
    Environment environment() const {
        return {{"OCL_ICD_VENDORS", oclgrind},
                {"OCLGRIND_DATA_RACES", "1"},
                {"OCLGRIND_LOG", (home.path() / "races").string()},
                {"CLVR_TUNE", narrow}};
    }
    std::string log() const {
        std::ifstream file(home.path() / "races");
        EXPECT_TRUE(file.is_open());
        return {std::istreambuf_iterator<char>(file), {}};
    }
};

TEST_F(Races, ThereAreNone) {
    expect_golden(environment(), {"--device", "oclgrind"});
    EXPECT_EQ(log(), "");
}

TEST_F(Races, WouldBeFound) {
    Environment racing = environment();
    racing["CLVR_KERNEL_DIR"] = (home.path() / "kernels").string();
    home.write(
        "kernels/selftest/random_blocks.cl",
        "__kernel void random_blocks(__global uint* x, __global uint* y, __global uint* z, __global uint* w, uint key0, uint key1, "
        "__global uint* ox,\n"
        "                            __global uint* oy, __global uint* oz, __global uint* ow, __global float* number, uint packets) {\n"
        "    ox[0] = (uint)get_global_id(0);\n}\n");
    run({"selftest", "--device", "oclgrind", "--check", "random"}, racing);
    EXPECT_THAT(log(), testing::HasSubstr("race"));
}

TEST_F(OtherCompilers, RusticlComputes) {
    const std::string rusticl = "/etc/OpenCL/vendors/rusticl.icd";
    if (!installed(rusticl)) GTEST_SKIP() << "mesa-opencl-icd is not installed";
    const Environment environment{{"OCL_ICD_VENDORS", rusticl}, {"RUSTICL_ENABLE", "llvmpipe"}, {"CLVR_TUNE", narrow}};
    expect_golden(environment);
    // A clip box, surfaces and paths that end in the border's half voxel, which the small picture lacks.
    const auto report = tested(environment, {"--check", "trust,layout,random,frame-gradient"});
    ASSERT_TRUE(report.is_object());
    for (const auto& check : report.at("devices").at(0).at("checks")) EXPECT_EQ(check.at("ok"), true) << check.dump(2);
}

} // namespace
} // namespace clvr

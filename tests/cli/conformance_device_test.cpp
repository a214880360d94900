// The same bits under PoCL's settings that change how kernels are compiled or run, where little is compiled anew.
#include "tests/cli/conformance.hpp"

namespace clvr {
namespace {

class Pocl : public Conformance {
protected:
    void SetUp() override {
        if (run({"devices", "--device", "portable"}).exit_code != 0) GTEST_SKIP() << "PoCL is not installed";
    }
    const std::vector<std::string> pocl{"--device", "portable"};
};

TEST_F(Pocl, AnyNumberOfThreads) {
    for (const char* threads : {"1", "3"}) expect_golden({{"POCL_MAX_PTHREAD_COUNT", threads}}, pocl);
}

TEST_F(Pocl, SubDevices) {
    const auto report = tested({}, {"--check", "picture", "--device", "portable/2"});
    ASSERT_EQ(report.at("devices").size(), 2u);
    for (const auto& device : report.at("devices")) EXPECT_EQ(device.at("checks").at(0).at("found"), selftest::golden_picture_hash);
}

TEST_F(Pocl, DenormalsOff) {
    const auto device = expect_golden({{"POCL_EXTRA_BUILD_FLAGS", "-cl-denorms-are-zero"}}, pocl);
    EXPECT_THAT(device.at("checks").at(0).at("found").get<std::string>(), testing::HasSubstr("flushed")) << "the setting had no effect";
}

} // namespace
} // namespace clvr

// The program `clvr-bench` as a user runs it, at the sizes of simulators.
#include "tests/cli/program.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clvr {
namespace {

using testing::HasSubstr;

class Bench : public testing::Test {
protected:
    TemporaryFolder home;

    Outcome run(std::vector<std::string> arguments, Environment environment = {}) const {
        const Environment usual{{"XDG_CONFIG_HOME", home.path().string()}, {"CLVR_DEVICE", std::nullopt}, {"CLVR_TUNE", std::nullopt}};
        environment.insert(usual.begin(), usual.end());
        return Child(arguments, environment, home.path()).wait();
    }
    std::string file(const std::string& name) const { return (home.path() / name).string(); }
};

TEST_F(Bench, WrongUseIsOneLine) {
    const std::pair<std::vector<std::string>, int> cases[] = {{{"--nonsense"}, 2},
                                                              {{"extra"}, 2},
                                                              {{"--device"}, 2},
                                                              {{"--device", "cpu/1"}, 2},
                                                              {{"--device", "nothing like this"}, 4},
                                                              {{"--stage", "nonsense"}, 2},
                                                              {{"--stage", "copy", "--save"}, 2},
                                                              {{"--tiny", "--save"}, 2},
                                                              {{"--json", "/no/such/folder/x.json"}, 3},
                                                              {{"--html", "/proc/x.html"}, 3}};
    for (const auto& [arguments, code] : cases) {
        const Outcome o = run(arguments);
        EXPECT_EQ(o.exit_code, code) << arguments[0] << ": " << o.err;
        EXPECT_THAT(o.err, testing::StartsWith("clvr-bench: "));
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
    EXPECT_EQ(run({"--help"}).exit_code, 0);
}

TEST_F(Bench, NoPlatform) {
    std::filesystem::create_directory(home.path() / "none");
    const Outcome o = run({}, {{"OCL_ICD_VENDORS", file("none")}});
    EXPECT_EQ(o.exit_code, 4);
    EXPECT_THAT(o.err, HasSubstr("no OpenCL platform"));
}

TEST_F(Bench, MeasuresAndWrites) {
    const Outcome o = run({"--tiny", "--quick", "--device", "cpu", "--stage", "copy", "--stage", "FMA rate", "--stage", "GuideNet",
                           "--json", file("x.json"), "--html", file("x.html")});
    ASSERT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.out, testing::AllOf(HasSubstr("GuideNet"), HasSubstr(" ok"), HasSubstr("tuning: ")));
    std::ifstream json(file("x.json"));
    const auto j = nlohmann::json::parse(json);
    ASSERT_EQ(j.at("devices").at(0).at("rows").size(), 3u);
    for (const auto& row : j.at("devices").at(0).at("rows")) {
        EXPECT_EQ(row.at("status"), "ok") << row;
        EXPECT_EQ(row.at("size"), "tiny");
        EXPECT_GT(row.at("rate"), 0);
        EXPECT_GT(row.at("share_of_native"), 0) << row;
    }
    EXPECT_GT(std::filesystem::file_size(file("x.html")), 1000u);
}

TEST_F(Bench, MeasuresALiveView) {
    const Outcome o = run({"--live", "--device", "0", "--tiny"});
    EXPECT_EQ(o.exit_code, 0) << o.err;
    for (const char* what : {"moving", "transfer function", "settled", "frames/s", "march ", "display "})
        EXPECT_THAT(o.out, HasSubstr(what));
    EXPECT_EQ(run({"--live", "--device", "0", "--tiny", "--volume", file("none.mha")}).exit_code, 3);
}

TEST_F(Bench, MeasuresAViewByItsSocket) {
    const Outcome o = run({"--view", "--device", "0", "--tiny", "--seconds", "0.5"});
    EXPECT_EQ(o.exit_code, 0) << o.err;
    for (const char* what : {"pictures/s", "\n80x80 ", "full size", "transfer function", "interrupting", "soak", "memory "})
        EXPECT_THAT(o.out, HasSubstr(what));
    EXPECT_EQ(run({"--view", "--live"}).exit_code, 2);
}

TEST_F(Bench, AWrongResultIsSaid) { // the stage reads its kernel from a folder where a sign is turned
    std::filesystem::create_directories(home.path() / "kernels/probe");
    std::ofstream(home.path() / "kernels/probe/triad.cl") << "#include \"lib/stream.clh\"\n"
                                                             "kernel void triad(global const vfloat* a, global const vfloat* b, global "
                                                             "vfloat* to, float s, uint vectors) { uint i = get_global_id(0); "
                                                             "if (i < vectors) STREAM(fma((vfloat)(-s), b[i], a[i]), to + i); }";
    const Outcome o = run({"--tiny", "--device", "cpu", "--stage", "triad"}, {{"CLVR_KERNEL_DIR", file("kernels")}});
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.out, HasSubstr("wrong result: its bits differ"));
}

} // namespace
} // namespace clvr

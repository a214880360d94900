// Drivers that fail, as a user meets them: no linker, no room in the cache, none at all.
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class Drivers : public Program {
protected:
    /// Without the linker that PoCL calls, and without kernels that are linked already.
    Environment no_linker() const { return {{"PATH", "/nowhere"}, {"POCL_CACHE_DIR", (home.path() / "kernels").string()}}; }
    std::vector<std::string> render() const {
        return {"render", ball(), "-o", (home.path() / "ball.png").string(), "--size", "16x16", "--spp", "1"};
    }
};

TEST_F(Drivers, ThatCannotLinkAreNamed) {
    const Outcome o = run(render(), no_linker());
    EXPECT_EQ(o.exit_code, 4) << o.err;
    EXPECT_THAT(o.err, AllOf(HasSubstr("Portable Computing Language"), HasSubstr("no linker (ld) in PATH")));
    EXPECT_EQ(line_count(o.err), 1) << o.err;
    EXPECT_FALSE(std::filesystem::exists(home.path() / "ball.png"));

    const Outcome listed = run({"devices"}, no_linker());
    EXPECT_EQ(listed.exit_code, 4);
    EXPECT_THAT(listed.out, AllOf(HasSubstr("Portable Computing Language"), HasSubstr("no linker (ld) in PATH")));

    // With the linker back it works: no failure was kept.
    const Outcome again = run(render());
    EXPECT_EQ(again.exit_code, 0) << again.err;
    const Outcome gone = run(render(), no_linker());
    EXPECT_EQ(gone.exit_code, 4) << "that it worked is remembered for another PATH alone";
}

TEST_F(Drivers, AreNotNeededToSpeakOfAFile) {
    const Outcome o = run({"info", ball()}, no_linker());
    EXPECT_EQ(o.exit_code, 0) << o.err;
    EXPECT_THAT(o.out, AllOf(HasSubstr("16 x 16 x 16 u8"), HasSubstr("no linker")));
    const Outcome none = run({"info", ball(), "--json"}, {{"OCL_ICD_VENDORS", "/nowhere"}});
    EXPECT_EQ(none.exit_code, 0) << none.err;
    EXPECT_EQ(nlohmann::json::parse(none.out).at("type"), "u8");
}

TEST_F(Drivers, AreTriedOnceAndThenRemembered) {
    EXPECT_EQ(run(render()).exit_code, 0);
    EXPECT_EQ(files(".cache/clvr/drivers").size(), 1u);
    EXPECT_EQ(run(render()).exit_code, 0);
    EXPECT_EQ(files(".cache/clvr/drivers").size(), 1u);
}

TEST_F(Drivers, WithoutRoomForTheirKernelsSayWhere) {
    const Environment fresh{{"POCL_CACHE_DIR", (home.path() / "kernels").string()}};
    EXPECT_EQ(run({"devices"}).exit_code, 0); // the probes are stored
    const Outcome o = run(render(), fresh, [] {
        const rlimit limit{20000, 20000}; // as on a full disk
        setrlimit(RLIMIT_FSIZE, &limit);
    });
    EXPECT_EQ(o.exit_code, 3) << o.err;
    EXPECT_THAT(o.err, AllOf(HasSubstr((home.path() / "kernels").string()), HasSubstr("no room"), Not(HasSubstr("does not build"))));
}

} // namespace
} // namespace clvr

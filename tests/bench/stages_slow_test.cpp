// Every stage of clvr-bench gives its golden result here, at the sizes of simulators.
#include "tests/cli/program.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace clvr {
namespace {

TEST(BenchStages, AllAreRight) {
    const TemporaryFolder home;
    const std::string file = (home.path() / "x.json").string();
    const Outcome o =
        Child({"--tiny", "--quick", "--device", "cpu", "--json", file}, {{"XDG_CONFIG_HOME", home.path().string()}}, home.path()).wait();
    ASSERT_EQ(o.exit_code, 0) << o.err;
    std::ifstream json(file);
    const auto rows = nlohmann::json::parse(json).at("devices").at(0).at("rows");
    EXPECT_GE(rows.size(), 20u);
    for (const auto& row : rows) EXPECT_TRUE(row.at("status") == "ok" || row.at("status") == "unsupported") << row;
}

} // namespace
} // namespace clvr

// What CLVR_TUNE may hold: names and values that are not declared end in one line, whatever the command.
#include "runtime/tune/tunables.hpp"
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>

#include <random>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST_F(Program, RefusesAHundredRandomTunables) {
    std::mt19937 random(2026);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    const auto& all = declared_tunables();
    for (int n = 0; n < 100; ++n) {
        const Tunable& tunable = *all[below(all.size())];
        std::string name = tunable.name, value;
        if (n % 4 == 0) { // another name
            name[below(name.size())] = static_cast<char>('a' + below(26));
            while (why_refused(name, 4).rfind("there is no", 0) != 0) name += static_cast<char>('a' + below(26));
            value = "4";
        } else if (n % 4 == 1) { // no number
            const char* texts[] = {"", "x", "1.5", "0x10", "8 ", "1e3", "--4", "nan"};
            value = texts[below(8)];
        } else { // another number
            int number = 0;
            do number = n % 4 == 2 ? static_cast<int>(below(600)) - 300 : static_cast<int>(random());
            while (tunable.allowed.hold(number));
            value = std::to_string(number);
        }
        const std::string text = (n % 3 == 0 ? "conv_width=8," : "") + name + "=" + value;
        const Outcome outcome = run({"render", "demo:cloud", "-o", "x.png"}, {{"CLVR_TUNE", text}});
        EXPECT_EQ(outcome.exit_code, 2) << text << ": " << outcome.err;
        EXPECT_EQ(line_count(outcome.err), 1) << text << ": " << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("CLVR_TUNE: ")) << text;
        EXPECT_EQ(outcome.out, "");
    }
}

TEST_F(Program, SaysWhichTunablesThereAre) {
    for (const char* command : {"devices", "selftest"}) {
        const Outcome name = run({command}, {{"CLVR_TUNE", "pakcet=8"}});
        EXPECT_EQ(name.exit_code, 2);
        EXPECT_THAT(name.err, AllOf(HasSubstr("there is no tunable \"pakcet\" (did you mean packet?)"), HasSubstr("wave_paths")));
        const Outcome value = run({command}, {{"CLVR_TUNE", "conv_vectors=0"}});
        EXPECT_EQ(value.exit_code, 2);
        EXPECT_THAT(value.err, HasSubstr("CLVR_TUNE: \"conv_vectors\" is 0, but must be a whole number from 1 to 6"));
    }
}

/// Declared, but more than PoCL's kernels take or the picture has: clamped.
TEST_F(Program, TakesTheGreatestTunables) {
    const std::string most =
        "packet_group=256,shade_group=256,phantom_group=256,conv_group_x=128,conv_group_y=16,pixel_group=256,splat_bins=256,"
        "wave_paths=16777216,march_pixels=1048576,tile_pixels=1073741824,denoise_mib=1048576";
    const Outcome outcome = run({"selftest", "--check", "picture"}, {{"CLVR_TUNE", most}});
    EXPECT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
}

} // namespace
} // namespace clvr

// Standard output that cannot take what is printed: an exit code and one line, from every command that needs no device.
#include "host/io/picture/frame_file.hpp"
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

using testing::HasSubstr;

class Streams : public Program {
protected:
    const Environment no_driver{{"OCL_ICD_VENDORS", "/nowhere"}};

    std::vector<std::vector<std::string>> printing() const {
        return {{"--help"},
                {"--version"},
                {"render", "--help"},
                {"render", "--list-tf"},
                {"dataset", "list"},
                {"dataset", "list", "--json"},
                {"dataset", "info", "bonsai"},
                {"info", ball()},
                {"info", ball(), "--json"},
                {"compare", picture(), picture()},
                {"compare", picture(), picture(), "--json"}};
    }

    void expect_refused(const std::vector<std::string>& arguments, const std::function<void()>& prepare) const {
        const Outcome o = run(arguments, no_driver, prepare);
        EXPECT_EQ(o.exit_code, 3) << arguments[0] << " " << arguments.back() << ": " << o.err;
        EXPECT_THAT(o.err, HasSubstr("standard output cannot be written: ")) << arguments[0];
        EXPECT_EQ(line_count(o.err), 1) << o.err;
    }

private:
    std::string picture() const {
        Frame frame;
        frame.width = frame.height = 16;
        for (const char* c : {"R", "G", "B"}) frame.channel(c);
        const std::string path = (home.path() / "black.png").string();
        write_png(frame, {"none", 0}, path);
        return path;
    }
};

TEST_F(Streams, AreRightWhereNothingIsWrong) {
    for (const auto& arguments : printing()) {
        const Outcome o = run(arguments, no_driver);
        EXPECT_EQ(o.exit_code, 0) << arguments[0] << ": " << o.err;
        EXPECT_FALSE(o.out.empty()) << arguments[0];
        EXPECT_EQ(o.err, "") << arguments[0];
    }
}

TEST_F(Streams, AFullDiskIsSaid) {
    for (const auto& arguments : printing()) expect_refused(arguments, [] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); });
}

TEST_F(Streams, AClosedOutputIsSaid) {
    for (const auto& arguments : printing()) expect_refused(arguments, [] { close(STDOUT_FILENO); });
}

TEST_F(Streams, AClosedPipeIsSaid) {
    for (const auto& arguments : printing())
        expect_refused(arguments, [] {
            int ends[2];
            if (pipe(ends) != 0) _exit(98);
            dup2(ends[1], STDOUT_FILENO);
            close(ends[0]), close(ends[1]);
        });
}

TEST_F(Streams, AFullErrorStreamLosesNoResult) {
    const Outcome o = run({"info", ball()}, no_driver, [] { dup2(open("/dev/full", O_WRONLY), STDERR_FILENO); });
    EXPECT_EQ(o.exit_code, 0);
    EXPECT_THAT(o.out, HasSubstr("16 x 16 x 16"));
}

TEST_F(Streams, WhatPrintsNothingNeedsNoOutput) {
    const Outcome o = run({"render", "nowhere.nii", "-o", "x.png"}, no_driver, [] { close(STDOUT_FILENO); });
    EXPECT_EQ(o.exit_code, 4); // there is no driver
    EXPECT_EQ(line_count(o.err), 1) << o.err;
}

} // namespace
} // namespace clvr

// Completions and manual pages, generated from CLI11's description.
#include "host/cli/described/completion.hpp"
#include "host/cli/described/man_page.hpp"
#include "host/cli/program.hpp"
#include "runtime/error.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

namespace clvr {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

/// Bash with the completion of `clvr`, in a folder with a file and a folder inside.
class BashCompletion : public testing::Test {
protected:
    BashCompletion() {
        CLI::App app;
        add_program(app);
        folder.write("complete.bash", completion("bash", app, placeholders()));
        folder.write("scan.nii", "x");
        folder.write("two words.nii", "x");
        std::filesystem::create_directory(folder.path() / "series");
    }
    /// What bash offers after these words, the last one being typed.
    Words offers(const Words& words) const {
        std::string array;
        for (const auto& word : words) array += " " + single_quoted(word);
        const std::string script = "cd " + single_quoted(folder.path().string()) + "; . ./complete.bash; COMP_WORDS=(clvr" + array +
                                   "); COMP_CWORD=" + std::to_string(words.size()) +
                                   "; _clvr; for w in \"${COMPREPLY[@]}\"; do echo \"$w\"; done";
        FILE* out = popen(("bash --norc -c " + single_quoted(script)).c_str(), "r");
        Words lines;
        char line[4096];
        while (out && std::fgets(line, sizeof line, out)) lines.emplace_back(line, std::string(line).size() - 1);
        EXPECT_EQ(out ? pclose(out) : -1, 0) << script;
        return lines;
    }
    TemporaryFolder folder;
};

TEST_F(BashCompletion, Commands) {
    EXPECT_THAT(offers({"ren"}), ElementsAre("render"));
    EXPECT_THAT(offers({""}), AllOf(Contains("render"), Contains("info"), Contains("dataset"), Contains("scan.nii")));
    EXPECT_THAT(offers({"dataset", ""}), ElementsAre("list", "info", "fetch", "make"));
    EXPECT_THAT(offers({"sca"}), ElementsAre("scan.nii"));
    EXPECT_THAT(offers({"--ver"}), testing::UnorderedElementsAre("--verbose", "--version"));
}

TEST_F(BashCompletion, Options) {
    EXPECT_THAT(offers({"render", "scan.nii", "--turn"}), ElementsAre("--turntable"));
    EXPECT_THAT(offers({"render", "--"}), AllOf(Contains("--output"), Contains("--config"), Not(Contains("--beside"))));
    EXPECT_THAT(offers({"dataset", "make", "--di"}), ElementsAre("--dims"));
    EXPECT_THAT(offers({"-q", "info", "--js"}), ElementsAre("--json"));
}

TEST_F(BashCompletion, Values) {
    EXPECT_THAT(offers({"render", "--mode", ""}), ElementsAre("path", "dvr", "mip"));
    EXPECT_THAT(offers({"render", "--mode", "=", "d"}), ElementsAre("dvr")); // --mode=d
    EXPECT_THAT(offers({"render", "--mode", "="}), ElementsAre("path", "dvr", "mip"));
    EXPECT_THAT(offers({"render", "--tf", "ct-b"}), Contains("ct-bone"));
    EXPECT_THAT(offers({"render", "--spp", ""}), ElementsAre());
    EXPECT_THAT(offers({"render", "demo", ":", "ves"}), ElementsAre("vessels")); // demo:ves
    EXPECT_THAT(offers({"render", "demo", ":"}), Contains("head"));
    EXPECT_THAT(offers({"dataset", "make", "bee"}), ElementsAre("beetle"));
    EXPECT_THAT(offers({"dataset", "fetch", "bon"}), ElementsAre("bonsai"));
    EXPECT_THAT(offers({"--completion", ""}), ElementsAre("bash", "zsh", "fish"));
}

TEST_F(BashCompletion, FilesAndFolders) {
    EXPECT_THAT(offers({"render", "-o", "s"}), testing::UnorderedElementsAre("scan.nii", "series"));
    EXPECT_THAT(offers({"render", "two"}), ElementsAre("two words.nii"));
    EXPECT_THAT(offers({"train", "s"}), ElementsAre("series"));
    EXPECT_THAT(offers({"info", "sc"}), ElementsAre("scan.nii"));
}

TEST(Completion, ForEveryShellAndOption) {
    CLI::App app;
    add_program(app);
    for (const char* shell : {"bash", "zsh", "fish"}) {
        const std::string script = completion(shell, app, placeholders());
        for (const auto& command : completed_commands(app))
            for (const OptionText& o : command.options) {
                std::string name = o.names.back();
                if (o.positional) continue;
                if (std::string(shell) == "fish") name = "-l " + name.substr(2);
                EXPECT_THAT(script, HasSubstr(name)) << shell << command.path;
            }
        EXPECT_THAT(script, AllOf(Not(HasSubstr("--beside")), Not(HasSubstr("-l beside")))) << shell;
    }
    EXPECT_THROW(completion("csh", app, {}), Error);
}

TEST(Completion, ChoicesOfTypeNames) {
    const auto choices = [](const std::string& value) {
        OptionText option;
        option.value = value;
        return choices_of(option, {{"PRESET", {"mr", "ct"}}});
    };
    EXPECT_THAT(choices("path|dvr|mip").words, ElementsAre("path", "dvr", "mip"));
    EXPECT_THAT(choices("auto|PRESET|FILE").words, ElementsAre("auto", "mr", "ct"));
    EXPECT_TRUE(choices("auto|PRESET|FILE").files);
    EXPECT_TRUE(choices("FILE.html").files);
    EXPECT_TRUE(choices("DIR").folders);
    for (const char* none : {"", "N", "WxH", "X,Y,Z", "N,..."}) {
        EXPECT_THAT(choices(none).words, ElementsAre()) << none;
        EXPECT_FALSE(choices(none).files || choices(none).folders) << none;
    }
}

TEST(ManPages, APageForEachCommand) {
    CLI::App app;
    add_program(app);
    const auto pages = man_pages(app, "clvr 1.2");
    EXPECT_EQ(pages.size(), 1 + commands_of(app).size());
    for (const CLI::App* command : commands_of(app)) {
        const std::string name = "clvr-" + command->get_name();
        ASSERT_EQ(pages.count(name + ".1"), 1u);
        const std::string& page = pages.at(name + ".1");
        EXPECT_THAT(page, AllOf(HasSubstr("\n.SH NAME\n"), HasSubstr("\n.SH EXAMPLES\n"), HasSubstr("\"clvr 1.2\"")));
        EXPECT_THAT(pages.at("clvr.1"), HasSubstr("\\fBclvr\\-" + command->get_name() + "\\fR(1)"));
        for (std::size_t at = page.find('\n'); at != page.npos && at + 1 < page.size(); at = page.find('\n', at + 1))
            if (page[at + 1] == '.' || page[at + 1] == '\'') { // a request: only those that are meant
                EXPECT_THAT(page.substr(at + 1, 4), testing::ContainsRegex("^\\.(TH |SH |SS |TP|PP|nf|fi)"));
            }
    }
    EXPECT_THAT(pages.at("clvr-render.1"),
                AllOf(HasSubstr("\\fB\\-o\\fR, \\fB\\-\\-output\\fR \\fIFILE\\fR\n"), Not(HasSubstr("beside\\fR"))));
    EXPECT_THAT(pages.at("clvr-dataset.1"), AllOf(HasSubstr(".SS clvr dataset make\n"), HasSubstr("\\fB\\-\\-dims\\fR")));
}

} // namespace
} // namespace clvr

// The command line as CLI11 describes it: every order of options and arguments, names that are mistyped, help.
#include "host/cli/described/help.hpp"
#include "host/cli/described/option_text.hpp"
#include "host/cli/first_word.hpp"
#include "host/cli/program.hpp"
#include "runtime/error.hpp"
#include "runtime/system/nearest.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <sstream>

namespace clvr {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Words = std::vector<std::string>;

/// Parses, but runs no command.
class ParsingApp : public CLI::App {
public:
    struct Parsed {};

private:
    void pre_callback() override { throw Parsed(); } // called when all words are understood
};

/// The program whose commands do nothing.
class ParsedProgram {
public:
    ParsedProgram() { add_program(app); }
    void for_each(const std::function<void(CLI::App&)>& visit) { visit_below(app, visit); }
    /// Names of the command from the program's down: "dataset", "make".
    static Words path(const CLI::App& command) {
        Words names;
        for (const CLI::App* c = &command; c->get_parent(); c = c->get_parent()) names.insert(names.begin(), c->get_name());
        return names;
    }
    void parse(Words words) {
        std::reverse(words.begin(), words.end());
        try {
            app.parse(std::move(words));
            ADD_FAILURE() << "a command ran";
        } catch (const ParsingApp::Parsed&) {
        }
    }
    ParsingApp app;

private:
    static void visit_below(CLI::App& app, const std::function<void(CLI::App&)>& visit) {
        for (CLI::App* c : app.get_subcommands([](CLI::App*) { return true; })) {
            visit(*c);
            visit_below(*c, visit);
        }
    }
};

/// Something that the option accepts.
std::string a_value(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    if (type == "WxHxD") return "2x2x2";
    if (type == "SXxSYxSZ") return "1x1x1";
    for (const char* number : {"INT", "UINT", "FLOAT", "N", "N,...", "SECONDS", "1|4"})
        if (type == number) return "3";
    return "word";
}

Words joined(std::initializer_list<Words> parts) {
    Words all;
    for (const Words& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

TEST(CommandLine, NoOptionTakesMoreThanOneWord) {
    ParsedProgram program;
    int options = 0;
    const auto check = [&](const CLI::App& command) {
        for (const CLI::Option* o : command.get_options()) {
            if (o->get_positional()) continue;
            ++options;
            EXPECT_LE(o->get_items_expected_min(), 1) << full_name(command) << " " << o->get_name();
            EXPECT_FALSE(o->get_items_expected_max() > 1 && o->get_allow_extra_args()) << full_name(command) << " " << o->get_name();
        }
    };
    check(program.app);
    program.for_each(check);
    EXPECT_GT(options, 150);
}

TEST(CommandLine, OptionsStandBeforeAndAfterArguments) {
    ParsedProgram program;
    program.for_each([&](CLI::App& command) {
        if (!command.get_subcommands([](CLI::App*) { return true; }).empty()) return;
        Words arguments;
        std::vector<const CLI::Option*> positionals;
        for (const CLI::Option* o : command.get_options()) {
            if (!o->get_positional()) continue;
            positionals.push_back(o);
            for (int k = 0; k < (o->get_items_expected_max() > 1 ? 3 : 1); ++k)
                arguments.push_back("argument" + std::to_string(arguments.size()));
        }
        const Words path = ParsedProgram::path(command);
        for (CLI::Option* o : command.get_options()) {
            if (o->get_positional() || o == command.get_help_ptr()) continue;
            Words given{"--" + o->get_lnames().front()};
            std::size_t times = 1;
            if (o->get_items_expected_max() > 0) given.push_back(a_value(*o));
            if (o->get_items_expected_max() > 1) given = joined({given, given}), times = 2;
            const Words first = arguments.empty() ? Words{} : Words{arguments.front()};
            const Words rest(arguments.begin() + (arguments.empty() ? 0 : 1), arguments.end());
            for (const Words& words :
                 {joined({path, given, arguments}), joined({path, arguments, given}), joined({path, first, given, rest})}) {
                std::string line;
                for (const auto& word : words) line += " " + word;
                EXPECT_NO_THROW(program.parse(words)) << line;
                EXPECT_EQ(o->results().size(), times) << line;
                Words taken;
                for (const CLI::Option* p : positionals) taken.insert(taken.end(), p->results().begin(), p->results().end());
                EXPECT_EQ(taken, arguments) << line;
            }
        }
    });
}

TEST(CommandLine, ListsByCommasAndRepetition) {
    ParsedProgram program;
    const auto results = [&](const Words& words, const std::string& option) {
        program.parse(words);
        return program.app.get_subcommand(words.front())->get_option(option)->results();
    };
    EXPECT_THAT(results({"train", "--channels", "R,G,B", "pairs"}, "--channels"), ElementsAre("R", "G", "B"));
    EXPECT_THAT(results({"train", "--channels", "R,G", "--channels", "B", "a", "b", "-o", "m"}, "--channels"), ElementsAre("R", "G", "B"));
    EXPECT_THAT(results({"train", "a", "-o", "m", "b"}, "DIR"), ElementsAre("a", "b"));
    EXPECT_THAT(results({"ablation", "--test", "t1", "--test", "t2", "a", "b", "-o", "out"}, "--test"), ElementsAre("t1", "t2"));
    EXPECT_THAT(results({"pairs", "--vary-tf", "mr", "scan.nii", "--noisy-spp=1,2"}, "--noisy-spp"), ElementsAre("1", "2"));
    EXPECT_THAT(results({"render", "-oa.png", "--output=b.exr", "scan.nii"}, "--output"), ElementsAre("a.png", "b.exr"));
    EXPECT_THAT(results({"render", "--azimuth", "-40", "scan.nii"}, "--azimuth"), ElementsAre("-40"));
    EXPECT_THROW(program.parse({"render", "-o", "a.png", "b.png", "scan.nii"}), CLI::ParseError);
}

TEST(CommandLine, NearestNames) {
    const Words names{"render", "info", "train", "dataset", "compare"};
    EXPECT_EQ(nearest_name("rendr", names), "render");
    EXPECT_EQ(nearest_name("redner", names), "render");
    EXPECT_EQ(nearest_name("comp", names), "compare");
    EXPECT_EQ(nearest_name("inof", names), "info");
    EXPECT_EQ(nearest_name("scan", names), "");
    EXPECT_EQ(nearest_name("", names), "");
    EXPECT_EQ(nearest_name("--sp", {"--seed", "--spp"}), "--spp");
    EXPECT_EQ(nearest_name(std::string(100000, 'x'), names), "");
}

TEST(CommandLine, AVolumeAloneIsRendered) {
    ParsedProgram program;
    TemporaryFolder folder;
    folder.write("scan.nii.gz", "x");
    const std::string scan = (folder.path() / "scan.nii.gz").string(), absent = (folder.path() / "absent.nii").string();
    const auto words = [&](Words given) { return with_command(program.app, std::move(given)); };
    EXPECT_THAT(words({scan}), ElementsAre("render", "--beside", scan));
    EXPECT_THAT(words({scan, "--spp", "8"}), ElementsAre("render", "--beside", scan, "--spp", "8"));
    EXPECT_THAT(words({"--spp", "8", scan}), ElementsAre("render", "--beside", "--spp", "8", scan));
    EXPECT_THAT(words({"-v", "--kernel-dir", "k", scan}), ElementsAre("-v", "--kernel-dir", "k", "render", "--beside", scan));
    EXPECT_THAT(words({"demo:head"}), ElementsAre("render", "--beside", "demo:head"));
    EXPECT_THAT(words({folder.path().string()}), ElementsAre("render", "--beside", folder.path().string()));
    EXPECT_THAT(words({scan + ":/data"}), ElementsAre("render", "--beside", scan + ":/data"));
    for (const Words& as_they_are :
         {Words{}, {"--version"}, {"info", scan}, {"-q", "info", scan}, {"--spp", "8", "info", scan}, {"--nonsense"}})
        EXPECT_EQ(words(as_they_are), as_they_are);
    const auto refusal = [&](const Words& given) {
        try {
            words(given);
        } catch (const Error& e) {
            return e.line();
        }
        return std::string();
    };
    EXPECT_EQ(refusal({"rendr", scan}), "there is no command or file \"rendr\": did you mean render?");
    EXPECT_EQ(refusal({"frobnicate"}), "there is no command or file \"frobnicate\" (see clvr --help)");
    EXPECT_EQ(refusal({absent}), absent + ": does not exist");
}

TEST(CommandLine, NamesOfPicturesBesideVolumes) {
    EXPECT_EQ(picture_beside("scan.nii.gz"), "scan.png");
    EXPECT_EQ(picture_beside("a/scan.nii"), "a/scan.png");
    EXPECT_EQ(picture_beside("/a.b/scan.v2.NRRD"), "/a.b/scan.v2.png");
    EXPECT_EQ(picture_beside("cells.ome.tif"), "cells.png");
    EXPECT_EQ(picture_beside("IM0001"), "IM0001.png");
    EXPECT_EQ(picture_beside("1.2.840.113619"), "1.2.840.113619.png");
    EXPECT_EQ(picture_beside("1.2.840.7.dcm"), "1.2.840.7.png");
    EXPECT_EQ(picture_beside(".hidden"), ".hidden.png");
    EXPECT_EQ(picture_beside("data.h5:/group/set"), "data.png");
    EXPECT_EQ(picture_beside("demo:vessels"), "vessels.png");
    TemporaryFolder folder;
    const std::string scans = (folder.path() / "scans.2024").string();
    std::filesystem::create_directory(scans);
    EXPECT_EQ(picture_beside(scans), scans + ".png");
    EXPECT_EQ(picture_beside(scans + "/"), scans + ".png");
    EXPECT_EQ(picture_beside(scans + "/."), std::filesystem::canonical(scans).string() + ".png");
    EXPECT_THROW(picture_beside("/"), Error);
}

TEST(Help, OutputLookCameraThenTheRest) {
    ParsedProgram program;
    const std::string help = help_text(*program.app.get_subcommand("render"));
    std::size_t before = 0;
    for (const char* part :
         {"Usage: clvr render [OPTION...] [VOLUME]", "\nOutput:\n  -o, --output FILE", "\nLook:\n", "\nCamera:\n", "\nLight:\n",
          "\nReading the volume:\n", "\nDevice:\n", "\nOptions:\n  -h, --help", "\nTransfer functions:\n", "\nExamples:\n"}) {
        const std::size_t at = help.find(part);
        ASSERT_NE(at, help.npos) << part << help;
        EXPECT_GE(at, before) << part;
        before = at;
    }
    EXPECT_THAT(help, AllOf(HasSubstr("LPS millimetres"), HasSubstr("\"color_space\": \"linear\""), HasSubstr("path|dvr|mip")));
}

TEST(Help, EveryCommandSaysWhatItDoesInLinesThatFit) {
    ParsedProgram program;
    const auto check = [&](const CLI::App& command) {
        const std::string help = help_text(command), name = full_name(command);
        EXPECT_NE(command.get_description(), "") << name;
        for (const OptionText& o : options_of(command)) {
            EXPECT_NE(o.description, "") << name << " " << o.usage();
            EXPECT_THAT(o.value, testing::Not(HasSubstr("TEXT"))) << name << " " << o.usage();
            EXPECT_THAT(help, HasSubstr("  " + o.usage() + (o.usage().size() > 22 ? "\n" : " "))) << name;
            const bool shared = o.positional || name == "clvr" || o.names.back() == "--help";
            EXPECT_TRUE(shared || o.group != "Options") << name << " " << o.usage();
        }
        std::istringstream lines(help);
        for (std::string line; std::getline(lines, line);) EXPECT_TRUE(line.size() <= 80u || line.rfind("  clvr ", 0) == 0) << line;
        EXPECT_THAT(help, HasSubstr("\nExamples:\n  clvr")) << name;
    };
    check(program.app);
    program.for_each(check);
}

} // namespace
} // namespace clvr

#include "runtime/opencl/source.hpp"

#include "runtime/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

namespace clvr {
namespace {

using Files = std::map<std::string, std::string>;

ReadKernelFile reader(const Files& files) {
    return [&files](const std::string& path) -> std::optional<std::string> {
        const auto found = files.find(path);
        if (found == files.end()) return std::nullopt;
        return found->second;
    };
}

std::vector<std::string> lines_of(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

/// What a preprocessor makes of the `#line` directives: (file, line) of each line of the text.
std::vector<Source::Origin> positions(const Source& source) {
    std::vector<Source::Origin> result;
    Source::Origin next{"", 1};
    for (const std::string& line : lines_of(source.text)) {
        result.push_back(next);
        ++next.line;
        if (line.rfind("#line ", 0) != 0) continue;
        std::istringstream words(line.substr(6));
        words >> next.line >> next.file;
        next.file = next.file.substr(1, next.file.size() - 2);
    }
    return result;
}

TEST(Source, IncludesBesideTheFileAndUnderTheRoot) {
    const Files files{{"a/main.cl", "#include \"near.clh\"\n#include \"lib/far.clh\"\nmain\n"},
                      {"a/near.clh", "near\n"},
                      {"near.clh", "wrong\n"},
                      {"lib/far.clh", "#include \"../a/near.clh\"\nfar\n"}};
    const std::string text = expand_source("a/main.cl", reader(files)).text;
    EXPECT_EQ(count(text, "\nnear\n"), 1u) << text;
    EXPECT_EQ(count(text, "wrong"), 0u) << text;
    EXPECT_LT(text.find("\nnear\n"), text.find("\nfar\n"));
    EXPECT_LT(text.find("\nfar\n"), text.find("\nmain\n"));
}

TEST(Source, APreludeComesFirst) {
    const Files files{{"m.cl", "#include \"x.clh\"\nmain\n"}, {"x.clh", "other\n"}, {"p.clh", "first\n"}};
    const Source source = expand_source("m.cl", reader(files), "p.clh");
    EXPECT_LT(source.text.find("\nfirst\n"), source.text.find("\nother\n")) << source.text;
    ASSERT_EQ(lines_of(source.text).size(), source.origins.size());
    EXPECT_EQ(source.origins.back().file, "m.cl");
    EXPECT_EQ(source.origins.back().line, 2);
}

TEST(Source, LineDirectivesAndLineTableAgree) {
    const Files files{{"m.cl", "one\n#include \"x.clh\"\nthree\n#include \"x.clh\"\nfive\n"},
                      {"x.clh", "#pragma once\nX2\n#include \"y.clh\"\nX4\n"},
                      {"y.clh", "Y1\r\nY2"}};
    const Source source = expand_source("m.cl", reader(files));
    const auto text = lines_of(source.text);
    ASSERT_EQ(text.size(), source.origins.size());
    const auto compiler = positions(source);
    std::map<std::string, std::string> where;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i].empty() || text[i][0] == '#') continue;
        where[text[i]] = source.origins[i].file + ":" + std::to_string(source.origins[i].line);
        EXPECT_EQ(compiler[i].file, source.origins[i].file) << text[i];
        EXPECT_EQ(compiler[i].line, source.origins[i].line) << text[i];
    }
    const std::map<std::string, std::string> expected{{"one", "m.cl:1"}, {"three", "m.cl:3"}, {"five", "m.cl:5"}, {"X2", "x.clh:2"},
                                                      {"X4", "x.clh:4"}, {"Y1", "y.clh:1"},   {"Y2", "y.clh:2"}};
    EXPECT_EQ(where, expected);
}

TEST(Source, ConditionalIncludeDoesNotHideALaterOne) {
    const Files files{{"m.cl", "#ifdef A\n#include \"x.clh\"\n#endif\n#include \"x.clh\"\n#include \"x.clh\"\n"}, {"x.clh", "X\n"}};
    const std::string text = expand_source("m.cl", reader(files)).text;
    EXPECT_EQ(count(text, "\nX\n"), 2u) << text; // one of them behind #ifdef A, both behind the same guard
    EXPECT_EQ(count(text, "#ifndef CLVR_INCLUDED_x_clh\n#define CLVR_INCLUDED_x_clh\n"), 2u) << text;
}

TEST(Source, CircleEnds) {
    const Files files{{"m.cl", "#include \"x.clh\"\nm\n"}, {"x.clh", "#ifdef A\n#include \"m.cl\"\n#endif\n#include \"x.clh\"\nX\n"}};
    const std::string text = expand_source("m.cl", reader(files)).text;
    EXPECT_EQ(count(text, "\nX\n"), 1u) << text;
}

TEST(Source, MissingIncludeIsNamedWithFileAndLine) {
    const Files files{{"a/m.cl", "#include \"x.clh\"\n"}, {"a/x.clh", "1\n2\n  #  include \"gone.clh\" // why\n"}};
    try {
        expand_source("a/m.cl", reader(files));
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_EQ(error.where(), "a/x.clh:3");
        EXPECT_THAT(error.what(), testing::HasSubstr("gone.clh"));
    }
    EXPECT_THROW(expand_source("none.cl", reader(files)), Error);
}

TEST(Source, ConditionalOrSystemIncludesAreLeftToTheCompiler) {
    const Files files{{"m.cl", "#include <x.h>\n#ifdef __cplusplus\n#include \"host/only.hpp\"\n#endif\n"}};
    const std::string text = expand_source("m.cl", reader(files)).text;
    EXPECT_EQ(count(text, "#include <x.h>"), 1u);
    EXPECT_EQ(count(text, "#include \"host/only.hpp\""), 1u);
}

TEST(Source, NothingOutsideTheRoot) {
    const Files files{{"m.cl", "#include \"../secret\"\n"}, {"../secret", "S\n"}};
    EXPECT_THROW(expand_source("m.cl", reader(files)), Error);
}

TEST(Source, LogsOfCompilersThatCountTheWholeText) {
    const Files files{{"m.cl", "#include \"x.clh\"\nm\n"}, {"x.clh", "good\nbad\n"}};
    const Source source = expand_source("m.cl", reader(files));
    const auto text = lines_of(source.text);
    const auto bad = std::find(text.begin(), text.end(), "bad") - text.begin() + 1;
    const std::string log = "input.cl:" + std::to_string(bad) + ":5: error: bad\nbad\n    ^\n1 error generated.\n";
    EXPECT_EQ(located_log(log, source, true), "x.clh:2:5: error: bad\nbad\n    ^\n1 error generated.\n");
    EXPECT_EQ(located_log(log, source, false), log);
    EXPECT_EQ(located_log("input.cl:99999:1: error\n", source, true), "input.cl:99999:1: error\n");
}

TEST(Source, KernelDirMustBeAFolder) {
    EXPECT_THROW(set_kernel_dir("/dev/null"), Error);
    EXPECT_TRUE(read_kernel_file("probe/trust.cl"));
    EXPECT_FALSE(read_kernel_file("probe/none.cl"));
}

} // namespace
} // namespace clvr

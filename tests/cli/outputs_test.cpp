// No output is an input or another output: every command's options are walked as CLI11 describes them, so that none can be forgotten.
#include "host/cli/file_options.hpp"
#include "host/cli/program.hpp"
#include "host/io/file_roles.hpp"
#include "runtime/error.hpp"
#include "tests/cli/home.hpp"

#include <gmock/gmock.h>

namespace clvr {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string content = "# not to be lost\n"; // a configuration file may hold it, too

std::string text_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// A command with the words that call it.
struct Command {
    std::vector<std::string> words;
    const CLI::App* app;
};

class Outputs : public Program {
protected:
    CLI::App all;
    std::vector<Command> commands;

    Outputs() {
        add_program(all);
        collect(all, {});
    }

    void collect(const CLI::App& app, const std::vector<std::string>& words) {
        for (const CLI::App* c : app.get_subcommands([](const CLI::App*) { return true; })) {
            std::vector<std::string> called = words;
            called.push_back(c->get_name());
            commands.push_back({called, c});
            collect(*c, called);
        }
    }

    static std::string name_of(const Command& command, const CLI::Option* option) {
        std::string name;
        for (const auto& word : command.words) name += word + " ";
        return name + option->get_name();
    }

    /// The command with these values of options, and something for every other one that it requires.
    static std::vector<std::string> line(const Command& command, const std::vector<std::pair<const CLI::Option*, std::string>>& values) {
        std::vector<std::string> arguments = command.words, positionals;
        for (const CLI::Option* option : command.app->get_options()) {
            std::vector<std::string> given;
            for (const auto& [of, value] : values)
                if (of == option) given.push_back(value);
            if (given.empty() && option->get_required()) given = {"bonsai"};
            for (const std::string& value : given)
                if (option->get_positional())
                    positionals.push_back(value);
                else
                    arguments.push_back(option->get_name() + "=" + value);
        }
        arguments.insert(arguments.end(), positionals.begin(), positionals.end());
        return arguments;
    }
};

TEST_F(Outputs, OfEveryFileOptionIsKnownWhetherItIsReadOrWritten) {
    for (const Command& command : commands)
        for (const CLI::Option* option : command.app->get_options()) {
            const std::string type = option->get_type_name();
            bool is_file = option->get_positional() && option->get_name() != "NAME"; // NAME: of a published or computed volume
            for (const char* word : {"FILE", "DIR", "MODEL", ".png", ".html"}) is_file |= type.find(word) != std::string::npos;
            const FileOption role = file_option(option);
            EXPECT_EQ(is_file, role.read != role.written) << name_of(command, option) << " " << type;
        }
}

TEST_F(Outputs, AreNoInputs) {
    int tried = 0;
    for (const Command& command : commands)
        for (const CLI::Option* written : command.app->get_options()) {
            if (!file_option(written).written) continue;
            for (const CLI::Option* read : command.app->get_options()) {
                if (!file_option(read).read) continue;
                for (const std::string how : {"itself", "symbolic link", "hard link"}) {
                    const fs::path place = home.path() / std::to_string(tried++);
                    const std::string value = (place / "made.png").string();
                    std::vector<std::string> files = file_option(written).files(value);
                    ASSERT_FALSE(files.empty()) << name_of(command, written);
                    if (files.size() > 4) files = {files.front(), files[files.size() / 2], files.back()};
                    for (const std::string& file : files) {
                        fs::remove_all(place);
                        fs::create_directories(fs::path(file).parent_path());
                        const fs::path input = how == "itself" ? fs::path(file) : place / "the input";
                        std::ofstream(input) << content;
                        if (how == "symbolic link") fs::create_symlink("../" + place.filename().string() + "/the input", place / "link");
                        if (how == "symbolic link") fs::create_symlink(place / "link", file);
                        if (how == "hard link") fs::create_hard_link(input, file);
                        const Outcome o = run(line(command, {{written, value}, {read, input.string()}}));
                        const std::string what = name_of(command, written) + " and " + read->get_name() + ": " + file + ", " + how;
                        EXPECT_EQ(text_of(input), content) << what;
                        EXPECT_EQ(line_count(o.err), 1) << what;
                        // A plan that is in the folder is continued, and never overwritten.
                        if (input.filename() == "pairs.json" && command.words.front() == "pairs" && read->get_positional()) continue;
                        EXPECT_EQ(o.exit_code, 2) << what << "\n" << o.err;
                        EXPECT_THAT(o.err, HasSubstr("must not be overwritten")) << what;
                    }
                }
            }
        }
    EXPECT_GT(tried, 60); // each number once for three commands or more
}

TEST_F(Outputs, AreNotTheConfiguration) {
    for (const Command& command : commands)
        for (const CLI::Option* written : command.app->get_options()) {
            if (!file_option(written).written) continue;
            const std::string value = (home.path() / "made.png").string(), file = file_option(written).files(value).front();
            fs::remove_all(value);
            fs::create_directories(fs::path(file).parent_path());
            std::ofstream(file) << content;
            std::vector<std::string> arguments = line(command, {{written, value}});
            arguments.insert(arguments.begin(), {"--config", file});
            const Outcome o = run(arguments);
            EXPECT_EQ(o.exit_code, 2) << name_of(command, written) << "\n" << o.err;
            EXPECT_THAT(o.err, HasSubstr("must not be overwritten"));
            EXPECT_EQ(text_of(file), content);
        }
}

TEST_F(Outputs, AreNoOtherOutputs) {
    int tried = 0;
    for (const Command& command : commands)
        for (const CLI::Option* first : command.app->get_options())
            for (const CLI::Option* second : command.app->get_options()) {
                const FileOption a = file_option(first), b = file_option(second);
                const std::string value = (home.path() / "x.png").string(), link = (home.path() / "y.png").string();
                if (!a.written || !b.written || a.files(value).front() != value || b.files(value).front() != value) continue;
                if (first == second && first->get_items_expected_max() < 2) continue;
                ++tried;
                for (const bool there : {false, true}) {
                    fs::remove(value), fs::remove(link);
                    if (there) std::ofstream(value) << content;
                    fs::create_symlink(value, link);
                    const Outcome o = run(line(command, {{first, value}, {second, link}}));
                    EXPECT_EQ(o.exit_code, 2) << name_of(command, first) << " and " << second->get_name() << "\n" << o.err;
                    EXPECT_THAT(o.err, HasSubstr("must not be overwritten"));
                }
            }
    EXPECT_GE(tried, 3); // of render alone
}

TEST_F(Outputs, OfTurntablesAreTheNumberedPictures) {
    home.write("t_001.exr", content);
    const std::string input = (home.path() / "t_001.exr").string(), output = (home.path() / "t.exr").string();
    const Outcome o = run({"render", "demo:head", "--environment", input, "-o", output, "--turntable", "3"});
    EXPECT_EQ(o.exit_code, 2);
    EXPECT_THAT(o.err, HasSubstr("t_001.exr"));
    EXPECT_EQ(text_of(input), content);
}

TEST_F(Outputs, StandardOutputIsNoInput) {
    home.write("volume.nii", content);
    const std::string input = (home.path() / "volume.nii").string();
    const Outcome o = run({"info", input}, {}, [&] { dup2(open(input.c_str(), O_WRONLY | O_APPEND), STDOUT_FILENO); });
    EXPECT_EQ(o.exit_code, 2);
    EXPECT_EQ(text_of(input), content);
}

struct FileRoles : testing::Test {
    TemporaryFolder folder;
    ~FileRoles() override { forget_file_roles(); }
    std::string path(const std::string& name) const { return (folder.path() / name).string(); }
};

TEST_F(FileRoles, AFileThatAnotherFileNamesIsFoundWhenItIsRead) {
    folder.write("voxels.raw", content);
    will_write(path("voxels.raw"), "-o");
    try {
        will_read(path("./voxels.raw"));
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::usage);
        EXPECT_EQ(e.where(), "-o");
    }
}

TEST_F(FileRoles, FilesThatAreNotThereYetAreKnownByTheirPlace) {
    fs::create_directory(folder.path() / "a");
    fs::create_directory_symlink(folder.path() / "a", folder.path() / "b");
    fs::create_symlink(path("a/x"), path("dangling"));
    will_write(path("a/x"), "-o");
    EXPECT_NO_THROW(will_write(path("a/y"), "-o"));
    EXPECT_THROW(will_write(path("b/x"), "--report"), Error);
    EXPECT_THROW(will_write(path("b/../b/y"), "--report"), Error);
    EXPECT_THROW(will_write(path("dangling"), "--report"), Error);
}

TEST_F(FileRoles, AnotherFileMayHaveTheInodeOfOneThatIsGone) {
    folder.write("written", content);
    fs::create_hard_link(path("written"), path("new"));
    will_write(path("written"), "-o");
    fs::remove(path("written")); // "new" stands for a file that got the freed inode
    EXPECT_NO_THROW(will_read(path("new")));
    fs::create_hard_link(path("new"), path("newer"));
    fs::remove(path("new"));
    EXPECT_NO_THROW(will_write(path("newer"), "-o"));
    EXPECT_THROW(will_read(path("newer")), Error);
}

TEST_F(FileRoles, PartsOfFilesAreTheirFiles) {
    folder.write("cells.h5", content);
    will_write(path("cells.h5"), "--save-scene");
    EXPECT_THROW(will_read(path("cells.h5") + ":/t00/s00", "VOLUME"), Error);
}

TEST_F(FileRoles, DevicesMayBeShared) {
    will_read("/dev/null", "VOLUME");
    EXPECT_NO_THROW(will_write("/dev/null", "-o"));
    EXPECT_NO_THROW(will_write("/dev/null", "--save-scene"));
}

} // namespace
} // namespace clvr

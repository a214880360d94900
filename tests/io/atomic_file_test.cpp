// Files that are never seen half-written.
#include "runtime/system/atomic_file.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace clvr {
namespace {

using test::error_of;
using test::Folder;
using ::testing::HasSubstr;

void write(const std::string& path, const std::string& text) { write_atomically(path, text.data(), text.size()); }

TEST(AtomicFileTest, WritesAndReplaces) {
    const Folder folder;
    write(folder / "a", "first");
    EXPECT_EQ(read_text(folder / "a"), "first");
    write(folder / "a", std::string("sec\0nd", 6));
    EXPECT_EQ(read_text(folder / "a"), std::string("sec\0nd", 6));
    write(folder / "empty", "");
    EXPECT_EQ(read_text(folder / "empty"), "");
    EXPECT_EQ(folder.entries(), 2u);
}

TEST(AtomicFileTest, TheUmaskDecidesWhoMayRead) {
    const Folder folder;
    const mode_t before = ::umask(027);
    write(folder / "a", "x");
    ::umask(before);
    struct stat facts {};
    ASSERT_EQ(::stat((folder / "a").c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777, 0640u);
}

TEST(AtomicFileTest, AFailureKeepsTheOldFileAndLeavesNothingElse) {
    const Folder folder;
    write(folder / "a", "old");
    const auto fails = [](const std::string& temporary) {
        std::ofstream(temporary) << "half";
        throw Error(ErrorKind::input, "stopped", "test");
    };
    EXPECT_THROW(write_atomically(folder / "a", fails), Error);
    EXPECT_EQ(read_text(folder / "a"), "old");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFileTest, AFullDiskIsAnErrorAndLeavesNothing) {
    const Folder folder;
    const pid_t child = ::fork();
    if (child == 0) { // a limit on file sizes stands for a full disk
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{4096, 4096};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        try {
            write(folder / "a", std::string(10000, 'x'));
        } catch (const Error& e) {
            ::_exit(e.kind() == ErrorKind::input && e.line().find("5904 of 10000 bytes are missing") != std::string::npos ? 7 : 8);
        }
        ::_exit(9);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_EQ(folder.entries(), 0u);
}

TEST(AtomicFileTest, WritersAtTheSameTimeLeaveOneWholeFile) {
    const Folder folder;
    std::vector<std::thread> writers;
    for (char c : {'a', 'b', 'c', 'd'})
        writers.emplace_back([&folder, c] {
            for (int i = 0; i < 5; ++i) write(folder / "shared", std::string(20000, c));
        });
    for (auto& w : writers) w.join();
    const std::string text = read_text(folder / "shared");
    EXPECT_EQ(text, std::string(20000, text[0]));
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(AtomicFileTest, ALinkStaysALink) {
    const Folder folder;
    std::filesystem::create_directory(folder / "d");
    write(folder / "d/real", "old");
    std::filesystem::create_symlink("d/real", folder / "link");
    write(folder / "link", "new");
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    EXPECT_EQ(read_text(folder / "d/real"), "new");
}

TEST(AtomicFileTest, PlacesThatAreRefused) {
    const Folder folder;
    EXPECT_THAT(error_of([&] { write(folder / ".", "x"); }).line(), HasSubstr("is a folder"));
    EXPECT_THAT(error_of([&] { write("/dev/null", "x"); }).line(), HasSubstr("not a regular file"));
    EXPECT_THROW(write("", "x"), Error);
}

TEST(ReadTextTest, Limits) {
    const Folder folder;
    test::put(folder / "a", std::string(1000, 'x'));
    EXPECT_EQ(read_text(folder / "a", 1000).size(), 1000u);
    EXPECT_THAT(error_of([&] { read_text(folder / "a", 999); }).line(), HasSubstr("larger than 999 bytes"));
    EXPECT_THAT(error_of([&] { read_text(folder / "b"); }).line(), HasSubstr("No such file"));
    EXPECT_THAT(error_of([&] { read_text(folder / "."); }).line(), HasSubstr("is a folder"));
    EXPECT_THAT(error_of([] { read_text("/dev/zero", 100000); }).line(), HasSubstr("larger than"));
}

} // namespace
} // namespace clvr

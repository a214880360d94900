#include "runtime/drivers/driver_trial.hpp"
#include "runtime/system/temporary.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>

#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

namespace clvr {
namespace {

namespace fs = std::filesystem;

struct Temporaries : testing::Test {
    TemporaryFolder folder;
    std::string here() const { return folder.path().string(); }
    std::ptrdiff_t count() const { return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()); }
};

TEST_F(Temporaries, AreGoneWithTheirObject) {
    {
        const Temporary file = Temporary::file_in(here()), other = Temporary::folder_in(here(), "test");
        EXPECT_TRUE(fs::is_regular_file(file.path()));
        std::ofstream(other.path() + "/inside") << "x";
        EXPECT_EQ(count(), 2);
    }
    EXPECT_EQ(count(), 0);
}

TEST_F(Temporaries, StayWhereTheyAreGivenUp) {
    {
        Temporary file = Temporary::file_in(here());
        fs::rename(file.path(), folder.path() / "kept");
        file.give_up();
    }
    EXPECT_TRUE(fs::exists(folder.path() / "kept"));
}

TEST_F(Temporaries, CannotBeMadeWhereThereIsNoFolder) {
    EXPECT_EQ(Temporary::file_in(here() + "/none").path(), "");
    EXPECT_EQ(errno, ENOENT);
    EXPECT_EQ(Temporary::folder_in(here() + "/none", "test").path(), "");
}

TEST_F(Temporaries, AreRemovedAtTheEndOfAProcess) {
    const pid_t child = fork();
    if (child == 0) {
        const Temporary file = Temporary::file_in(here()), other = Temporary::folder_in(here(), "test");
        remove_temporaries();
        _exit(0);
    }
    waitpid(child, nullptr, 0);
    EXPECT_EQ(count(), 0);
}

TEST_F(Temporaries, OfKilledProcessesAreRemovedAndThoseOfLivingOnesAreNot) {
    const pid_t child = fork();
    if (child == 0) {
        const Temporary file = Temporary::file_in(here()), other = Temporary::folder_in(here(), "test");
        kill(getpid(), SIGKILL);
    }
    waitpid(child, nullptr, 0);
    folder.write("a user's .clvr-1.tmp", "x");
    folder.write(".clvr-notes", "x");
    ASSERT_EQ(count(), 4);
    const Temporary mine = Temporary::file_in(here()), my_folder = Temporary::folder_in(here(), "test");
    remove_stale_files(here());
    EXPECT_EQ(count(), 5) << "the killed process's file is gone";
    EXPECT_TRUE(fs::exists(mine.path()));
    remove_stale_files(here()); // once a folder
}

TEST_F(Temporaries, FoldersOfKilledProcessesAreRemovedAndThoseOfLivingOnesAreNot) {
    const pid_t child = fork();
    if (child == 0) {
        const Temporary other = Temporary::folder_in(here(), "test");
        std::ofstream(other.path() + "/inside") << "x";
        kill(getpid(), SIGKILL);
    }
    waitpid(child, nullptr, 0);
    const Temporary mine = Temporary::folder_in(here(), "test");
    ASSERT_EQ(count(), 2);
    remove_stale_folders(here(), "test");
    EXPECT_EQ(count(), 1);
    EXPECT_TRUE(fs::exists(mine.path()));
}

TEST(DriverProblem, IsTheLastWordOrWhatIsKnownOfIt) {
    EXPECT_EQ(driver_problem("", "crashed (Aborted)"), "crashed (Aborted)");
    EXPECT_EQ(driver_problem("one\nlast words\n \n", "crashed (Aborted)"), "crashed (Aborted) (it said: last words)");
    EXPECT_THAT(driver_problem("error: unable to execute command: Executable \"ld\" doesn't exist!\nFinal linking failed.\n", "it crashed"),
                testing::HasSubstr("no linker (ld) in PATH"));
}

} // namespace
} // namespace clvr

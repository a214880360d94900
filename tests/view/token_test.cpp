// The secret of a viewer.
#include "host/view/token.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "tests/io/folder.hpp"

#include <gtest/gtest.h>

#include <set>
#include <sys/stat.h>

namespace clvr::view {
namespace {

TEST(Token, HasMoreThan128BitsAndIsNewEachTime) {
    std::set<std::string> tokens;
    for (int i = 0; i < 100; ++i) tokens.insert(new_token());
    EXPECT_EQ(tokens.size(), 100u);
    for (const std::string& token : tokens) EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_EQ(tokens.begin()->size(), 64u);
}

TEST(Token, IsComparedAsAWhole) {
    EXPECT_TRUE(same_token("abc", "abc"));
    EXPECT_FALSE(same_token("abc", "abd"));
    EXPECT_FALSE(same_token("abc", "ab"));
    EXPECT_FALSE(same_token("", "a"));
}

TEST(Token, LiesInAFileForItsOwnerAlone) {
    const test::Folder folder;
    const std::string path = folder / "token";
    write_atomically(path, std::string("older, and open to all"));
    chmod(path.c_str(), 0644);
    write_token_file(path, "abc");
    struct stat found {};
    ASSERT_EQ(stat(path.c_str(), &found), 0);
    EXPECT_EQ(found.st_mode & 0777, 0600u);
    EXPECT_EQ(read_text(path), "abc\n");
    EXPECT_THROW(write_token_file(folder / "no/token", "abc"), Error);
}

} // namespace
} // namespace clvr::view

// Folders that belong to settings.
#include "host/io/settled_folder.hpp"
#include "runtime/system/atomic_file.hpp"
#include "tests/io/frames.hpp"

namespace clvr {
namespace {

using test::error_of;
using test::Folder;

TEST(SettledFolder, GoesOnWithTheSameSettingsAlone) {
    const Folder folder;
    const std::string path = folder / "run";
    begin_settled_folder(path, "plan.json", R"({"a": 1, "b": {"c": 0.1}})", "holds others");
    EXPECT_EQ(read_text(path + "/plan.json"), R"({"a": 1, "b": {"c": 0.1}})");
    begin_settled_folder(path, "plan.json", R"({"b": {"c": 0.1}, "a": 1})", "holds others");
    for (const char* other : {R"({"a": 1, "b": {"c": 0.2}})", R"({"a": 1})", "{"})
        EXPECT_EQ(error_of([&] { begin_settled_folder(path, "plan.json", other, "holds others"); }).line(), path + ": holds others")
            << other;
    write_atomically(path + "/plan.json", std::string("{")); // cut off: no settings are the same
    EXPECT_THROW(begin_settled_folder(path, "plan.json", "[", "holds others"), Error);
}

} // namespace
} // namespace clvr

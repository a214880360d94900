#include "runtime/opencl/program_cache.hpp"

#include "runtime/system/folders.hpp"
#include "tests/runtime/scoped.hpp"

#include <gtest/gtest.h>

#include <set>
#include <thread>

namespace clvr {
namespace {

const std::string key(64, 'a');

TEST(ProgramCache, EntryComesBack) {
    const std::string binary("\0\n\x7f"
                             "ELF\n\n",
                             8);
    EXPECT_EQ(decode_entry(key, encode_entry(key, binary)), binary);
}

TEST(ProgramCache, BrokenEntriesAreRefused) {
    const std::string entry = encode_entry(key, "a program of thirty-one bytes..");
    for (std::size_t length = 0; length < entry.size(); ++length) EXPECT_FALSE(decode_entry(key, entry.substr(0, length))) << length;
    for (std::size_t i = 0; i < entry.size(); ++i)
        for (const char flip : {'\x01', '\x80'}) {
            std::string changed = entry;
            changed[i] = static_cast<char>(changed[i] ^ flip);
            EXPECT_FALSE(decode_entry(key, changed)) << i;
        }
    EXPECT_FALSE(decode_entry(key, entry + "x"));
    EXPECT_FALSE(decode_entry(std::string(64, 'b'), entry)) << "made for another key";
    EXPECT_FALSE(decode_entry(key, encode_entry(key, "")));
}

TEST(ProgramCache, KeyHoldsAllThatDecides) {
    DeviceFacts facts;
    facts.name = "name";
    std::set<std::string> keys{program_key(facts, "source", "options"), program_key(facts, "source2", "options"),
                               program_key(facts, "source", "options2"), program_key(facts, "sourceo", "ptions")};
    for (std::string DeviceFacts::*field : {&DeviceFacts::name, &DeviceFacts::version, &DeviceFacts::driver_version, &DeviceFacts::platform,
                                            &DeviceFacts::platform_version}) {
        DeviceFacts other = facts;
        other.*field += "2";
        keys.insert(program_key(other, "source", "options"));
    }
    EXPECT_EQ(keys.size(), 9u);
    EXPECT_EQ(program_key(facts, "s", "o"), program_key(facts, "s", "o"));
}

TEST(ProgramCache, ManyWritersLeaveOneGoodEntryAndNothingElse) {
    const TemporaryFolder folder;
    const ScopedVariable cache("XDG_CACHE_HOME", folder.path().string());
    const std::string binary(100000, 'x');
    std::vector<std::thread> writers;
    for (int i = 0; i < 4; ++i)
        writers.emplace_back([&] {
            for (int k = 0; k < 20; ++k) {
                store_program(key, binary);
                EXPECT_EQ(load_program(key), binary);
            }
        });
    for (std::thread& writer : writers) writer.join();
    const auto entries =
        std::distance(std::filesystem::directory_iterator(folder.path() / "clvr" / "programs"), std::filesystem::directory_iterator());
    EXPECT_EQ(entries, 1);
}

TEST(ProgramCache, UnwritableFolderIsNoError) {
    const ScopedVariable cache("XDG_CACHE_HOME", "/dev/null");
    store_program(key, "binary");
    EXPECT_FALSE(load_program(key));
    EXPECT_FALSE(cache_folder());
}

} // namespace
} // namespace clvr

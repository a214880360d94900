// Every byte of every volume format, damaged in turn: a read volume or an Error, never a crash.
#include "tests/io/volume_formats.hpp"

namespace clvr::test {
namespace {

class DamagedFormat : public ::testing::TestWithParam<VolumeFormat> {};

void damage_every_byte(const std::string& file, const std::string& volume, int step) {
    const std::string whole = read(file);
    for (std::size_t i = 0; i < whole.size(); i += static_cast<std::size_t>(step)) {
        std::string damaged = whole;
        for (const char flip : {'\x01', '\x10', '\x80', '\xff'}) {
            damaged[i] = static_cast<char>(whole[i] ^ flip);
            write(file, damaged);
            reads_or_throws(volume);
        }
        for (const char other : {'0', '9', '-', '\n'}) { // what hurts a text
            damaged[i] = other;
            write(file, damaged);
            reads_or_throws(volume);
        }
        write(file, whole.substr(0, i));
        reads_or_throws(volume);
    }
    write(file, whole);
}

TEST_P(DamagedFormat, EveryByteChangedOrCut) {
    const Folder folder;
    const Written w = GetParam().write(folder, Sample());
    damage_every_byte(w.payload, w.path, GetParam().step);
    if (w.path != w.payload && std::filesystem::is_regular_file(w.path)) damage_every_byte(w.path, w.path, GetParam().step);
    EXPECT_TRUE(reads_or_throws(w.path));
}

INSTANTIATE_TEST_SUITE_P(Volume, DamagedFormat, ::testing::ValuesIn(volume_formats()),
                         [](const auto& p) { return std::string(p.param.name); });

} // namespace
} // namespace clvr::test

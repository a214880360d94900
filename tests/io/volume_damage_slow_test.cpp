// Every byte of every volume format, damaged in turn: a read volume or an Error, never a crash.
#include "tests/io/volume_formats.hpp"

namespace clvr::test {
namespace {

class DamagedFormat : public ::testing::TestWithParam<VolumeFormat> {};

TEST_P(DamagedFormat, EveryByteFlippedOrCut) {
    const Folder folder;
    const Written w = GetParam().write(folder, Sample());
    const std::string whole = read(w.payload),
                      header = read(w.path == w.payload || std::filesystem::is_directory(w.path) ? w.payload : w.path);
    const bool detached = w.path != w.payload && !std::filesystem::is_directory(w.path);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const unsigned char flip : {0x01, 0x10, 0x80, 0xff}) {
            std::string damaged = whole;
            damaged[i] ^= static_cast<char>(flip);
            write(w.payload, damaged);
            reads_or_throws(w.path);
        }
        write(w.payload, whole.substr(0, i));
        reads_or_throws(w.path);
    }
    write(w.payload, whole);
    for (std::size_t i = 0; detached && i < header.size(); ++i) {
        for (const char c : {'0', '9', '-', ' ', '\n', '\xff'}) {
            std::string damaged = header;
            damaged[i] = c;
            write(w.path, damaged);
            reads_or_throws(w.path);
        }
        write(w.path, header.substr(0, i));
        reads_or_throws(w.path);
    }
}

INSTANTIATE_TEST_SUITE_P(Volume, DamagedFormat, ::testing::ValuesIn(volume_formats()),
                         [](const auto& p) { return std::string(p.param.name); });

} // namespace
} // namespace clvr::test

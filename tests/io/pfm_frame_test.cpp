// Portable float maps: order of rows, bytes, scale.
#include "host/io/picture/frame_file.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>

namespace clvr {
namespace {

using test::error_of;
using test::Folder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string floats(const std::vector<float>& values, bool big) {
    std::string bytes;
    for (const float v : values) {
        char b[4];
        std::memcpy(b, &v, 4);
        if (big) std::reverse(b, b + 4);
        bytes.append(b, 4);
    }
    return bytes;
}

TEST(PfmTest, RowsBeginBelow) {
    const Folder folder;
    const std::vector<float> lower{1, 2, 3, 4, 5, 6}, upper{7, 8, 9, 10, 11, 12};
    for (const bool big : {false, true}) {
        test::put(folder / "a.pfm", std::string("PF\n2 2\n") + (big ? "1.0" : "-1.0") + "\n" + floats(lower, big) + floats(upper, big));
        const Frame frame = read_picture(folder / "a.pfm");
        EXPECT_THAT(frame.at("R"), ElementsAre(7, 10, 1, 4));
        EXPECT_THAT(frame.at("B"), ElementsAre(9, 12, 3, 6));
        EXPECT_THAT(frame.notes, IsEmpty());
    }
}

TEST(PfmTest, GreyAndScale) {
    const Folder folder;
    test::put(folder / "a.pfm", "Pf 3 1 -0.5\n" + floats({2, 4, -6}, false));
    const Frame frame = read_pfm(folder / "a.pfm");
    for (const char* c : {"R", "G", "B"}) EXPECT_THAT(frame.at(c), ElementsAre(1, 2, -3));
    EXPECT_THAT(frame.notes, ElementsAre(HasSubstr("its scale 0.5"), HasSubstr("grey")));
}

TEST(PfmTest, SaysWhatIsWrong) {
    const Folder folder;
    const auto said = [&](const std::string& bytes) {
        test::put(folder / "a.pfm", bytes);
        return error_of([&] { read_pfm(folder / "a.pfm"); }).line();
    };
    EXPECT_THAT(said("PF\n2 2\n-1.0\n" + std::string(47, 'x')), HasSubstr("1 bytes are missing"));
    EXPECT_THAT(said("PF\n2 2\n0\n" + std::string(48, 'x')), HasSubstr("scale 0"));
    EXPECT_THAT(said("PF\n99999 99999\n-1\n"), HasSubstr("99999 x 99999"));
    EXPECT_THAT(said("PF\n16384 16384\n-1\n"), HasSubstr("bytes are missing"));
    EXPECT_THAT(said("PF\n-2 2\n-1\n"), HasSubstr("-2 x 2"));
    EXPECT_THAT(said("PF\n2\n"), HasSubstr("no PFM"));
    EXPECT_THAT(said("P6\n2 2\n1\n"), HasSubstr("no PFM"));
}

} // namespace
} // namespace clvr

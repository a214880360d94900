// The histogram as text.
#include "host/cli/text_chart.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace clvr {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

TEST(HistogramChart, TallestBarFillsAllRowsAndASingleVoxelIsSeen) {
    std::vector<std::uint64_t> bins(1024);
    bins[0] = 1000000;
    bins[1023] = 1;
    const auto lines = lines_of(histogram_chart(bins, -100, 300, 0));
    ASSERT_EQ(lines.size(), 10u); // caption, 8 rows, numbers
    EXPECT_NE(lines[0].find("1000000"), std::string::npos);
    for (int row = 1; row <= 8; ++row) EXPECT_EQ(lines[row].rfind("  █", 0), 0u) << lines[row];
    EXPECT_EQ(lines[7].find_first_not_of(" █"), std::string::npos);
    EXPECT_EQ(lines[8], "  █" + std::string(62, ' ') + "▃"); // 64 eighths x log(2) / log(1000001)
    EXPECT_NE(lines[9].find("-100"), std::string::npos);
    EXPECT_NE(lines[9].find("100 "), std::string::npos);
    EXPECT_NE(lines[9].find("300"), std::string::npos);
}

TEST(HistogramChart, FewValuesHaveWideBars) {
    std::vector<std::uint64_t> bins(1024);
    bins[0] = bins[1023] = 5;
    const auto lines = lines_of(histogram_chart(bins, 0, 1, 2));
    std::string full = "  ";
    for (int i = 0; i < 64; ++i) full += "█";
    EXPECT_EQ(lines[1], full);
}

TEST(HistogramChart, EmptyAndConstantVolumesAreDrawn) {
    EXPECT_EQ(lines_of(histogram_chart(std::vector<std::uint64_t>(1024), 0, 0, 0)).size(), 10u);
    std::vector<std::uint64_t> bins(1024);
    bins[0] = 7;
    EXPECT_EQ(lines_of(histogram_chart(bins, 3, 3, 1)).size(), 10u);
}

} // namespace
} // namespace clvr

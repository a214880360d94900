#include "host/eval/chart.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace clvr {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(LineChart, DrawsEverySeries) {
    const std::string svg = line_chart("a < b", "epoch", {{"one", {1, 2, 3}}, {"two", {3, std::nan(""), 1}}});
    EXPECT_THAT(svg, AllOf(HasSubstr("a &lt; b"), HasSubstr("one"), HasSubstr("two"), HasSubstr("epoch"), Not(HasSubstr("nan"))));
    // Greatest and smallest value lie a little inside the axes (28 to 236), the middle one between.
    EXPECT_THAT(svg, HasSubstr("56.0,226.5 302.0,132.0 548.0,37.5"));
}

TEST(LineChart, OfOneValueAndOfNone) {
    EXPECT_THAT(line_chart("t", "x", {{"s", {5}}}), AllOf(HasSubstr("302.0,132.0"), Not(HasSubstr("nan")), Not(HasSubstr("inf"))));
    EXPECT_EQ(line_chart("t", "x", {{"s", {}}}), "");
    EXPECT_EQ(line_chart("t", "x", {{"s", {std::nan("")}}}), "");
}

TEST(LineChart, NamesItsPlaces) {
    const std::string svg = line_chart("t", "x", {{"s", {5, 6, 7}}}, false, {"1 spp", "2 & 3", "8 spp"});
    EXPECT_THAT(svg, AllOf(HasSubstr(">1 spp<"), HasSubstr(">2 &amp; 3<"), HasSubstr(">8 spp<"), Not(HasSubstr(">3<"))));
}

/// Where the text stands: x of its middle.
double middle(const std::string& svg, const std::string& text) {
    const std::size_t end = svg.find("\" y=", svg.rfind("<text x=\"", svg.find(">" + text + "<")));
    const std::size_t begin = svg.rfind('"', end - 1) + 1;
    return std::stod(svg.substr(begin, end - begin));
}

TEST(LineChart, LabelsStayOnThePicture) {
    const std::string long_name = "256 samples";
    const std::string svg = line_chart("t", "x", {{"s", {5, 6, 7}}}, false, {"a long beginning", "2", long_name});
    EXPECT_LE(middle(svg, long_name) + 11 * 6 / 2, 560);
    EXPECT_GE(middle(svg, "a long beginning") - 16 * 6 / 2, 0);
    EXPECT_DOUBLE_EQ(middle(svg, "2"), 302);
    EXPECT_LE(middle(line_chart("t", "x", {{"s", {5, 6}}}, false, {"1 spp", "16 spp"}), "16 spp") + 6 * 6 / 2, 560);
}

TEST(LineChart, LongNamesInTheLegendAreCut) {
    const std::string name(200, 'n');
    const std::string svg = line_chart("t", "x", {{name, {5}}, {"caf\u00e9", {6}}, {"c", {7}}});
    EXPECT_THAT(svg, AllOf(Not(HasSubstr(std::string(30, 'n'))), HasSubstr("nn\u2026<"), HasSubstr(">caf\u00e9<")));
}

TEST(LineChart, Logarithmic) {
    const std::string svg = line_chart("t", "x", {{"s", {0.01, 0.1, 1}}}, true);
    EXPECT_THAT(svg, AllOf(HasSubstr(">0.01<"), HasSubstr(">0.1<"), HasSubstr(",132.0")));
    EXPECT_THAT(line_chart("t", "x", {{"s", {-1, 1}}}, true), HasSubstr(">0<")); // cannot be: linear
}

} // namespace
} // namespace clvr

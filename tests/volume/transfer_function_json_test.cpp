// Transfer functions from clvr's JSON and from ParaView's, and what is refused.
#include "host/appearance/transfer_function.hpp"
#include "host/frame/srgb.hpp"
#include "runtime/error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace clvr {
namespace {

using ::testing::HasSubstr;

/// The line of the Error{input} that `text` causes, empty when it is accepted.
std::string refusal(const std::string& text) {
    try {
        parse_transfer_function(text, "tf.json");
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::input);
        EXPECT_EQ(e.where(), "tf.json");
        EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
        return e.line();
    }
    return {};
}

std::string with_points(const std::string& points) { return R"({"points": [)" + points + "]}"; }

double srgb_formula(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

TEST(SrgbTest, TableIsTheFormula) {
    for (int k = 0; k < 256; ++k) EXPECT_NEAR(srgb_decode(k / 255.0), srgb_formula(k / 255.0), 1e-15) << k;
    for (int k = 0; k <= 10000; ++k) EXPECT_NEAR(srgb_decode(k / 1e4), srgb_formula(k / 1e4), 6e-6) << k;
    EXPECT_EQ(srgb_decode(-1), 0.0);
    EXPECT_EQ(srgb_decode(2), 1.0);
}

TEST(TransferFunctionJsonTest, ReadsColoursAsSrgbUnlessLinear) {
    const std::string points = R"({"value": 300, "color": [0.2, 0.4, 1], "opacity": 0.4})";
    const TransferFunction srgb = parse_transfer_function(with_points(points), "x");
    ASSERT_EQ(srgb.points.size(), 1u);
    EXPECT_FALSE(srgb.normalized);
    EXPECT_EQ(srgb.points[0].value, 300);
    EXPECT_EQ(srgb.points[0].opacity, 0.4);
    EXPECT_NEAR(srgb.points[0].color[1], srgb_formula(0.4), 1e-12);
    const TransferFunction linear =
        parse_transfer_function(R"({"color_space": "linear", "domain": "normalized", "name": "mine", "points": [)" + points + "]}", "x");
    EXPECT_TRUE(linear.normalized);
    EXPECT_EQ(linear.name, "mine");
    EXPECT_EQ(linear.points[0].color, (std::array<double, 3>{0.2, 0.4, 1}));
}

TEST(TransferFunctionJsonTest, RoundTripKeepsEveryBit) {
    TransferFunction tf;
    tf.name = "a \"name\" with\nline and \xc3\xbc";
    tf.normalized = true;
    tf.points = {{0.1, {1.0 / 3, 0x1p-1074, 1}, 0x1.fffffffffffffp-1}, {std::nextafter(0.1, 1), {0, 0.7, 0.1 + 0.2}, 0}};
    const TransferFunction back = parse_transfer_function(to_json(tf), "x");
    EXPECT_EQ(back.name, tf.name);
    EXPECT_EQ(back.normalized, tf.normalized);
    ASSERT_EQ(back.points.size(), tf.points.size());
    for (std::size_t i = 0; i < tf.points.size(); ++i) {
        EXPECT_EQ(back.points[i].value, tf.points[i].value);
        EXPECT_EQ(back.points[i].color, tf.points[i].color);
        EXPECT_EQ(back.points[i].opacity, tf.points[i].opacity);
    }
}

TEST(TransferFunctionJsonTest, RefusalsNameThePlace) {
    EXPECT_THAT(refusal(""), HasSubstr("no valid JSON"));
    EXPECT_THAT(refusal("{\n\"points\": [}"), HasSubstr("line 2"));
    EXPECT_THAT(refusal("3"), HasSubstr("expected an object"));
    EXPECT_THAT(refusal("{}"), HasSubstr("points is missing"));
    EXPECT_THAT(refusal(R"({"points": 7})"), HasSubstr("points is 7; expected a list"));
    EXPECT_THAT(refusal(with_points("")), HasSubstr("empty"));
    EXPECT_THAT(refusal(with_points("[1, 2]")), HasSubstr("points[0] is a list; expected an object"));
    EXPECT_THAT(refusal(with_points(R"({"value": 1, "color": [1, 1, 1]})")), HasSubstr("points[0].opacity is missing"));
    EXPECT_THAT(refusal(with_points(R"({"value": "NaN", "color": [1, 1, 1], "opacity": 1})")),
                HasSubstr("points[0].value is \"NaN\"; expected a number"));
    EXPECT_THAT(refusal(with_points(R"({"value": NaN, "color": [1, 1, 1], "opacity": 1})")), HasSubstr("no valid JSON"));
    EXPECT_THAT(refusal(with_points(R"({"value": 1e999, "color": [1, 1, 1], "opacity": 1})")), HasSubstr("no valid JSON"));
    EXPECT_THAT(refusal(with_points(R"({"value": null, "color": [1, 1, 1], "opacity": 1})")), HasSubstr("points[0].value is null"));
    EXPECT_THAT(refusal(with_points(R"({"value": 1, "color": [1, 1], "opacity": 1})")),
                HasSubstr("points[0].color is a list; expected a list of 3"));
    EXPECT_THAT(refusal(with_points(R"({"value": 1, "color": [1, 1, 255], "opacity": 1})")), HasSubstr("points[0].color"));
    EXPECT_THAT(refusal(with_points(R"({"value": 1, "color": [1, 1, true], "opacity": 1})")), HasSubstr("points[0].color"));
    EXPECT_THAT(refusal(with_points(R"({"value": 1, "color": [1, 1, 1], "opacity": 1.5})")), HasSubstr("opacity 1.5 is outside 0..1"));
    EXPECT_THAT(refusal(with_points(R"({"value": 1, "color": [1, 1, 1], "opacity": 1, "colour": 2})")),
                HasSubstr("unknown member \"points[0].colour\""));
    EXPECT_THAT(refusal(with_points(R"({"value": 1, "value": 2, "color": [1, 1, 1], "opacity": 1})")), HasSubstr("\"value\" twice"));
    EXPECT_THAT(refusal(with_points(R"({"value": 2, "color": [1, 1, 1], "opacity": 1}, {"value": 1, "color": [1, 1, 1], "opacity": 1})")),
                HasSubstr("point 1: the value 1 comes after 2"));
    EXPECT_THAT(refusal(R"({"domain": "percent", "points": []})"),
                HasSubstr("domain is \"percent\"; expected one of physical, normalized"));
    EXPECT_THAT(refusal(R"({"point": []})"), HasSubstr("points is missing"));
    EXPECT_THAT(refusal(R"({"points": [], "opacities": 1})"), HasSubstr("unknown member \"opacities\""));
    EXPECT_THAT(refusal("\xff\xfe\x00"), HasSubstr("no valid JSON"));
}

TEST(TransferFunctionJsonTest, DeepNestingIsRefusedQuickly) {
    EXPECT_THAT(refusal(std::string(1000000, '[')), HasSubstr("nested deeper"));
    std::string objects;
    for (int i = 0; i < 100000; ++i) objects += "{\"a\":";
    EXPECT_THAT(refusal(objects), HasSubstr("nested deeper"));
}

// ------------------------------------------------------------------------------------------------------------------------ ParaView

/// Colour and opacity at a value, between the points.
TransferFunction::Point at(const TransferFunction& tf, double value) {
    std::size_t i = 1;
    while (i + 1 < tf.points.size() && tf.points[i].value <= value) ++i;
    const auto &a = tf.points[i - 1], &b = tf.points[i];
    const double t = b.value > a.value ? (value - a.value) / (b.value - a.value) : 1;
    TransferFunction::Point p{value, {}, a.opacity + t * (b.opacity - a.opacity)};
    for (int c = 0; c < 3; ++c) p.color[c] = a.color[c] + t * (b.color[c] - a.color[c]);
    return p;
}

TransferFunction paraview(const std::string& space, const std::string& rgb_points, const std::string& points = {}) {
    return parse_transfer_function(R"([{"ColorSpace": ")" + space + R"(", "Name": "map", "NanColor": [1, 0, 0], "RGBPoints": [)" +
                                       rgb_points + "]" + (points.empty() ? "" : ", \"Points\": [" + points + "]") + "}]",
                                   "x");
}

TEST(ParaViewTest, ReadsAnExport) {
    const TransferFunction tf = paraview("RGB", "-1000, 0, 0, 0,  0, 1, 0, 0,  2000, 1, 1, 1", "-1000, 0, 0.5, 0, 2000, 0.6, 0.5, 0");
    EXPECT_EQ(tf.name, "map");
    EXPECT_FALSE(tf.normalized);
    EXPECT_EQ(tf.points.front().value, -1000);
    EXPECT_EQ(tf.points.back().value, 2000);
    EXPECT_NEAR(at(tf, 500).opacity, 0.3, 1e-12);
    EXPECT_NEAR(at(tf, -500).color[0], srgb_formula(0.5), 2e-3); // between sRGB values, in short straight pieces
    EXPECT_NEAR(at(tf, 1000).color[1], srgb_formula(0.5), 2e-3);
}

TEST(ParaViewTest, WithoutOpacitiesTheyRise) {
    const TransferFunction tf = paraview("RGB", "0, 0, 0, 0, 1, 1, 1, 1");
    EXPECT_TRUE(tf.normalized) << "a map over exactly 0..1 is fitted to the data";
    EXPECT_NEAR(at(tf, 0.25).opacity, 0.25, 1e-12);
}

TEST(ParaViewTest, MidpointAndSharpnessAreThoseOfVtk) {
    const auto opacity = [&](const std::string& points, double x) {
        return at(paraview("RGB", "0, 1, 1, 1, 10, 1, 1, 1", points), x).opacity;
    };
    EXPECT_NEAR(opacity("0, 0, 0.2, 0, 10, 1, 0.5, 0", 2), 0.5, 1e-12);  // half way at the midpoint
    EXPECT_NEAR(opacity("0, 0, 0.2, 0, 10, 1, 0.5, 0", 6), 0.75, 1e-12); // and linear beyond
    EXPECT_NEAR(opacity("0, 0, 0.5, 1, 10, 1, 0.5, 0", 4.99), 0, 1e-12); // a step
    EXPECT_NEAR(opacity("0, 0, 0.5, 1, 10, 1, 0.5, 0", 5.01), 1, 1e-12);
    // Sharpness 0.5 at a quarter of the way: s = 0.5 (2 / 4)^6, then Hermite with slopes (1 - 0.5).
    const double s = 0.5 * std::pow(0.5, 6.0), ss = s * s, sss = ss * s;
    EXPECT_NEAR(opacity("0, 0, 0.5, 0.5, 10, 1, 0.5, 0", 2.5), 3 * ss - 2 * sss + (2 * sss - 3 * ss + s) * 0.5, 1e-12);
    const double odd = 0.5 * std::pow(0.5, 1 + 10 * 0.33), odd2 = odd * odd, odd3 = odd2 * odd; // an exponent that is no whole number
    EXPECT_NEAR(opacity("0, 0, 0.5, 0.33, 10, 1, 0.5, 0", 2.5), 3 * odd2 - 2 * odd3 + (2 * odd3 - 3 * odd2 + odd) * 0.67, 1e-12);
}

TEST(ParaViewTest, ColourSpaces) {
    const std::string red_to_blue = "0, 1, 0, 0, 10, 0, 0, 1";
    // HSV takes the short way over magenta; without wrapping the hue runs from 0 to 240 degrees over green.
    const auto magenta = at(paraview("HSV", red_to_blue), 5).color, green = at(paraview("HSVNoWrap", red_to_blue), 5).color;
    EXPECT_NEAR(magenta[0], 1, 1e-9);
    EXPECT_NEAR(magenta[1], 0, 1e-9);
    EXPECT_NEAR(magenta[2], 1, 1e-9);
    EXPECT_NEAR(green[0], 0, 1e-9);
    EXPECT_NEAR(green[1], 1, 1e-9);
    // The whole interval of a step has its right colour.
    EXPECT_EQ(at(paraview("Step", "0, 1, 0, 0, 10, 0, 0, 1, 20, 0, 1, 0"), 5).color, (std::array<double, 3>{0, 0, 1}));
    // L* = 50 is half way between black and white in Lab: Y = ((50 + 16) / 116)^3.
    const auto grey = at(paraview("Lab", "0, 0, 0, 0, 10, 1, 1, 1"), 5).color;
    for (double c : grey) EXPECT_NEAR(c, std::pow(66.0 / 116, 3), 1e-6);
    // Lab returns its own ends.
    const auto end = at(paraview("Lab", "0, 0.2, 0.5, 0.8, 10, 1, 1, 1"), 0).color;
    EXPECT_NEAR(end[1], srgb_decode(0.5), 1e-9);
    // Diverging passes through near-white between cool and warm, not between two blues.
    const auto middle = at(paraview("Diverging", "0, 0.23, 0.30, 0.75, 10, 0.71, 0.016, 0.15"), 5).color;
    EXPECT_NEAR(middle[0], middle[2], 1e-3);
    EXPECT_GT(middle[1], 0.5);
    const auto blues = at(paraview("Diverging", "0, 0.1, 0.2, 0.8, 10, 0.3, 0.4, 0.9"), 5).color;
    EXPECT_LT(blues[0], blues[2]);
}

TEST(ParaViewTest, Refusals) {
    EXPECT_THAT(refusal("[]"), HasSubstr("empty list"));
    EXPECT_THAT(refusal(R"([{"ColorSpace": "RGB"}])"), HasSubstr("RGBPoints is missing"));
    EXPECT_THAT(refusal(R"([{"RGBPoints": [0, 1, 1]}])"), HasSubstr("4 numbers a point"));
    EXPECT_THAT(refusal(R"([{"RGBPoints": [-1e308, 1, 1, 1, 1e308, 0, 0, 0]}])"), HasSubstr("span is a finite number"));
    EXPECT_THAT(refusal(R"([{"RGBPoints": []}])"), HasSubstr("RGBPoints"));
    EXPECT_THAT(refusal(R"([{"RGBPoints": [0, 1, 1, "a"]}])"), HasSubstr("numbers"));
    EXPECT_THAT(refusal(R"([{"RGBPoints": [0, 1, 1, 255]}])"), HasSubstr("0..1"));
    EXPECT_THAT(refusal(R"([{"RGBPoints": [1, 1, 1, 1, 0, 1, 1, 1]}])"), HasSubstr("ascending"));
    EXPECT_THAT(refusal(R"([{"ColorSpace": "Munsell", "RGBPoints": [0, 1, 1, 1]}])"),
                HasSubstr("ColorSpace is \"Munsell\"; expected one of"));
    EXPECT_THAT(refusal(R"([{"RGBPoints": [0, 1, 1, 1], "Points": [0, 2, 0.5, 0]}])"), HasSubstr("Points"));
}

// ------------------------------------------------------------------------------------------------------------------------- presets

TEST(TransferPresetTest, EveryPresetIsSoundAndDescribed) {
    const auto presets = transfer_presets();
    EXPECT_GE(presets.size(), 8u);
    for (const Preset& preset : presets) {
        SCOPED_TRACE(preset.name);
        EXPECT_FALSE(preset.description.empty());
        const TransferFunction tf = transfer_preset(preset.name); // the file's name is the preset's
        EXPECT_EQ(tf.name, preset.name);
        EXPECT_GE(tf.points.size(), 2u);
        double least = 1, greatest = 0;
        for (const auto& p : tf.points) least = std::min(least, p.opacity), greatest = std::max(greatest, p.opacity);
        EXPECT_EQ(least, 0) << "air vanishes";
        EXPECT_GT(greatest, 0.3);
    }
    for (const char* name : {"ct-bone", "ct-soft-tissue", "ct-angio", "ct-lung", "mr", "generic"})
        EXPECT_NO_THROW(transfer_preset(name)) << name;
}

TEST(TransferPresetTest, AnUnknownOneListsTheNames) {
    try {
        transfer_preset("ct-bones");
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::usage);
        EXPECT_THAT(e.line(), HasSubstr("ct-bone, "));
    }
}

} // namespace
} // namespace clvr

// JSON as clvr writes it.
#include "runtime/system/json_text.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace clvr {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

TEST(JsonText, NumbersOfAnArrayShareALine) {
    const ordered_json value{{"name", "head"},
                             {"dims", {4, 5, 6}},
                             {"direction", {{1.5, 0, 0}, {0, 1, 0}}},
                             {"axes", {"R->L", "A->P"}},
                             {"plans", {{{"device", "cpu"}, {"fits", true}}}},
                             {"none", nullptr},
                             {"empty", json::array()},
                             {"nothing", json::object()}};
    EXPECT_EQ(json_text(value), R"({
  "name": "head",
  "dims": [4, 5, 6],
  "direction": [
    [1.5, 0, 0],
    [0, 1, 0]
  ],
  "axes": ["R->L", "A->P"],
  "plans": [
    {
      "device": "cpu",
      "fits": true
    }
  ],
  "none": null,
  "empty": [],
  "nothing": {}
}
)");
    EXPECT_EQ(ordered_json::parse(json_text(value)), value);
}

TEST(JsonText, AThousandNumbersAreOneLine) {
    json value;
    for (int i = 0; i < 1000; ++i) value["histogram"].push_back(i * 1e6 + 0.25);
    const std::string text = json_text(value);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
    EXPECT_EQ(json::parse(text), value);
}

TEST(JsonText, LongTextsHaveLinesOfTheirOwn) {
    const json value{std::string(90, 'x'), std::string(90, 'y')};
    EXPECT_EQ(json_text(value), "[\n  \"" + std::string(90, 'x') + "\",\n  \"" + std::string(90, 'y') + "\"\n]\n");
}

TEST(JsonText, WhatIsHardToWrite) {
    const json value{{"quote \" \\ \n\x01", "\xff\xfe no UTF-8"}, {"\xff", 1}, {"infinite", std::numeric_limits<double>::infinity()}};
    const json back = json::parse(json_text(value));
    EXPECT_EQ(back.at("quote \" \\ \n\x01"), "\xef\xbf\xbd\xef\xbf\xbd no UTF-8");
    EXPECT_TRUE(back.at("infinite").is_null());
    EXPECT_EQ(back.size(), 3u);
    for (const json& scalar : {json(1), json("a"), json(true), json()}) EXPECT_EQ(json::parse(json_text(scalar)), scalar);
}

} // namespace
} // namespace clvr

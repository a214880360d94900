// What a page may say, and what is refused.
#include "host/view/limits.hpp"
#include "host/view/messages.hpp"
#include "tests/io/frames.hpp"

#include <gmock/gmock.h>

namespace clvr::view {
namespace {

using test::error_of;
using testing::HasSubstr;

template <class T>
T parsed(const std::string& text) {
    return std::get<T>(parse_message(text));
}

TEST(Messages, AreReadAsTheyAreMeant) {
    const auto hello = parsed<Hello>(R"({"type":"hello","token":"ab","role":"control"})");
    EXPECT_EQ(hello.token, "ab");
    EXPECT_EQ(hello.role, Role::control);
    EXPECT_EQ(parsed<Hello>(R"({"type":"hello","token":""})").role, Role::watch);
    const auto scene = parsed<SceneChange>(R"({"type":"scene","generation":7,"scene":{"spp":4}})");
    EXPECT_EQ(scene.generation, 7u);
    EXPECT_EQ(scene.scene, R"({"spp":4})");
    EXPECT_EQ(parsed<Ack>(R"({"type":"ack","number":4294967295})").number, 4294967295u);
    EXPECT_TRUE(parsed<Pause>(R"({"type":"pause","paused":true})").paused);
    parsed<TakeControl>(R"({"type":"take_control"})");
    const auto pick = parsed<Pick>(R"({"type":"pick","id":9007199254740991,"x":0,"y":1})");
    EXPECT_EQ(pick.id, greatest_count);
    EXPECT_EQ(pick.y, 1);
    EXPECT_EQ(parsed<TransferText>(R"({"type":"transfer_text","id":1,"text":"x"})").text, "x");
    EXPECT_EQ(parsed<SceneText>(R"({"type":"scene_text","id":1,"text":"{"})").text, "{");
    EXPECT_EQ(parsed<TimeStep>(R"({"type":"time_step","step":3})").step, 3);
    EXPECT_EQ(parsed<Cancel>(R"({"type":"cancel","job":"3"})").job, "3");
}

TEST(Messages, SavesHaveTheSceneSizeUnlessTheySayMore) {
    const auto plain = parsed<Save>(R"({"type":"save","id":1,"what":"still"})");
    EXPECT_EQ(plain.what, Product::still);
    EXPECT_EQ(plain.format, "png");
    EXPECT_FALSE(plain.width || plain.height || plain.samples);
    const auto full =
        parsed<Save>(R"({"type":"save","id":1,"what":"turntable","format":"jpg","width":4096,"height":1,"samples":65536,"views":720})");
    EXPECT_EQ(full.what, Product::turntable);
    EXPECT_EQ(full.width, 4096);
    EXPECT_EQ(full.samples, 65536);
    EXPECT_EQ(full.views, 720);
}

struct Refused {
    const char* text;
    const char* what;
};

TEST(Messages, OfAnyOtherFormAreRefused) {
    const Refused all[]{
        {"", "no valid JSON"},
        {"[]", "expected an object"},
        {"1", "expected an object"},
        {"{}", "type is missing"},
        {R"({"type":1})", "expected a text"},
        {R"({"type":"shutdown"})", "expected one of hello"},
        {R"({"type":"ack","number":1} x)", "no valid JSON"},
        {R"({"type":"ack","type":"ack","number":1})", "twice"},
        {R"({"type":"ack","number":1,"more":2})", "unknown member"},
        {R"({"type":"ack"})", "number is missing"},
        {R"({"type":"ack","number":-1})", "0 or more"},
        {R"({"type":"ack","number":1.5})", "whole number"},
        {R"({"type":"ack","number":4294967296})", "number of a picture"},
        {R"({"type":"ack","number":"1"})", "whole number"},
        {R"({"type":"ack","number":NaN})", "no valid JSON"},
        {R"({"type":"scene","generation":9007199254740992,"scene":{}})", "2^53"},
        {R"({"type":"scene","generation":1,"scene":[]})", "an object"},
        {R"({"type":"pick","id":1,"x":1.001,"y":0})", "from 0 to 1"},
        {R"({"type":"pick","id":1,"x":-0.1,"y":0})", "from 0 to 1"},
        {R"({"type":"pick","id":1,"x":1e999,"y":0})", "no valid JSON"},
        {R"({"type":"pick","id":1,"x":null,"y":0})", "a number"},
        {R"({"type":"pause","paused":1})", "true or false"},
        {R"({"type":"time_step","step":3000000000})", "whole numbers"},
        {R"({"type":"save","id":1,"what":"everything"})", "expected one of still"},
        {R"({"type":"save","id":1,"what":"still","format":"../x"})", "expected one of png"},
        {R"({"type":"save","id":1,"what":"still","width":4097})", "1 to 4096"},
        {R"({"type":"save","id":1,"what":"still","height":0})", "1 to 4096"},
        {R"({"type":"save","id":1,"what":"still","samples":65537})", "1 to 65536"},
        {R"({"type":"save","id":1,"what":"turntable","views":721})", "1 to 720"},
        {R"({"type":"hello","token":["a"]})", "a text"},
        {R"({"type":"hello","token":"a","role":"root"})", "control, watch"},
    };
    for (const Refused& refused : all) {
        const Error e = error_of([&] { parse_message(refused.text); });
        EXPECT_EQ(e.kind(), ErrorKind::input) << refused.text;
        EXPECT_THAT(e.line(), HasSubstr(refused.what)) << refused.text;
    }
}

TEST(Messages, MustNotBeDeep) {
    const std::string deep = R"({"type":"scene","generation":1,"scene":{"a":)" + std::string(30000, '[') + std::string(30000, ']') + "}}";
    EXPECT_THAT(error_of([&] { parse_message(deep); }).line(), HasSubstr("nested deeper"));
}

TEST(Messages, HaveNames) {
    EXPECT_STREQ(name_of(Role::watch), "watch");
    EXPECT_STREQ(name_of(Product::turntable), "turntable");
}

} // namespace
} // namespace clvr::view

// What one client is sent, and what not.
#include "host/view/client_queue.hpp"

#include <gtest/gtest.h>

namespace clvr::view {
namespace {

std::shared_ptr<const std::string> text(const std::string& t) { return std::make_shared<const std::string>(t); }
std::shared_ptr<const EncodedPicture> picture(std::uint32_t number) {
    return std::make_shared<const EncodedPicture>(EncodedPicture{number, "picture " + std::to_string(number)});
}
std::string next(ClientQueue& queue) {
    const auto out = queue.next();
    return out ? *out->bytes : "";
}

TEST(ClientQueue, SendsTwoPicturesAheadAndThenTheNewest) {
    ClientQueue queue;
    for (std::uint32_t n : {1, 2}) {
        queue.picture(picture(n));
        EXPECT_EQ(next(queue), "picture " + std::to_string(n));
    }
    for (std::uint32_t n = 3; n <= 90; ++n) {
        queue.picture(picture(n));
        EXPECT_EQ(next(queue), "");
    }
    queue.acknowledge(1);
    EXPECT_EQ(next(queue), "picture 90"); // the settled one: nothing follows, and it is there
    EXPECT_EQ(next(queue), "");
}

TEST(ClientQueue, AcknowledgedAreThoseBefore) {
    ClientQueue queue;
    for (std::uint32_t n : {1, 2}) queue.picture(picture(n)), next(queue);
    queue.acknowledge(2);
    for (std::uint32_t n : {3, 4}) {
        queue.picture(picture(n));
        EXPECT_EQ(next(queue), "picture " + std::to_string(n));
    }
}

TEST(ClientQueue, NumbersThatWereNotSentChangeNothing) {
    ClientQueue queue;
    for (std::uint32_t n : {1, 2, 3}) queue.picture(picture(n)), next(queue);
    for (std::uint32_t n : {0u, 3u, 77u, 4294967295u}) queue.acknowledge(n);
    EXPECT_EQ(next(queue), "");
    queue.acknowledge(1);
    queue.acknowledge(1);
    EXPECT_EQ(next(queue), "picture 3");
    queue.picture(picture(4));
    EXPECT_EQ(next(queue), "");
}

TEST(ClientQueue, TextsComeFirstAndInOrder) {
    ClientQueue queue;
    queue.picture(picture(1));
    queue.text(text("a"));
    queue.text(text("b"));
    EXPECT_TRUE(queue.texts_wait());
    EXPECT_EQ(next(queue), "a");
    EXPECT_EQ(next(queue), "b");
    EXPECT_FALSE(queue.texts_wait());
    const auto out = queue.next();
    EXPECT_TRUE(out && out->binary);
}

TEST(ClientQueue, OfOneKeyTheNewestTextWaits) {
    ClientQueue queue;
    for (int i = 0; i < 10000; ++i) queue.text(text("progress " + std::to_string(i)), "job 1");
    queue.text(text("scene"), "scene");
    EXPECT_FALSE(queue.overfull());
    EXPECT_EQ(next(queue), "progress 9999");
    EXPECT_EQ(next(queue), "scene");
    EXPECT_EQ(next(queue), "");
}

TEST(ClientQueue, IsOverfullWhenTextsPileUp) {
    ClientQueue many, large;
    for (int i = 0; i < 256; ++i) many.text(text("x"));
    EXPECT_FALSE(many.overfull());
    many.text(text("x"));
    EXPECT_TRUE(many.overfull());
    large.text(text(std::string(5 << 20, 'x')));
    EXPECT_TRUE(large.overfull());
    next(large);
    EXPECT_FALSE(large.overfull());
}

TEST(ClientQueue, PausedItKeepsTheNewest) {
    ClientQueue queue;
    queue.pause(true);
    for (std::uint32_t n : {1, 2, 3}) queue.picture(picture(n));
    queue.text(text("a"));
    EXPECT_EQ(next(queue), "a");
    EXPECT_EQ(next(queue), "");
    queue.pause(false);
    EXPECT_EQ(next(queue), "picture 3");
}

} // namespace
} // namespace clvr::view

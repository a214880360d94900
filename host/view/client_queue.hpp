// What one client has still to be sent. However slowly it reads, it costs bounded memory and delays nobody else.
#pragma once
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace clvr::view {

/// A picture as it is sent: header and encoded pixels.
struct EncodedPicture {
    std::uint32_t number = 0;
    std::string bytes;
};

/// Something to be sent.
struct Outgoing {
    std::shared_ptr<const std::string> bytes;
    bool binary = false;
};

/// Texts in their order, before pictures. Of pictures at most two are under way, sent and not acknowledged; else the newest waits, and
/// those before it are dropped. So the last picture of all, the settled one, always arrives.
class ClientQueue {
public:
    /// A text of the same key that still waits is dropped: it is out of date. An empty key: every text counts.
    void text(std::shared_ptr<const std::string> text, const std::string& key = {});
    void picture(std::shared_ptr<const EncodedPicture> picture);
    /// This picture was drawn, and so were those sent before. A number that was not sent changes nothing.
    void acknowledge(std::uint32_t number);
    /// While paused, the newest picture waits.
    void pause(bool paused) { paused_ = paused; }
    bool texts_wait() const { return !texts_.empty(); }
    /// The next thing to be sent, which counts as sent.
    std::optional<Outgoing> next();
    /// More texts wait than a client that reads at all would leave: it is to be let go.
    bool overfull() const;

private:
    struct Text {
        std::shared_ptr<const std::string> text;
        std::string key;
    };
    std::deque<Text> texts_;
    std::size_t text_bytes_ = 0;
    std::shared_ptr<const EncodedPicture> picture_;
    std::deque<std::uint32_t> under_way_;
    bool paused_ = false;
};

} // namespace clvr::view

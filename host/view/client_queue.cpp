#include "host/view/client_queue.hpp"

#include <algorithm>

namespace clvr::view {

namespace {

constexpr std::size_t most_pictures_under_way = 2, most_texts = 256, most_text_bytes = std::size_t{4} << 20;

} // namespace

void ClientQueue::text(std::shared_ptr<const std::string> text, const std::string& key) {
    const auto former = std::find_if(texts_.begin(), texts_.end(), [&](const Text& t) { return !key.empty() && t.key == key; });
    if (former != texts_.end()) {
        text_bytes_ -= former->text->size();
        texts_.erase(former);
    }
    text_bytes_ += text->size();
    texts_.push_back({std::move(text), key});
}

void ClientQueue::picture(std::shared_ptr<const EncodedPicture> picture) { picture_ = std::move(picture); }

void ClientQueue::acknowledge(std::uint32_t number) {
    const auto drawn = std::find(under_way_.begin(), under_way_.end(), number);
    if (drawn != under_way_.end()) under_way_.erase(under_way_.begin(), drawn + 1);
}

std::optional<Outgoing> ClientQueue::next() {
    if (!texts_.empty()) {
        const Outgoing out{std::move(texts_.front().text), false};
        texts_.pop_front();
        text_bytes_ -= out.bytes->size();
        return out;
    }
    if (!picture_ || paused_ || under_way_.size() >= most_pictures_under_way) return {};
    under_way_.push_back(picture_->number);
    const Outgoing out{std::shared_ptr<const std::string>(picture_, &picture_->bytes), true};
    picture_.reset();
    return out;
}

bool ClientQueue::overfull() const { return texts_.size() > most_texts || text_bytes_ > most_text_bytes; }

} // namespace clvr::view

#include "host/io/volume/byte_source.hpp"

#include <algorithm>
#include <cstring>

namespace clvr {

std::uint64_t ByteSource::skip(std::uint64_t bytes) {
    std::vector<unsigned char> scratch(1 << 16);
    std::uint64_t done = 0;
    while (done < bytes) {
        const std::size_t n = read(scratch.data(), static_cast<std::size_t>(std::min<std::uint64_t>(scratch.size(), bytes - done)));
        if (n == 0) break;
        done += n;
    }
    return done;
}

void read_samples(ByteSource& from, SampleType type, bool swapped, Voxels& v) {
    read_samples([&](void* to, std::size_t bytes) { return from.read(to, bytes); }, type, swapped, v);
}

std::size_t MemoryBytes::read(void* to, std::size_t bytes) {
    const std::size_t n = std::min(bytes, left_.size());
    std::memcpy(to, left_.data(), n);
    left_.remove_prefix(n);
    return n;
}

namespace {
constexpr std::uint64_t small_group = std::uint64_t{1} << 16;
} // namespace

PickedBytes::PickedBytes(ByteSource& from, std::uint64_t block, std::uint64_t count, std::uint64_t index)
    : from_(from), block_(block), count_(count), index_(index), ahead_(index * block) {}

void PickedBytes::fill() {
    const std::uint64_t group = block_ * count_;
    picked_.resize(static_cast<std::size_t>(small_group / group * group));
    const std::size_t groups = from_.read(picked_.data(), picked_.size()) / group;
    for (std::size_t i = 0; i < groups; ++i) std::memmove(&picked_[i * block_], &picked_[i * group + index_ * block_], block_);
    picked_.resize(groups * block_);
    at_ = 0;
}

std::size_t PickedBytes::read_large(unsigned char* to, std::size_t bytes) {
    if (left_ == 0) {
        if (from_.skip(ahead_) < ahead_) return 0;
        ahead_ = (count_ - 1) * block_;
        left_ = block_;
    }
    const std::size_t n = from_.read(to, static_cast<std::size_t>(std::min<std::uint64_t>(left_, bytes)));
    left_ -= n;
    return n;
}

std::size_t PickedBytes::read(void* to, std::size_t bytes) {
    std::size_t done = 0;
    auto* out = static_cast<unsigned char*>(to);
    while (done < bytes) {
        std::size_t n = 0;
        if (block_ * count_ > small_group) {
            n = read_large(out + done, bytes - done);
        } else {
            if (at_ == picked_.size()) fill();
            n = std::min(bytes - done, picked_.size() - at_);
            std::copy_n(picked_.data() + at_, n, out + done);
            at_ += n;
        }
        if (n == 0) break;
        done += n;
    }
    return done;
}

} // namespace clvr

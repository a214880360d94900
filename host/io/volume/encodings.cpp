#include "host/io/volume/encodings.hpp"

#include <algorithm>
#include <bzlib.h>
#include <cctype>
#include <cstring>

namespace clvr {

namespace {

int hex_digit(unsigned char c) {
    if (c >= '0' && c <= '9') return c - '0';
    c = static_cast<unsigned char>(c | 32);
    return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

int base64_digit(unsigned char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

} // namespace

std::size_t HexBytes::read(void* to, std::size_t bytes) {
    std::vector<unsigned char> text(std::min<std::size_t>(1 << 16, 2 * bytes));
    auto* out = static_cast<unsigned char*>(to);
    std::size_t done = 0;
    while (done < bytes) {
        // Never more digits than the bytes that are wanted, so that nothing has to be kept.
        const std::size_t wanted = 2 * (bytes - done) - (high_ >= 0 ? 1 : 0), n = from_.read(text.data(), std::min(text.size(), wanted));
        if (n == 0) break;
        for (std::size_t i = 0; i < n; ++i) {
            if (std::isspace(text[i])) continue;
            const int digit = hex_digit(text[i]);
            if (digit < 0)
                bad_file(path_, "its hexadecimal voxels hold a sign (code {}) that is no digit: the file is damaged", int{text[i]});
            if (high_ >= 0) out[done++] = static_cast<unsigned char>(high_ << 4 | digit);
            high_ = high_ >= 0 ? -1 : digit;
        }
    }
    return done;
}

int Base64Bytes::next_sign() {
    while (true) {
        if (at_ == input_.size()) {
            input_.resize(1 << 16);
            input_.resize(from_.read(input_.data(), input_.size()));
            at_ = 0;
            if (input_.empty()) return -1;
        }
        const unsigned char c = input_[at_++];
        if (!std::isspace(c)) return c;
    }
}

bool Base64Bytes::decode_four() {
    std::uint32_t bits = 0;
    std::size_t digits = 0, signs = 0;
    for (; signs < 4; ++signs) {
        const int c = next_sign();
        const int digit = c < 0 ? -1 : base64_digit(static_cast<unsigned char>(c));
        if (digit < 0 && c != '=') {
            ended_ = true;
            break;
        }
        bits = bits << 6 | static_cast<std::uint32_t>(std::max(digit, 0));
        if (c != '=') ++digits;
    }
    if (signs < 4 || digits < 2) return false;
    decoded_ = {static_cast<unsigned char>(bits >> 16), static_cast<unsigned char>(bits >> 8), static_cast<unsigned char>(bits)};
    decoded_at_ = 0;
    decoded_size_ = digits - 1;
    return true;
}

std::size_t Base64Bytes::read(void* to, std::size_t bytes) {
    auto* out = static_cast<unsigned char*>(to);
    std::size_t done = 0;
    while (done < bytes) {
        if (decoded_at_ == decoded_size_ && (ended_ || !decode_four())) {
            ended_ = true;
            break;
        }
        while (done < bytes && decoded_at_ < decoded_size_) out[done++] = decoded_[decoded_at_++];
    }
    return done;
}

struct Bzip2Bytes::Decoder {
    bz_stream z{};
    std::array<char, 1 << 16> input;
    bool ended = false;

    Decoder() { start(); }
    ~Decoder() { BZ2_bzDecompressEnd(&z); }
    void start() {
        if (BZ2_bzDecompressInit(&z, 0, 0) != BZ_OK) throw Error(ErrorKind::host_memory, "bzip2 cannot start");
    }
};

Bzip2Bytes::Bzip2Bytes(ByteSource& from, std::string path) : from_(from), path_(std::move(path)), decoder_(std::make_unique<Decoder>()) {}
Bzip2Bytes::~Bzip2Bytes() = default;

std::size_t Bzip2Bytes::read(void* to, std::size_t bytes) {
    Decoder& d = *decoder_;
    const auto refill = [&] { // keeps what is left, at the front
        std::memmove(d.input.data(), d.z.next_in, d.z.avail_in);
        d.z.next_in = d.input.data();
        d.z.avail_in += static_cast<unsigned>(from_.read(d.input.data() + d.z.avail_in, d.input.size() - d.z.avail_in));
    };
    d.z.next_out = static_cast<char*>(to);
    d.z.avail_out = static_cast<unsigned>(std::min<std::size_t>(bytes, 1u << 30));
    const std::size_t wanted = d.z.avail_out;
    while (d.z.avail_out > 0 && !d.ended) {
        if (d.z.avail_in == 0) {
            d.z.next_in = d.input.data();
            refill();
            if (d.z.avail_in == 0) bad_file(path_, "the compressed data ends too early: the file is truncated, copy it again");
        }
        const int status = BZ2_bzDecompress(&d.z);
        if (status == BZ_STREAM_END) {
            if (d.z.avail_in < 3) refill();
            d.ended = d.z.avail_in < 3 || std::memcmp(d.z.next_in, "BZh", 3) != 0;
            if (!d.ended) {
                bz_stream left = d.z;
                BZ2_bzDecompressEnd(&d.z);
                d.z = {};
                d.start();
                d.z.next_in = left.next_in, d.z.avail_in = left.avail_in;
                d.z.next_out = left.next_out, d.z.avail_out = left.avail_out;
            }
        } else if (status == BZ_MEM_ERROR) {
            throw Error(ErrorKind::host_memory, "not enough memory to decompress this volume", path_);
        } else if (status != BZ_OK) {
            bad_file(path_, "the compressed data is corrupt ({}): copy or download the file again",
                     status == BZ_DATA_ERROR_MAGIC ? "it does not start as bzip2 does" : "bzip2");
        }
    }
    return wanted - d.z.avail_out;
}

} // namespace clvr

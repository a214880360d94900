// Encodings of bytes inside volume files: hexadecimal digits, base64, bzip2.
#pragma once
#include "host/io/volume/byte_source.hpp"

#include <memory>
#include <string>

namespace clvr {

/// Two hexadecimal digits a byte, blanks anywhere. Throws Error{input} for another sign.
class HexBytes final : public ByteSource {
public:
    HexBytes(ByteSource& from, std::string path) : from_(from), path_(std::move(path)) {}
    std::size_t read(void* to, std::size_t bytes) override;

private:
    ByteSource& from_;
    std::string path_;
    int high_ = -1; ///< the first digit of a byte; -1: none yet
};

/// Base64, blanks anywhere; texts that end in "=" may follow one another. Another sign ends the data.
class Base64Bytes final : public ByteSource {
public:
    explicit Base64Bytes(ByteSource& from) : from_(from) {}
    std::size_t read(void* to, std::size_t bytes) override;

private:
    int next_sign();
    bool decode_four();

    ByteSource& from_;
    std::vector<unsigned char> input_;
    std::size_t at_ = 0;
    std::array<unsigned char, 3> decoded_{};
    std::size_t decoded_at_ = 0, decoded_size_ = 0;
    bool ended_ = false;
};

/// bzip2 streams in a row, each with its checksums. Throws Error{input} for damage and for a missing end.
class Bzip2Bytes final : public ByteSource {
public:
    Bzip2Bytes(ByteSource& from, std::string path);
    ~Bzip2Bytes() override;
    std::size_t read(void* to, std::size_t bytes) override;

private:
    struct Decoder;
    ByteSource& from_;
    std::string path_;
    std::unique_ptr<Decoder> decoder_;
};

} // namespace clvr

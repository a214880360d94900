// Lines, words and bytes of one file in turn: a header of text and what stands behind it.
#pragma once
#include "host/io/volume/byte_source.hpp"

#include <optional>
#include <string>

namespace clvr {

class TextLines final : public ByteSource {
public:
    /// `path` is for messages.
    TextLines(ByteSource& from, std::string path) : from_(from), path_(std::move(path)) {}
    /// The next line without its end ("\n" or "\r\n"); nothing behind the last. Throws Error{input} for one above 64 MiB.
    std::optional<std::string> line();
    /// The next word between blanks or commas, at most 1000 signs of it; empty at the end.
    std::string word();
    std::size_t read(void* to, std::size_t bytes) override;
    std::uint64_t skip(std::uint64_t bytes) override;
    /// Bytes handed out so far, ends of lines included.
    std::uint64_t position() const { return position_; }

private:
    bool fill();

    ByteSource& from_;
    std::string path_, buffer_;
    std::size_t at_ = 0;
    std::uint64_t position_ = 0;
};

/// Numbers written as text, as samples in this machine's byte order.
class TextSamples final : public ByteSource {
public:
    /// `expected` samples in all, for messages and as the end.
    TextSamples(TextLines& from, SampleType type, std::uint64_t expected, std::string path);
    /// `bytes` must be of whole samples. Throws Error{input} for a word that is no number of the type, and for too few numbers.
    std::size_t read(void* to, std::size_t bytes) override;

private:
    TextLines& from_;
    SampleType type_;
    std::uint64_t expected_, done_ = 0;
    std::string path_;
};

} // namespace clvr

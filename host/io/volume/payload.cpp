#include "host/io/volume/payload.hpp"
#include "host/io/volume/encodings.hpp"
#include "host/io/volume/text_lines.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>

namespace clvr {

namespace {

using Encoding = Payload::Encoding;

bool is_compressed(Encoding e) { return e == Encoding::deflated || e == Encoding::bzip2; }

/// One file of a payload: what stands behind line_skip and byte_skip.
class PayloadFile final : public ByteSource {
public:
    /// `share`: bytes of decoded samples that the file holds.
    PayloadFile(const Payload& p, const std::string& path, SampleType type, std::uint64_t share)
        : payload_(p), path_(path), type_(type), share_(share), left_(share) {
        const std::uint64_t size = std::filesystem::file_size(path);
        start_ = p.offset;
        if (p.line_skip > 0) pass_lines();
        if (p.byte_skip < 0) {
            const auto behind = static_cast<std::uint64_t>(-(p.byte_skip + 1));
            start_ = size > behind && size - behind >= share ? size - behind - share : size;
        } else if (!is_compressed(p.encoding)) {
            start_ += static_cast<std::uint64_t>(p.byte_skip);
        }
        held_ = size > start_ ? size - start_ : 0;
    }

    /// Throws Error{input} unless the file can hold its share; bzip2, whose ratio has no useful bound, is decoded where that is in doubt.
    void check() {
        constexpr std::uint64_t deflate_ratio = 1032; // the greatest that the format allows
        switch (payload_.encoding) {
        case Encoding::raw:
            return check_capacity(share_, held_, path_);
        case Encoding::hex:
            return check_capacity(share_, held_ / 2, path_);
        case Encoding::text: // a digit and a blank each
            return check_capacity(share_ / sample_bytes(type_), (held_ + 1) / 2, path_);
        case Encoding::deflated:
            return check_capacity(share_, held_ * deflate_ratio, path_);
        case Encoding::bzip2:
            if (share_ > held_ * deflate_ratio) PayloadFile(payload_, path_, type_, share_).finish();
        }
    }

    std::size_t read(void* to, std::size_t bytes) override {
        const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, left_));
        return counted(open().read(to, wanted), wanted);
    }
    std::uint64_t skip(std::uint64_t bytes) override {
        const std::uint64_t wanted = std::min(bytes, left_);
        return counted(open().skip(wanted), wanted);
    }

    /// Reads what is left, so that everything is checked. Throws Error{input} where compressed data holds more than the share.
    void finish() {
        if (left_ > 0) skip(left_);
        if (!is_compressed(payload_.encoding)) return;
        if (const std::uint64_t more = open().skip(UINT64_MAX); more > 0) wrong_size(share_ + more);
    }
    /// Bytes of the file that belong to no voxel.
    std::uint64_t bytes_behind() const { return payload_.encoding == Encoding::raw && held_ > share_ ? held_ - share_ : 0; }
    std::uint64_t left() const { return left_; }

private:
    void pass_lines() {
        FileBytes file(path_, ByteStream::Coding::plain, start_);
        TextLines lines(file, path_);
        for (std::int64_t i = 0; i < payload_.line_skip; ++i)
            if (!lines.line()) bad_file(path_, "{} lines are to be skipped before its voxels, found {}", payload_.line_skip, i);
        start_ += lines.position();
    }
    [[noreturn]] void wrong_size(std::uint64_t found) const {
        if (is_compressed(payload_.encoding))
            bad_file(path_, "expected {} bytes of voxels, found {} after decompression: the file is damaged or its header is wrong", share_,
                     found);
        bad_file(path_, "expected {} bytes of voxels, found {}: the file is truncated", share_, found);
    }
    template <class N>
    N counted(N n, N wanted) {
        left_ -= n;
        if (n < wanted) wrong_size(share_ - left_);
        return n;
    }
    ByteSource& open() {
        if (top_) return *top_;
        const bool deflated = payload_.encoding == Encoding::deflated;
        file_ = std::make_unique<FileBytes>(path_, deflated ? ByteStream::Coding::deflated : ByteStream::Coding::plain, start_);
        top_ = file_.get();
        if (payload_.encoding == Encoding::bzip2) decoder_ = std::make_unique<Bzip2Bytes>(*file_, path_);
        if (payload_.encoding == Encoding::hex) decoder_ = std::make_unique<HexBytes>(*file_, path_);
        if (payload_.encoding == Encoding::text) {
            lines_ = std::make_unique<TextLines>(*file_, path_);
            decoder_ = std::make_unique<TextSamples>(*lines_, type_, share_ / sample_bytes(type_), path_);
        }
        if (decoder_) top_ = decoder_.get();
        if (is_compressed(payload_.encoding)) top_->skip(static_cast<std::uint64_t>(payload_.byte_skip));
        return *top_;
    }

    const Payload& payload_;
    std::string path_;
    SampleType type_;
    std::uint64_t share_, left_, start_ = 0, held_ = 0;
    std::unique_ptr<ByteSource> file_, decoder_;
    std::unique_ptr<TextLines> lines_;
    ByteSource* top_ = nullptr;
};

/// The files of a payload as one source; each is closed when its share is read.
class PayloadBytes final : public ByteSource {
public:
    PayloadBytes(const Payload& p, SampleType type, std::uint64_t share) : payload_(p), type_(type), share_(share) {}
    std::size_t read(void* to, std::size_t bytes) override {
        return static_cast<std::size_t>(each(
            bytes, [&](std::uint64_t done) { return file_->read(static_cast<char*>(to) + done, bytes - static_cast<std::size_t>(done)); }));
    }
    std::uint64_t skip(std::uint64_t bytes) override {
        return each(bytes, [&](std::uint64_t done) { return file_->skip(bytes - done); });
    }
    void finish() { skip(UINT64_MAX); }

private:
    template <class F>
    std::uint64_t each(std::uint64_t bytes, const F& take) {
        std::uint64_t done = 0;
        while (done < bytes) {
            if (!file_ && next_ == payload_.files.size()) break;
            if (!file_) file_ = std::make_unique<PayloadFile>(payload_, payload_.files[next_++], type_, share_);
            done += take(done);
            if (file_->left() > 0) continue;
            file_->finish();
            file_.reset();
        }
        return done;
    }

    const Payload& payload_;
    SampleType type_;
    std::uint64_t share_;
    std::size_t next_ = 0;
    std::unique_ptr<PayloadFile> file_;
};

} // namespace

void read_payload(const Payload& p, SampleType type, const std::vector<OtherAxis>& others, Voxels& v) {
    const FileDims dims{v.dims[0], v.dims[1], v.dims[2]};
    std::int64_t copies = 1;
    for (const OtherAxis& a : others) { // each product is checked before the next
        check_dims(dims, a.size, type, v.source);
        copies = static_cast<std::int64_t>(check_dims({copies, 1, 1}, a.size, SampleType::u8, v.source).bytes);
    }
    const std::uint64_t bytes = check_dims(dims, copies, type, v.source).bytes, files = p.files.size();
    if (files == 0 || bytes / sample_bytes(type) % files != 0)
        bad_file(v.source, "its {} voxels do not fit {} files of equal size", bytes / sample_bytes(type), files);
    const std::uint64_t share = bytes / files;
    std::uint64_t behind = 0;
    for (const std::string& path : p.files) {
        PayloadFile file(p, path, type, share);
        file.check();
        if (file.bytes_behind() > 0 && behind == 0 && p.byte_skip >= 0) {
            behind = file.bytes_behind();
            v.notes.push_back(fmt::format("{} bytes after the voxels were ignored: is the header right?", behind));
        }
    }
    PayloadBytes source(p, type, share);
    std::vector<std::unique_ptr<PickedBytes>> picked;
    ByteSource* top = &source;
    for (const OtherAxis& a : others) {
        if (a.size == 1) continue;
        picked.push_back(std::make_unique<PickedBytes>(*top, static_cast<std::uint64_t>(a.faster) * sample_bytes(type),
                                                       static_cast<std::uint64_t>(a.size), static_cast<std::uint64_t>(a.index)));
        top = picked.back().get();
    }
    const bool text = p.encoding == Encoding::text; // decoded to this machine's byte order
    read_samples(*top, type, !text && must_swap(p.big_endian), v);
    if (p.encoding != Encoding::raw) source.finish();
}

} // namespace clvr

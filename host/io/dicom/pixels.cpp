#include "host/io/dicom/pixels.hpp"
#include "host/io/dicom/codecs.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gdcmDataElement.h>
#include <gdcmFragment.h>
#include <gdcmImage.h>
#include <gdcmSequenceOfFragments.h>
#include <gdcmTrace.h>

namespace clvr {

namespace {

bool same_picture(const DicomFrame& a, const DicomFrame& b) { return a.image == b.image && a.number == b.number; }

template <class T>
void mark(const unsigned char* pixels, std::size_t n, const DicomPadding& padding, std::vector<bool>& marks) {
    for (std::size_t i = 0; i < n; ++i, pixels += sizeof(T)) {
        T value;
        std::memcpy(&value, pixels, sizeof value);
        if (static_cast<double>(value) >= padding.low && static_cast<double>(value) <= padding.high) marks[i] = true;
    }
}

/// Bits around the stored ones are not of the value (old files keep overlays there): cut off, or filled with the sign.
template <class T>
void clean(unsigned char* pixels, std::size_t n, int bits_above, int unused_bits) {
    using U = std::make_unsigned_t<T>;
    for (std::size_t i = 0; i < n; ++i, pixels += sizeof(T)) {
        U bits;
        std::memcpy(&bits, pixels, sizeof bits);
        const T value = static_cast<T>(static_cast<T>(static_cast<U>(bits << bits_above)) >> unused_bits);
        std::memcpy(pixels, &value, sizeof value);
    }
}

/// Cleans a picture and marks its padding. A padding value beyond the stored bits is compared with the whole sample, before cleaning.
template <class T>
void finish(std::vector<unsigned char>& picture, const DicomImage& image, std::vector<bool>& marks) {
    const DicomPixels& p = image.pixels;
    marks.assign(image.padding ? p.count() : 0, false);
    if constexpr (std::is_integral_v<T>) {
        const int unused = p.bits_allocated - p.bits_stored;
        const double range = std::ldexp(1.0, p.bits_stored), lowest = p.is_signed ? -range / 2 : 0;
        const bool fits = image.padding && image.padding->low >= lowest && image.padding->high < lowest + range;
        if (image.padding && !fits) mark<T>(picture.data(), p.count(), *image.padding, marks);
        if (unused > 0) clean<T>(picture.data(), p.count(), p.bits_allocated - 1 - p.high_bit, unused);
    }
    if (image.padding) mark<T>(picture.data(), p.count(), *image.padding, marks);
}

void finish(std::vector<unsigned char>& picture, const DicomImage& image, std::vector<bool>& marks) {
    switch (image.pixels.type()) {
    case SampleType::u8:
        return finish<std::uint8_t>(picture, image, marks);
    case SampleType::i8:
        return finish<std::int8_t>(picture, image, marks);
    case SampleType::u16:
        return finish<std::uint16_t>(picture, image, marks);
    case SampleType::i16:
        return finish<std::int16_t>(picture, image, marks);
    case SampleType::u32:
        return finish<std::uint32_t>(picture, image, marks);
    case SampleType::i32:
        return finish<std::int32_t>(picture, image, marks);
    case SampleType::f32:
        return finish<float>(picture, image, marks);
    default:
        return finish<double>(picture, image, marks);
    }
}

/// One frame by GDCM: it sees the compressed bytes and the format of the pixels, not the file. Runs in the child; false where it fails.
bool decode_fragments(const DicomFrame& frame, std::vector<unsigned char>& to) {
    const DicomImage& s = *frame.image;
    std::string packed;
    for (std::size_t part = s.first_fragment[frame.number]; part < s.first_fragment[frame.number + 1]; ++part) {
        const auto& [offset, size] = s.file.fragments[part];
        ByteStream stream(s.path, ByteStream::Coding::plain, offset);
        std::string fragment(size, '\0');
        stream.read(fragment.data(), fragment.size());
        packed += fragment;
    }
    const auto syntax = gdcm::TransferSyntax::GetTSType(s.file.transfer_syntax.c_str());
    if (packed.empty() || syntax == gdcm::TransferSyntax::TS_END) return false;
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    gdcm::Fragment fragment;
    fragment.SetByteValue(packed.data(), gdcm::VL(static_cast<std::uint32_t>(packed.size())));
    const gdcm::SmartPointer<gdcm::SequenceOfFragments> fragments(new gdcm::SequenceOfFragments);
    fragments->AddFragment(fragment);
    gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010));
    element.SetVR(gdcm::VR::OB);
    element.SetValue(*fragments);

    const DicomPixels& p = s.pixels;
    const auto bits = [](int n) { return static_cast<unsigned short>(n); };
    const unsigned dims[3] = {static_cast<unsigned>(p.columns), static_cast<unsigned>(p.rows), 1};
    gdcm::Image image;
    image.SetNumberOfDimensions(2);
    image.SetDimensions(dims);
    image.SetPixelFormat(gdcm::PixelFormat(1, bits(p.bits_allocated), bits(p.bits_stored), bits(p.bits_stored - 1), p.is_signed));
    image.SetPhotometricInterpretation(p.inverse ? gdcm::PhotometricInterpretation::MONOCHROME1
                                                 : gdcm::PhotometricInterpretation::MONOCHROME2);
    image.SetTransferSyntax(syntax);
    image.SetDataElement(element);
    to.resize(p.bytes());
    return image.GetBufferLength() == to.size() && image.GetBuffer(reinterpret_cast<char*>(to.data()));
}

/// Decodes the compressed slices of `order` into the pipe until one fails, then ends the process.
[[noreturn]] void run_child(const std::vector<const DicomFrame*>& order, int pipe) {
    for (const int crash : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE}) std::signal(crash, SIG_DFL);
    std::signal(SIGPIPE, SIG_DFL); // the parent gave up: end
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO); // codecs and assertions print messages
    try {
        std::vector<unsigned char> pixels;
        const DicomFrame* last = nullptr;
        for (const DicomFrame* f : order) {
            if (last && same_picture(*last, *f)) continue;
            last = f;
            if (!f->image->file.encapsulated) continue;
            if (!decode_fragments(*f, pixels)) _exit(1);
            for (std::size_t done = 0; done < pixels.size();) {
                const ssize_t n = write(pipe, pixels.data() + done, pixels.size() - done);
                if (n < 0 && errno != EINTR) _exit(1);
                if (n > 0) done += static_cast<std::size_t>(n);
            }
        }
    } catch (...) {
        _exit(1);
    }
    _exit(0);
}

} // namespace

DicomPixelReader::DicomPixelReader(std::vector<const DicomFrame*> order) : order_(std::move(order)) {
    for (const DicomFrame* frame : order_) will_read(frame->image->path);
    if (std::any_of(order_.begin(), order_.end(), [](const DicomFrame* f) { return f->image->file.encapsulated; })) start_child();
}

DicomPixelReader::~DicomPixelReader() {
    if (pipe_ >= 0) close(pipe_);
    if (child_ < 0) return;
    kill(child_, SIGKILL);
    while (waitpid(child_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

void DicomPixelReader::start_child() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error(ErrorKind::internal, fmt::format("no pipe: {}", std::strerror(errno)), "DICOM decoder");
    child_ = fork();
    if (child_ == 0) {
        close(ends[0]);
        run_child(order_, ends[1]);
    }
    close(ends[1]);
    pipe_ = ends[0];
    if (child_ < 0) throw Error(ErrorKind::internal, fmt::format("no process: {}", std::strerror(errno)), "DICOM decoder");
}

void DicomPixelReader::read_child(const DicomImage& image) {
    constexpr int patience_ms = 20000;
    for (std::size_t done = 0; done < picture_.size();) {
        pollfd ready{pipe_, POLLIN, 0};
        const int events = poll(&ready, 1, patience_ms);
        const ssize_t n = events > 0 ? ::read(pipe_, picture_.data() + done, picture_.size() - done) : events;
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0)
            bad_file(image.path, "its compressed pixels ({}) {}: they are damaged, or of a variant that is not supported",
                     transfer_syntax_name(image.file.transfer_syntax),
                     events == 0 ? "take more than 20 seconds to decode" : "cannot be decoded");
        done += static_cast<std::size_t>(n);
    }
}

void DicomPixelReader::read_plain(const DicomImage& image, std::size_t number) {
    const DicomFile& file = image.file;
    const std::size_t bytes = picture_.size();
    const auto check = [&](bool whole) {
        if (!whole)
            bad_file(image.path, "expected {} bytes of pixels, found {}: the file is truncated", bytes * image.frames, file.pixel_bytes);
    };
    check(file.pixel_bytes >= bytes * (number + 1));
    const std::uint64_t from = file.pixel_offset + bytes * number;
    if (file.deflated_from != 0) {
        if (inflated_of_ != &image) inflated_ = inflated_data_set(image.path, file.deflated_from);
        inflated_of_ = &image;
        check(inflated_.size() >= from + bytes);
        std::memcpy(picture_.data(), inflated_.data() + from, bytes);
    } else {
        ByteStream stream(image.path, ByteStream::Coding::plain, from);
        check(stream.read(picture_.data(), bytes) == bytes);
    }
    if (must_swap(file.data.big_endian)) swap_samples(picture_.data(), image.pixels.type(), image.pixels.count());
}

void DicomPixelReader::read_picture(const DicomFrame& frame) {
    const DicomImage& image = *frame.image;
    picture_.resize(image.pixels.bytes());
    if (image.file.encapsulated)
        read_child(image);
    else
        read_plain(image, frame.number);
    finish(picture_, image, padding_);
    current_ = &frame;
}

void DicomPixelReader::next(unsigned char* to, std::vector<bool>* padding) {
    const DicomFrame& f = *order_.at(at_++);
    if (!current_ || !same_picture(*current_, f)) read_picture(f);
    const DicomPixels& p = f.image->pixels;
    const auto row = static_cast<std::size_t>(f.columns), all = static_cast<std::size_t>(p.columns);
    if (padding) padding->assign(padding_.empty() ? 0 : f.count(), false);
    for (std::size_t j = 0; j < static_cast<std::size_t>(f.rows); ++j) {
        const std::size_t from = (static_cast<std::size_t>(f.first_row) + j) * all + static_cast<std::size_t>(f.first_column);
        std::memcpy(to + j * row * p.sample_bytes(), picture_.data() + from * p.sample_bytes(), row * p.sample_bytes());
        if (padding && !padding_.empty())
            std::copy_n(padding_.begin() + static_cast<long>(from), row, padding->begin() + static_cast<long>(j * row));
    }
}

} // namespace clvr

#include "host/io/volume/dicom/pixels.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cerrno>
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

/// Bits above the stored ones are not of the value (old files keep overlays there): cut off, or filled with the sign.
template <class T>
void clean(unsigned char* pixels, std::size_t n, int unused_bits) {
    using U = std::make_unsigned_t<T>;
    for (std::size_t i = 0; i < n; ++i, pixels += sizeof(T)) {
        U bits;
        std::memcpy(&bits, pixels, sizeof bits);
        const T value = static_cast<T>(static_cast<T>(static_cast<U>(bits << unused_bits)) >> unused_bits);
        std::memcpy(pixels, &value, sizeof value);
    }
}

void clean(unsigned char* to, std::size_t n, const DicomPixels& p) {
    const int unused = p.bits_allocated - p.bits_stored;
    if (unused == 0) return;
    switch (p.bits_allocated) {
    case 8:
        return p.is_signed ? clean<std::int8_t>(to, n, unused) : clean<std::uint8_t>(to, n, unused);
    case 16:
        return p.is_signed ? clean<std::int16_t>(to, n, unused) : clean<std::uint16_t>(to, n, unused);
    default:
        return p.is_signed ? clean<std::int32_t>(to, n, unused) : clean<std::uint32_t>(to, n, unused);
    }
}

/// One frame by GDCM: it sees the compressed bytes and the format of the pixels, not the file. Runs in the child; false where it fails.
bool decode_fragments(const DicomSlice& s, std::vector<unsigned char>& to) {
    std::string packed;
    for (const auto& [offset, size] : s.file.fragments) {
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
[[noreturn]] void run_child(const std::vector<const DicomSlice*>& order, int pipe) {
    for (const int crash : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE}) std::signal(crash, SIG_DFL);
    std::signal(SIGPIPE, SIG_DFL); // the parent gave up: end
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO); // codecs and assertions talk
    try {
        std::vector<unsigned char> pixels;
        for (const DicomSlice* s : order) {
            if (!s->file.encapsulated) continue;
            if (!decode_fragments(*s, pixels)) _exit(1);
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

DicomPixelReader::DicomPixelReader(std::vector<const DicomSlice*> order) : order_(std::move(order)) {
    for (const DicomSlice* slice : order_) will_read(slice->path);
    if (std::any_of(order_.begin(), order_.end(), [](const DicomSlice* s) { return s->file.encapsulated; })) start_child();
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

void DicomPixelReader::read_child(const DicomSlice& s, unsigned char* to) {
    constexpr int patience_ms = 20000;
    for (std::size_t done = 0; done < s.pixels.bytes();) {
        pollfd ready{pipe_, POLLIN, 0};
        const int events = poll(&ready, 1, patience_ms);
        const ssize_t n = events > 0 ? ::read(pipe_, to + done, s.pixels.bytes() - done) : events;
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0)
            bad_file(
                s.path,
                "GDCM {} its compressed pixels (transfer syntax {}): the file is damaged, or compressed in a way that GDCM does not know",
                events == 0 ? "needs more than 20 seconds for" : "cannot decode", s.file.transfer_syntax);
        done += static_cast<std::size_t>(n);
    }
}

void DicomPixelReader::next(unsigned char* to) {
    const DicomSlice& s = *order_.at(at_++);
    if (s.file.encapsulated) {
        read_child(s, to);
    } else {
        ByteStream stream(s.path, ByteStream::Coding::plain, s.file.pixel_offset);
        if (s.file.pixel_bytes < s.pixels.bytes() || stream.read(to, s.pixels.bytes()) != s.pixels.bytes())
            bad_file(s.path, "expected {} bytes of pixels, found {}: the file is truncated", s.pixels.bytes(), s.file.pixel_bytes);
        const SampleType type = s.pixels.bits_allocated == 8    ? SampleType::u8
                                : s.pixels.bits_allocated == 16 ? SampleType::u16
                                                                : SampleType::u32;
        if (must_swap(s.file.big_endian)) swap_samples(to, type, s.pixels.count());
    }
    clean(to, s.pixels.count(), s.pixels);
}

} // namespace clvr

#include "host/io/volume/dicom/file.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace clvr {

namespace {

constexpr std::uint32_t undefined_length = 0xffffffff;
constexpr std::uint32_t item = 0xfffee000, item_end = 0xfffee00d, sequence_end = 0xfffee0dd;
constexpr std::uint32_t pixel_data = 0x7fe00010, transfer_syntax_tag = 0x00020010;
constexpr std::uint32_t greatest_value = 1024, last_kept_group = 0x0028;

/// What stands before a value.
struct Element {
    std::uint32_t tag = 0, length = 0;
    std::array<char, 2> vr{};
};

class Walker {
public:
    explicit Walker(const std::string& path)
        : path_(path), size_(std::filesystem::file_size(path)), stream_(std::fopen(path.c_str(), "rb"), &std::fclose) {
        if (!stream_) bad_file(path, "cannot be read");
    }

    DicomFile walk() {
        const std::string head = read_head(path_, 132);
        if (head.size() == 132 && head.compare(128, 4, "DICM") == 0) {
            go_to(132);
            read_meta();
        } else {
            guess_syntax(head); // files from before the preamble was required
        }
        while (at_ < size_) {
            const Element e = next_element();
            if (e.tag == pixel_data) {
                read_pixels(e);
                break;
            }
            read_value(e, 0);
        }
        if (!file_.has_pixels && promises_pixels()) damaged("it ends before its pixels");
        return std::move(file_);
    }

private:
    [[noreturn]] void damaged(const char* what) const {
        bad_file(path_, "not sound as DICOM at byte {}: {}; the file is truncated or damaged", at_, what);
    }

    void go_to(std::uint64_t offset) {
        if (offset > size_) damaged("an element reaches beyond the end of the file");
        if (std::fseek(stream_.get(), static_cast<long>(offset), SEEK_SET) != 0) damaged("cannot be read");
        at_ = offset;
    }
    std::string bytes(std::size_t n) {
        std::string b(n, '\0');
        if (std::fread(b.data(), 1, n, stream_.get()) != n) damaged("the file ends within an element");
        at_ += n;
        return b;
    }
    template <class T>
    T integer() {
        const std::string b = bytes(sizeof(T));
        T value = 0;
        for (std::size_t i = 0; i < sizeof(T); ++i)
            value = static_cast<T>(value | static_cast<T>(static_cast<unsigned char>(b[big_ ? sizeof(T) - 1 - i : i])) << (8 * i));
        return value;
    }

    Element next_element() {
        Element e;
        e.tag = std::uint32_t{integer<std::uint16_t>()} << 16;
        e.tag |= integer<std::uint16_t>();
        if (implicit_ || (e.tag >> 16) == 0xfffe) { // items have no type
            e.length = integer<std::uint32_t>();
            return e;
        }
        const std::string vr = bytes(2);
        if (!std::isupper(static_cast<unsigned char>(vr[0])) || !std::isupper(static_cast<unsigned char>(vr[1])))
            damaged("an element has no type");
        std::copy(vr.begin(), vr.end(), e.vr.begin());
        static const std::array<std::string, 13> long_types{"OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC", "UN", "UR", "UT", "UV"};
        if (std::find(long_types.begin(), long_types.end(), vr) == long_types.end()) {
            e.length = integer<std::uint16_t>();
        } else {
            bytes(2);
            e.length = integer<std::uint32_t>();
        }
        return e;
    }

    /// Keeps or passes over a value; walks through sequences of undefined length.
    void read_value(const Element& e, int depth) {
        if (e.length == undefined_length) {
            const bool outer = implicit_;
            implicit_ = implicit_ || e.vr == std::array<char, 2>{'U', 'N'}; // PS3.5, 6.2.2: of unknown type means implicit inside
            walk_sequence(depth + 1);
            implicit_ = outer;
            return;
        }
        if (e.length > size_ - at_) damaged("an element reaches beyond the end of the file");
        if (depth == 0 && e.length <= greatest_value && (e.tag >> 16) <= last_kept_group)
            file_.values[e.tag] = bytes(e.length);
        else
            go_to(at_ + e.length);
    }

    void walk_sequence(int depth) {
        constexpr int deepest = 32;
        if (depth > deepest) damaged("sequences are nested too deep");
        while (true) {
            const Element i = next_element();
            if (i.tag == sequence_end) return;
            if (i.tag != item) damaged("a sequence holds something else than items");
            if (i.length != undefined_length) {
                go_to(at_ + i.length);
                continue;
            }
            for (Element e = next_element(); e.tag != item_end; e = next_element()) read_value(e, depth);
        }
    }

    /// Group 2 is explicit little-endian in every file and names the syntax of the rest.
    void read_meta() {
        while (at_ < size_) {
            const std::uint64_t start = at_;
            const auto group = integer<std::uint16_t>();
            go_to(start);
            if (group != 2) break;
            read_value(next_element(), 0);
        }
        file_.transfer_syntax = file_.text(transfer_syntax_tag);
        const std::string& uid = file_.transfer_syntax;
        if (uid.empty()) damaged("it names no transfer syntax");
        if (uid == "1.2.840.10008.1.2.1.99")
            bad_file(path_, "a deflated data set is not read: convert it, for example with gdcmconv --raw");
        implicit_ = uid == "1.2.840.10008.1.2";
        big_ = file_.big_endian = uid == "1.2.840.10008.1.2.2";
    }

    void guess_syntax(const std::string& head) {
        if (head.size() < 8 || head[0] != '\x08' || head[1] != 0)
            bad_file(path_, "not DICOM: the mark DICM is missing; the file is truncated or something else");
        implicit_ = !std::isupper(static_cast<unsigned char>(head[4])) || !std::isupper(static_cast<unsigned char>(head[5]));
        file_.transfer_syntax = implicit_ ? "1.2.840.10008.1.2" : "1.2.840.10008.1.2.1";
        go_to(0);
    }

    /// Of a CT, MR or PET image; other objects may have no pixels.
    bool promises_pixels() const {
        std::string kind = file_.text(0x00020002);
        if (kind.empty()) kind = file_.text(0x00080016);
        return kind == "1.2.840.10008.5.1.4.1.1.2" || kind == "1.2.840.10008.5.1.4.1.1.4" || kind == "1.2.840.10008.5.1.4.1.1.128";
    }

    void read_pixels(const Element& e) {
        file_.has_pixels = true;
        if (e.length != undefined_length) {
            file_.pixel_offset = at_;
            file_.pixel_bytes = std::min<std::uint64_t>(e.length, size_ - at_); // what is missing is told with the expected size
            return;
        }
        file_.encapsulated = true;
        for (bool table = true;; table = false) {
            const Element i = next_element();
            if (i.tag == sequence_end) return;
            if (i.tag != item || i.length == undefined_length) damaged("compressed pixels hold something else than fragments");
            if (!table) file_.fragments.emplace_back(at_, i.length);
            go_to(at_ + i.length);
        }
    }

    std::string path_;
    std::uint64_t size_ = 0, at_ = 0;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_;
    bool implicit_ = false, big_ = false;
    DicomFile file_;
};

} // namespace

std::string DicomFile::text(std::uint32_t tag) const {
    const auto value = values.find(tag);
    if (value == values.end()) return {};
    const std::string& bytes = value->second;
    return std::string(trimmed(std::string_view(bytes).substr(0, bytes.find('\0'))));
}

std::optional<int> DicomFile::unsigned_short(std::uint32_t tag) const {
    const auto value = values.find(tag);
    if (value == values.end() || value->second.size() < 2) return std::nullopt;
    const auto low = static_cast<unsigned char>(value->second[big_endian ? 1 : 0]),
               high = static_cast<unsigned char>(value->second[big_endian ? 0 : 1]);
    return low | high << 8;
}

std::vector<double> DicomFile::numbers(std::uint32_t tag) const {
    std::string words = text(tag);
    std::replace(words.begin(), words.end(), '\\', ' ');
    return parse_numbers(words).value_or(std::vector<double>{});
}

double DicomFile::number(std::uint32_t tag, double fallback) const {
    const auto values_of = numbers(tag);
    return values_of.empty() ? fallback : values_of.front();
}

DicomFile scan_dicom(const std::string& path) { return Walker(path).walk(); }

} // namespace clvr

#include "host/io/dicom/file.hpp"
#include "host/io/byte_stream.hpp"
#include "host/io/dicom/start.hpp"
#include "host/io/dicom/tags.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>

namespace clvr {

namespace {

constexpr std::uint32_t undefined_length = 0xffffffff;
constexpr DicomTag item = 0xfffee000, item_end = 0xfffee00d, sequence_end = 0xfffee0dd;

/// What stands before a value.
struct Element {
    DicomTag tag = 0;
    std::uint32_t length = 0;
    std::string vr; ///< empty in implicit files
};

/// How many bytes of a value are kept; more are passed over.
std::uint32_t kept_bytes(DicomTag tag) {
    constexpr std::uint32_t short_value = 1024, last_short_group = 0x0028;
    switch (tag) {
    case dicom_tag::lut_data:
        return 1u << 18;
    case dicom_tag::siemens_csa:
    case dicom_tag::grid_offsets:
    case dicom_tag::slice_vector:
        return 1u << 20;
    case dicom_tag::extended_offsets:
        return 1u << 24;
    case dicom_tag::dose_scaling:
    case dicom_tag::real_world_intercept:
    case dicom_tag::real_world_slope:
        return short_value;
    default:
        return (tag >> 16) <= last_short_group ? short_value : 0;
    }
}

/// The sequences whose items are kept.
bool is_kept_sequence(DicomTag tag) {
    using namespace dicom_tag;
    static const std::set<DicomTag> kept{directory_records, mr_echo,        mr_diffusion,   cardiac_synchronization, mr_frame_type,
                                         ct_frame_type,     pet_frame_type, frame_content,  plane_position,          plane_orientation,
                                         temporal_sequence, modality_lut,   pixel_measures, value_transformation,    detectors,
                                         real_world_map,    shared_groups,  frame_groups};
    return kept.count(tag) != 0;
}

class Walker {
public:
    explicit Walker(const std::string& path) : path_(path) { open(); }

    DicomFile walk() {
        const auto start = dicom_start(read_head(path_, 1024));
        if (!start) bad_file(path_, "not DICOM: the mark DICM is missing; the file is truncated or something else");
        go_to(start->offset);
        if (start->has_meta)
            read_meta();
        else
            take_syntax(*start);
        while (at_ < size_) {
            const Element e = next_element();
            if (e.tag == dicom_tag::pixels || e.tag == dicom_tag::float_pixels || e.tag == dicom_tag::double_pixels) {
                read_pixels(e);
                break;
            }
            read_value(e, file_.data, 0);
        }
        if (!file_.has_pixels && promises_pixels()) damaged("it ends before its pixels");
        return std::move(file_);
    }

private:
    [[noreturn]] void damaged(const char* what) const {
        bad_file(path_, "not sound as DICOM at byte {}: {}; the file is truncated or damaged", at_, what);
    }

    void open() {
        size_ = std::filesystem::file_size(path_);
        stream_.reset(std::fopen(path_.c_str(), "rb"));
        if (!stream_) bad_file(path_, "cannot be read");
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
        e.vr = bytes(2);
        if (!std::isupper(static_cast<unsigned char>(e.vr[0])) || !std::isupper(static_cast<unsigned char>(e.vr[1])))
            damaged("an element has no type");
        static const std::set<std::string> long_types{"OB", "OD", "OF", "OL", "OV", "OW", "SQ", "SV", "UC", "UN", "UR", "UT", "UV"};
        if (long_types.count(e.vr) == 0) {
            e.length = integer<std::uint16_t>();
        } else {
            bytes(2);
            e.length = integer<std::uint32_t>();
        }
        return e;
    }

    /// Keeps a value or a sequence in `to`, or passes over it.
    void read_value(const Element& e, DicomElements& to, int depth) {
        const bool kept = is_kept_sequence(e.tag) && (e.vr.empty() || e.vr == "SQ" || e.vr == "UN");
        if (e.length != undefined_length && e.length > size_ - at_) damaged("an element reaches beyond the end of the file");
        if (kept || e.length == undefined_length) {
            const bool outer_implicit = implicit_, outer_big = big_;
            if (e.vr == "UN") implicit_ = true, big_ = false; // PS3.5, 6.2.2: of unknown type means implicit little-endian inside
            const std::uint64_t end = e.length == undefined_length ? undefined_end : at_ + e.length;
            walk_sequence(end, kept ? &to.sequences[e.tag] : nullptr, depth + 1);
            implicit_ = outer_implicit, big_ = outer_big;
        } else if (e.length <= kept_bytes(e.tag)) {
            to.values[e.tag] = bytes(e.length);
        } else {
            go_to(at_ + e.length);
        }
    }

    /// The items up to byte `end`, or to the mark of the sequence's end; into `to`, or passed over where it is null.
    void walk_sequence(std::uint64_t end, std::vector<DicomElements>* to, int depth) {
        constexpr int deepest = 32;
        constexpr std::size_t most_items = std::size_t{1} << 20;
        if (depth > deepest) damaged("sequences are nested too deep");
        while (at_ < end) {
            const Element i = next_element();
            if (i.tag == sequence_end && end == undefined_end) return;
            if (i.tag != item) damaged("a sequence holds something else than items");
            if (++items_ > most_items) damaged("its sequences hold more than a million items");
            if (i.length != undefined_length && (i.length > size_ - at_ || (end != undefined_end && i.length > end - at_)))
                damaged("an item reaches beyond the end of its sequence");
            if (i.length != undefined_length && !to) {
                go_to(at_ + i.length);
                continue;
            }
            DicomElements passed;
            DicomElements& elements = to ? to->emplace_back() : passed;
            elements.big_endian = big_;
            const std::uint64_t item_stop = i.length == undefined_length ? undefined_end : at_ + i.length;
            while (at_ < item_stop) {
                const Element e = next_element();
                if (e.tag == item_end && item_stop == undefined_end) break;
                read_value(e, elements, depth);
            }
            if (item_stop != undefined_end && at_ != item_stop) damaged("an element reaches beyond the end of its item");
            passed = {};
        }
        if (at_ != end) damaged("an item reaches beyond the end of its sequence");
    }

    /// Group 2 is explicit little-endian in every file and names the syntax of the rest.
    void read_meta() {
        while (at_ < size_) {
            const std::uint64_t start = at_;
            const auto group = integer<std::uint16_t>();
            go_to(start);
            if (group != 2) break;
            read_value(next_element(), file_.data, 0);
        }
        const std::string uid = file_.data.text(dicom_tag::transfer_syntax);
        if (uid.empty()) {
            if (at_ == size_) damaged("it names no transfer syntax");
            const std::uint64_t start = at_;
            const std::string head = bytes(std::min<std::uint64_t>(1024, size_ - at_));
            go_to(start);
            return take_syntax(dicom_syntax_of(head));
        }
        file_.transfer_syntax = uid;
        if (uid == deflated_syntax) read_inflated();
        implicit_ = uid == "1.2.840.10008.1.2";
        big_ = file_.data.big_endian = uid == "1.2.840.10008.1.2.2";
    }

    /// From here on the walk goes through the inflated bytes.
    void read_inflated() {
        file_.deflated_from = at_;
        inflated_ = inflated_data_set(path_, at_);
        if (inflated_.empty()) damaged("its deflated data set is empty");
        size_ = inflated_.size();
        stream_.reset(fmemopen(inflated_.data(), inflated_.size(), "rb"));
        if (!stream_) throw Error(ErrorKind::host_memory, "not enough memory for its data set", path_);
        at_ = 0;
    }

    /// For files that do not name it.
    void take_syntax(const DicomStart& start) {
        implicit_ = start.implicit;
        big_ = file_.data.big_endian = start.big_endian;
        file_.transfer_syntax = implicit_ ? "1.2.840.10008.1.2" : big_ ? "1.2.840.10008.1.2.2" : "1.2.840.10008.1.2.1";
    }

    /// Of a CT, MR or PET image; other objects may have no pixels.
    bool promises_pixels() const {
        std::string kind = file_.data.text(dicom_tag::media_class);
        if (kind.empty()) kind = file_.data.text(dicom_tag::sop_class);
        static const std::set<std::string> images{"1.2.840.10008.5.1.4.1.1.2",   "1.2.840.10008.5.1.4.1.1.2.1",
                                                  "1.2.840.10008.5.1.4.1.1.4",   "1.2.840.10008.5.1.4.1.1.4.1",
                                                  "1.2.840.10008.5.1.4.1.1.128", "1.2.840.10008.5.1.4.1.1.130"};
        return images.count(kind) != 0;
    }

    void read_pixels(const Element& e) {
        file_.has_pixels = true;
        file_.float_bits = e.tag == dicom_tag::float_pixels ? 32 : e.tag == dicom_tag::double_pixels ? 64 : 0;
        if (e.length != undefined_length) {
            file_.pixel_offset = at_;
            file_.pixel_bytes = std::min<std::uint64_t>(e.length, size_ - at_); // what is missing is told with the expected size
            return;
        }
        file_.encapsulated = true;
        for (bool table = true;; table = false) {
            const Element i = next_element();
            if (i.tag == sequence_end) break;
            if (i.tag != item || i.length == undefined_length) damaged("compressed pixels hold something else than fragments");
            if (i.length > size_ - at_) damaged("an element reaches beyond the end of the file");
            if (table) {
                for (std::uint32_t n = 0; n < i.length / 4; ++n) file_.frame_offsets.push_back(integer<std::uint32_t>());
                go_to(at_ + i.length % 4);
                continue;
            }
            file_.fragments.emplace_back(at_, i.length);
            go_to(at_ + i.length);
        }
        if (!file_.frame_offsets.empty()) return;
        const auto extended = file_.data.words(dicom_tag::extended_offsets, 4); // of 8 bytes each
        for (std::size_t n = 0; n + 1 < extended.size(); n += 2)
            file_.frame_offsets.push_back(file_.data.big_endian ? std::uint64_t{extended[n]} << 32 | extended[n + 1]
                                                                : std::uint64_t{extended[n + 1]} << 32 | extended[n]);
    }

    static constexpr std::uint64_t undefined_end = ~std::uint64_t{0};
    static constexpr const char* deflated_syntax = "1.2.840.10008.1.2.1.99";
    std::string path_, inflated_;
    std::uint64_t size_ = 0, at_ = 0;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream_{nullptr, &std::fclose};
    bool implicit_ = false, big_ = false;
    std::size_t items_ = 0;
    DicomFile file_;
};

} // namespace

DicomFile scan_dicom(const std::string& path) { return Walker(path).walk(); }

} // namespace clvr

#include "host/io/dicom/image.hpp"
#include "host/io/dicom/codecs.hpp"
#include "host/io/dicom/tags.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

SampleType DicomPixels::type() const {
    return *parse_sample_type(fmt::format("{}{}", is_float ? 'f' : is_signed ? 'i' : 'u', bits_allocated));
}

namespace {

using namespace dicom_tag;

/// A value of an element as the pixels hold it: the sign fills the upper bits.
double pixel_value(std::uint32_t bits, std::size_t bytes, const DicomPixels& p) {
    if (!p.is_signed) return bits;
    if (p.bits_stored < 32 && (bits >> p.bits_stored) == 0) { // written with as many bits as the pixels
        const std::int64_t sign = std::int64_t{1} << (p.bits_stored - 1);
        return static_cast<double>((static_cast<std::int64_t>(bits) ^ sign) - sign);
    }
    return bytes == 2 ? static_cast<double>(static_cast<std::int16_t>(bits)) : static_cast<double>(static_cast<std::int32_t>(bits));
}

std::optional<double> padding_number(const DicomElements& data, const DicomPixels& p, DicomTag whole, DicomTag single, DicomTag wide) {
    if (p.is_float) return p.bits_allocated == 32 ? data.real(single) : data.real(wide);
    const std::string* value = data.bytes(whole);
    const std::size_t bytes = value && value->size() >= 4 ? 4 : 2;
    const auto words = data.words(whole, bytes);
    return words.empty() ? std::nullopt : std::optional(pixel_value(words.front(), bytes, p));
}

std::optional<DicomPadding> padding_of(const DicomElements& data, const DicomPixels& p) {
    const auto value = padding_number(data, p, padding, float_padding, double_padding);
    if (!value || std::isnan(*value)) return std::nullopt;
    const double limit = padding_number(data, p, padding_limit, float_padding_limit, double_padding_limit).value_or(*value);
    return DicomPadding{std::min(*value, limit), std::max(*value, limit)};
}

std::optional<DicomLut> lut_of(const DicomElements& data, const DicomPixels& p, const std::string& path) {
    if (data.sequences.count(modality_lut) == 0) return std::nullopt;
    const DicomElements* item = data.item(modality_lut);
    if (!item) return std::nullopt;
    const auto descriptor = item->words(lut_descriptor, 2);
    const std::string* table = item->bytes(lut_data);
    if (descriptor.size() != 3 || !table) bad_file(path, "its ModalityLUTSequence has no usable LUTDescriptor and LUTData");
    DicomLut lut;
    const std::size_t entries = descriptor[0] == 0 ? 65536 : descriptor[0];
    lut.first = p.is_signed ? static_cast<double>(static_cast<std::int16_t>(descriptor[1])) : static_cast<double>(descriptor[1]);
    lut.bits = static_cast<int>(descriptor[2]);
    if (lut.bits < 8 || lut.bits > 16) bad_file(path, "the entries of its modality table have {} bits: expected 8 to 16", lut.bits);
    if (table->size() == 2 * entries) {
        for (const std::uint32_t word : item->words(lut_data, 2)) lut.values.push_back(static_cast<std::uint16_t>(word));
    } else if (lut.bits == 8 && (table->size() == entries || table->size() == entries + 1)) {
        for (std::size_t i = 0; i < entries; ++i) lut.values.push_back(static_cast<unsigned char>((*table)[i]));
    } else {
        bad_file(path, "its modality table has {} bytes: expected {} entries of {} bits", table->size(), entries, lut.bits);
    }
    if (p.is_float) bad_file(path, "it has a modality table for pixels that are no whole numbers");
    return lut;
}

DicomPixels pixels_of(const DicomFile& file, const std::string& path) {
    const DicomElements& data = file.data;
    DicomPixels p;
    p.rows = data.unsigned_short(rows).value_or(0);
    p.columns = data.unsigned_short(columns).value_or(0);
    const std::string colour = data.text(photometric);
    const int samples = data.unsigned_short(samples_per_pixel).value_or(1);
    if (samples != 1 || (colour != "MONOCHROME2" && colour != "MONOCHROME1" && !colour.empty()))
        bad_file(path, "the pixels are colours ({}, {} samples each): clvr renders scalar volumes", colour, samples);
    p.inverse = colour == "MONOCHROME1";
    if (file.float_bits != 0) {
        p.is_float = true;
        p.bits_allocated = p.bits_stored = file.float_bits;
        p.high_bit = file.float_bits - 1;
        return p;
    }
    p.bits_allocated = data.unsigned_short(bits_allocated).value_or(16);
    p.bits_stored = data.unsigned_short(bits_stored).value_or(p.bits_allocated);
    p.is_signed = data.unsigned_short(pixel_representation).value_or(0) == 1;
    p.high_bit = data.unsigned_short(high_bit).value_or(p.bits_stored - 1);
    if (p.bits_allocated == 1) bad_file(path, "the pixels have 1 bit each (a mask): clvr renders measured values");
    if (file.encapsulated && p.high_bit != p.bits_stored - 1)
        bad_file(path, "compressed pixels of {} bits stored in {}, high bit {}, are not read", p.bits_stored, p.bits_allocated, p.high_bit);
    if ((p.bits_allocated != 8 && p.bits_allocated != 16 && p.bits_allocated != 32) || p.bits_stored < 1 ||
        p.high_bit >= p.bits_allocated || p.high_bit < p.bits_stored - 1)
        bad_file(path, "pixels of {} bits stored in {}, high bit {}, are not read: expected 8, 16 or 32 bits with the value inside",
                 p.bits_stored, p.bits_allocated, p.high_bit);
    return p;
}

/// Which fragments hold which frame: one each, or as the offset table says.
std::vector<std::size_t> first_fragments(const DicomFile& file, std::size_t frames, const std::string& path) {
    const auto& parts = file.fragments;
    std::vector<std::size_t> first;
    if (frames == 1) return {0, parts.size()};
    if (parts.size() == frames) {
        for (std::size_t f = 0; f <= frames; ++f) first.push_back(f);
        return first;
    }
    if (parts.size() < frames)
        bad_file(path, "expected {} compressed frames, found {} pieces: the file is truncated or its header is wrong", frames,
                 parts.size());
    if (file.frame_offsets.size() == frames)
        for (std::size_t f = 0, part = 0; f < frames; ++f) {
            while (part < parts.size() && parts[part].first - parts.front().first < file.frame_offsets[f]) ++part;
            if (part == parts.size() || parts[part].first - parts.front().first != file.frame_offsets[f] || (f > 0 && part <= first.back()))
                bad_file(path, "its offset table does not lead to the {} frames", frames);
            first.push_back(part);
        }
    if (first.empty())
        bad_file(path, "it holds {} frames in {} pieces without an offset table: which piece is whose is not known", frames, parts.size());
    first.push_back(parts.size());
    return first;
}

/// The number of frames, all of which can be in the file.
std::size_t frames_in(const DicomFile& file, const DicomPixels& p, const std::string& path) {
    const double number = file.data.decimal(dicom_tag::frames, "NumberOfFrames", path).value_or(1);
    constexpr double most = 1 << 20;
    if (!(number >= 1) || number > most || number != std::floor(number))
        bad_file(path, "NumberOfFrames is {:g}: expected a whole number from 1 to {:g}", number, most);
    const auto n = static_cast<std::size_t>(number);
    if (n > 1 && !file.encapsulated && file.pixel_bytes / n < p.bytes())
        throw DicomSliceError(ErrorKind::input,
                              fmt::format("expected {} bytes of pixels, found {}: the file is truncated or its header is wrong",
                                          n * p.bytes(), file.pixel_bytes),
                              path);
    return n;
}

bool is_segmentation(const DicomElements& data) {
    return data.text(modality) == "SEG" || data.text(sop_class) == "1.2.840.10008.5.1.4.1.1.66.4";
}

} // namespace

std::optional<DicomImage> image_of(const DicomFile& file, const std::string& path) {
    const DicomElements& data = file.data;
    if (!file.has_pixels || data.unsigned_short(rows).value_or(0) == 0 || data.unsigned_short(columns).value_or(0) == 0)
        return std::nullopt;
    if (is_segmentation(data)) bad_file(path, "the file is a segmentation (a label map): clvr renders measured values, not labels");
    DicomImage image;
    image.path = path;
    image.series = data.text(series_uid);
    image.description = data.text(series_description);
    image.instance_uid = data.text(instance_uid);
    image.modality = data.text(modality);
    image.image_type = data.text(image_type);
    image.instance = data.count(instance_number, 0);
    image.acquisition = data.count(temporal_position, data.count(acquisition_number, 0));
    image.pixels = pixels_of(file, path);
    check_transfer_syntax(file, path);
    image.frames = frames_in(file, image.pixels, path);
    if (file.encapsulated) {
        image.first_fragment = first_fragments(file, image.frames, path);
        std::uint64_t packed = 0;
        for (const auto& [offset, size] : file.fragments) packed += size;
        check_capacity(image.frames * image.pixels.bytes(), packed * greatest_ratio(file.transfer_syntax), path);
    }
    image.padding = padding_of(data, image.pixels);
    image.lut = lut_of(data, image.pixels, path);
    if (image.lut) image.decisions.push_back(fmt::format("values through the modality table of {} entries", image.lut->values.size()));
    return image;
}

} // namespace clvr

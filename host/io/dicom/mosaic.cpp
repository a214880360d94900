#include "host/io/dicom/mosaic.hpp"
#include "host/io/dicom/place.hpp"
#include "host/io/dicom/tags.hpp"
#include "host/io/volume/header_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace clvr {

namespace {

/// The private header of Siemens ("CSA"): named tags with texts, little-endian. Two forms, told apart by the mark SV10.
class CsaHeader {
public:
    explicit CsaHeader(const std::string& bytes) : bytes_(bytes), second_form_(bytes.compare(0, 4, "SV10") == 0) {}

    /// The texts of a tag; empty where it is absent or the header is not sound.
    std::vector<std::string> texts(const std::string& name) const {
        std::size_t at = second_form_ ? 8 : 0;
        const auto tags = word(at);
        at += 8;
        std::int64_t first_items = 0; // the first form counts lengths from here
        constexpr std::int64_t most_tags = 1024, most_items = 1024;
        if (!tags || *tags > most_tags) return {};
        for (std::int64_t tag = 0; tag < *tags; ++tag) {
            const auto items = word(at + 76);
            if (!items || *items < 0 || *items > most_items) return {};
            if (tag == 0) first_items = *items;
            const bool wanted = std::strncmp(bytes_.c_str() + at, name.c_str(), 64) == 0;
            at += 84;
            std::vector<std::string> found;
            for (std::int64_t i = 0; i < *items; ++i) {
                const auto length = word(at + (second_form_ ? 4 : 0));
                if (!length) return {};
                const std::int64_t size = second_form_ ? *length : *length - first_items;
                at += 16;
                if (size < 0) break;
                if (at > bytes_.size() || static_cast<std::uint64_t>(size) > bytes_.size() - at) return {};
                std::string text = bytes_.substr(at, static_cast<std::size_t>(size));
                text = std::string(trimmed(text.substr(0, text.find('\0'))));
                if (!text.empty()) found.push_back(text);
                at += (static_cast<std::size_t>(size) + 3) / 4 * 4;
            }
            if (wanted) return found;
        }
        return {};
    }
    std::vector<double> numbers(const std::string& name) const {
        std::vector<double> all;
        for (const std::string& text : texts(name))
            if (const auto number = parse_numbers(text)) all.insert(all.end(), number->begin(), number->end());
        return all;
    }

private:
    std::optional<std::int64_t> word(std::size_t at) const {
        if (at + 4 > bytes_.size()) return std::nullopt;
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes_[at + i])} << (8 * i);
        return static_cast<std::int32_t>(value);
    }

    const std::string& bytes_;
    bool second_form_;
};

} // namespace

std::optional<DicomMosaic> mosaic_of(const DicomElements& data, const DicomImage& image) {
    const auto types = data.texts(dicom_tag::image_type);
    const bool named = std::find(types.begin(), types.end(), "MOSAIC") != types.end();
    if (!named && lower_case(data.text(dicom_tag::manufacturer)).find("siemens") == std::string::npos) return std::nullopt;
    DicomMosaic mosaic;
    mosaic.images = data.unsigned_short(dicom_tag::siemens_mr_images).value_or(0);
    if (const std::string* bytes = data.bytes(dicom_tag::siemens_csa)) {
        const CsaHeader csa(*bytes);
        const auto images = csa.numbers("NumberOfImagesInMosaic"), normal = csa.numbers("SliceNormalVector");
        if (!images.empty() && images.front() > 0 && images.front() < 65536) mosaic.images = static_cast<int>(images.front());
        if (normal.size() == 3) mosaic.normal = Double3{normal[0], normal[1], normal[2]};
    }
    if (!named && mosaic.images < 2) return std::nullopt;
    if (mosaic.images < 1)
        bad_file(image.path,
                 "the picture is a mosaic (ImageType) but the file does not say of how many slices: its private Siemens header (0029,1010) "
                 "is missing. Convert the original files, or save the series with one slice a file");
    return mosaic;
}

std::vector<DicomFrame> mosaic_slices(const DicomMosaic& mosaic, const DicomFrame& whole, std::optional<double> step) {
    const std::string& path = whole.image->path;
    const int edge = static_cast<int>(std::ceil(std::sqrt(static_cast<double>(mosaic.images))));
    if (whole.columns % edge != 0 || whole.rows % edge != 0)
        bad_file(path, "the picture of {} x {} pixels is no mosaic of {} slices: expected {} tiles a side", whole.columns, whole.rows,
                 mosaic.images, edge);
    if (!step || !(*step > 0) || !std::isfinite(*step))
        bad_file(path, "the mosaic has no SpacingBetweenSlices: how far its {} slices lie apart is not known", mosaic.images);
    DicomFrame slice = whole;
    slice.columns = whole.columns / edge;
    slice.rows = whole.rows / edge;
    const DicomPlace& p = whole.place;
    Double3 normal = normal_of(p);
    if (mosaic.normal) {
        constexpr double parallel = 0.99;
        if (!(std::abs(inner(normal, *mosaic.normal)) > parallel * norm(*mosaic.normal)) || !(norm(*mosaic.normal) > 0.5))
            bad_file(path, "SliceNormalVector {:g} {:g} {:g} of the mosaic is not across its slices", (*mosaic.normal)[0],
                     (*mosaic.normal)[1], (*mosaic.normal)[2]);
        normal = unit(*mosaic.normal);
    }
    // ImagePositionPatient is that of a slice as large as the mosaic around the same centre.
    const Double3 first = p.position + p.row * (0.5 * (whole.columns - slice.columns) * p.spacing_i) +
                          p.column * (0.5 * (whole.rows - slice.rows) * p.spacing_j);
    slice.place.rounding = {0, 0, 0};
    slice.place.thickness = *step;
    std::vector<DicomFrame> slices;
    for (int k = 0; k < mosaic.images; ++k) {
        slice.first_column = k % edge * slice.columns;
        slice.first_row = k / edge * slice.rows;
        slice.place.position = first + normal * (k * *step);
        slices.push_back(slice);
    }
    return slices;
}

} // namespace clvr

#include "host/io/dicom/functional_groups.hpp"
#include "host/io/dicom/image.hpp"
#include "host/io/dicom/mosaic.hpp"
#include "host/io/dicom/place.hpp"
#include "host/io/dicom/tags.hpp"

#include <algorithm>
#include <cmath>

namespace clvr {

namespace {

using namespace dicom_tag;

/// Slope and intercept of all frames, where the data set itself has them.
void read_scale(DicomFrame& frame, const DicomElements& data) {
    const std::string& path = frame.image->path;
    frame.slope = data.decimal(rescale_slope, "RescaleSlope", path).value_or(1);
    frame.intercept = data.decimal(rescale_intercept, "RescaleIntercept", path).value_or(0);
    if (const auto dose = data.decimal(dose_scaling, "DoseGridScaling", path)) frame.slope = *dose, frame.intercept = 0;
}

void read_labels(DicomFrame& frame, const DicomElements& data) {
    const auto keep = [&](const char* name, const std::string& value) {
        if (!value.empty()) frame.labels[name] = value;
    };
    keep("EchoTime", data.text(echo_time));
    keep("EchoNumbers", data.text(echo_number));
    if (const auto b = data.real(b_value)) keep("DiffusionBValue", fmt::format("{:g}", *b));
    keep("ImageType", frame.image->image_type);
}

/// Frames at distances along the normal that the file lists, from its position on (RT dose, PS3.3 C.8.8.3.2).
std::vector<DicomFrame> grid_frames(const DicomElements& data, DicomFrame frame) {
    const DicomImage& image = *frame.image;
    const auto offsets = data.decimals(grid_offsets, "GridFrameOffsetVector", image.path);
    if (offsets.size() != image.frames)
        bad_file(image.path, "GridFrameOffsetVector has {} values for {} frames", offsets.size(), image.frames);
    const Double3 first = frame.place.position, normal = normal_of(frame.place);
    const double start = offsets.front(); // 0, or the list holds coordinates along the patient's z
    if (start != 0 && std::abs(start - first[2]) > 1e-3)
        bad_file(image.path, "GridFrameOffsetVector begins with {:g}: expected 0 or the z of ImagePositionPatient", start);
    frame.place.rounding = {0, 0, 0};
    std::vector<DicomFrame> frames;
    for (std::size_t f = 0; f < offsets.size(); ++f) {
        if (!std::isfinite(offsets[f])) bad_file(image.path, "GridFrameOffsetVector holds {}", offsets[f]);
        frame.number = f;
        frame.place.position = first + normal * (offsets[f] - start);
        frames.push_back(frame);
    }
    return frames;
}

/// Reconstructed slices of nuclear medicine: SliceVector numbers them from 1, SpacingBetweenSlices (signed) is their distance.
std::vector<DicomFrame> nuclear_frames(const DicomElements& data, DicomFrame frame) {
    const DicomImage& image = *frame.image;
    const auto step = data.decimal(slice_distance, "SpacingBetweenSlices", image.path);
    if (!step || *step == 0 || !std::isfinite(*step))
        bad_file(image.path, "the file holds {} slices without SpacingBetweenSlices: how far they lie apart is not known", image.frames);
    const auto numbers = data.words(slice_vector, 2);
    if (!numbers.empty() && numbers.size() != image.frames)
        bad_file(image.path, "SliceVector has {} values for {} frames", numbers.size(), image.frames);
    const Double3 first = frame.place.position, normal = normal_of(frame.place);
    frame.place.rounding = {0, 0, 0};
    frame.place.thickness = std::abs(*step);
    std::vector<DicomFrame> frames;
    for (std::size_t f = 0; f < image.frames; ++f) {
        const double k = numbers.empty() ? static_cast<double>(f) : static_cast<double>(numbers[f]) - 1;
        frame.number = f;
        frame.place.position = first + normal * (k * *step);
        frames.push_back(frame);
    }
    return frames;
}

bool is_reconstructed_nuclear(const DicomElements& data, const DicomImage& image) {
    const auto types = data.texts(image_type);
    return (image.modality == "NM" || image.modality == "PT") &&
           std::any_of(types.begin(), types.end(), [](const std::string& t) { return t.find("RECON") != std::string::npos; });
}

} // namespace

std::vector<DicomFrame> frames_of(DicomFile&& file, const std::string& path) {
    auto header = image_of(file, path);
    if (!header) return {};
    const DicomElements data = std::move(file.data);
    file.data = {};
    file.data.big_endian = data.big_endian;
    header->file = std::move(file);
    const auto image = std::make_shared<DicomImage>(std::move(*header));
    DicomFrame frame;
    frame.image = image;
    frame.columns = image->pixels.columns;
    frame.rows = image->pixels.rows;
    read_scale(frame, data);
    if (image->lut && (frame.slope != 1 || frame.intercept != 0))
        bad_file(path, "the file has both a modality table and a RescaleSlope or RescaleIntercept: which of them holds is not known");
    read_labels(frame, data);

    if (data.item(shared_groups) || data.item(frame_groups)) {
        image->decisions.push_back("places and scales of frames from functional groups");
        return functional_group_frames(data, frame);
    }
    if (const auto mosaic = mosaic_of(data, *image)) {
        frame.place = place_of(data, data, data, path);
        image->decisions.push_back(fmt::format("mosaic of {} slices", mosaic->images));
        if (!mosaic->normal)
            image->notes.push_back("the mosaic does not say in which direction its slices follow each other: row x column is taken");
        return mosaic_slices(*mosaic, frame, data.decimal(slice_distance, "SpacingBetweenSlices", path));
    }
    const DicomElements* detector = data.item(detectors); // of nuclear medicine: holds the place instead
    const DicomElements& where = detector && !data.bytes(position) ? *detector : data;
    if (image->frames == 1) {
        frame.place = place_of(where, where.bytes(orientation) ? where : data, data, path);
        return {frame};
    }
    const bool grid = data.bytes(grid_offsets) != nullptr, nuclear = is_reconstructed_nuclear(data, *image);
    if (!grid && !nuclear)
        bad_file(path,
                 "the file holds {} frames and does not say where each of them lies (films and projections over time do not): it is no "
                 "volume",
                 image->frames);
    frame.place = place_of(where, where.bytes(orientation) ? where : data, data, path);
    image->decisions.push_back(
        fmt::format("places of {} frames from {}", image->frames, grid ? "GridFrameOffsetVector" : "SpacingBetweenSlices"));
    return grid ? grid_frames(data, frame) : nuclear_frames(data, frame);
}

} // namespace clvr

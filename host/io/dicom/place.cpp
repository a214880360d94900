#include "host/io/dicom/place.hpp"
#include "host/io/dicom/tags.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace clvr {

namespace {

/// What the last digit of a number's text is worth: 0.01 for "1.25", 1 for "-7", 100 for "12E2".
double last_digit(const std::string& text) {
    const std::size_t mark = text.find_first_of("eE"), point = text.find('.');
    const std::size_t digits = mark == std::string::npos ? text.size() : mark;
    int power = point < digits ? -static_cast<int>(digits - point - 1) : 0;
    if (mark != std::string::npos) {
        std::string_view exponent = std::string_view(text).substr(mark + 1);
        if (!exponent.empty() && exponent.front() == '+') exponent.remove_prefix(1);
        int e = 0;
        std::from_chars(exponent.data(), exponent.data() + exponent.size(), e);
        power += std::clamp(e, -400, 400);
    }
    return std::pow(10.0, power);
}

/// [mm], for a series of one slice. A text that is no number matters there alone.
double thickness_of(const DicomElements& measures, const std::string& path) {
    try {
        const auto distance = measures.decimal(dicom_tag::slice_distance, "SpacingBetweenSlices", path);
        return distance ? *distance : measures.decimal(dicom_tag::slice_thickness, "SliceThickness", path).value_or(0);
    } catch (const DicomSliceError&) {
        return std::numeric_limits<double>::quiet_NaN();
    }
}

} // namespace

DicomPlace place_of(const DicomElements& at, const DicomElements& orientation, const DicomElements& measures, const std::string& path) {
    DicomPlace p;
    const auto position = at.decimals(dicom_tag::position, "ImagePositionPatient", path),
               directions = orientation.decimals(dicom_tag::orientation, "ImageOrientationPatient", path),
               spacing = measures.decimals(dicom_tag::pixel_spacing, "PixelSpacing", path);
    if (position.size() != 3 || directions.size() != 6)
        bad_file(path,
                 "the slice has no usable ImagePositionPatient and ImageOrientationPatient: it cannot be placed in a volume (pictures of a "
                 "screen, scanned films and single projections have none)");
    if (spacing.size() != 2 || !(spacing[0] > 0) || !(spacing[1] > 0) || !std::isfinite(spacing[0]) || !std::isfinite(spacing[1]))
        bad_file(path, "PixelSpacing is \"{:.40}\": expected two finite numbers above 0", measures.text(dicom_tag::pixel_spacing));
    std::copy_n(position.begin(), 3, p.position.begin());
    std::copy_n(directions.begin(), 3, p.row.begin());
    std::copy_n(directions.begin() + 3, 3, p.column.begin());
    const double row = norm(p.row), column = norm(p.column), angle = norm(cross(p.row, p.column));
    if (!(std::abs(row - 1) < 0.01) || !(std::abs(column - 1) < 0.01) || !(angle > 0.9) || !std::isfinite(norm(p.position)))
        bad_file(path,
                 "ImageOrientationPatient \"{:.80}\" or ImagePositionPatient is not usable: expected two perpendicular unit vectors and a "
                 "finite point",
                 orientation.text(dicom_tag::orientation));
    p.row = unit(p.row);
    p.column = unit(p.column);
    p.spacing_j = spacing[0]; // PixelSpacing is: between rows, between columns
    p.spacing_i = spacing[1];
    p.thickness = thickness_of(measures, path);
    const auto texts = at.texts(dicom_tag::position);
    for (std::size_t i = 0; i < 3; ++i) p.rounding[i] = last_digit(texts[i]);
    return p;
}

Double3 normal_of(const DicomPlace& place) { return unit(cross(place.row, place.column)); }

} // namespace clvr

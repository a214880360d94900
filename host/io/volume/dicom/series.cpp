// DICOM series: compressed pixels by GDCM, headers, grouping and order by clvr (ITK's series reader stretches the spacing over a gap).
#include "host/io/volume/dicom/arrange.hpp"
#include "host/io/volume/dicom/pixels.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

namespace clvr {

namespace {

namespace fs = std::filesystem;

namespace tag {
constexpr std::uint32_t instance_uid = 0x00080018, modality = 0x00080060, series_description = 0x0008103e, slice_thickness = 0x00180050,
                        slice_distance = 0x00180088, series_uid = 0x0020000e, acquisition_number = 0x00200012, instance_number = 0x00200013,
                        position = 0x00200032, orientation = 0x00200037, temporal_position = 0x00200100, samples_per_pixel = 0x00280002,
                        photometric = 0x00280004, frames = 0x00280008, rows = 0x00280010, columns = 0x00280011, pixel_spacing = 0x00280030,
                        bits_allocated = 0x00280100, bits_stored = 0x00280101, high_bit = 0x00280102, pixel_representation = 0x00280103,
                        rescale_intercept = 0x00281052, rescale_slope = 0x00281053;
} // namespace tag

/// Where the slice lies. Throws Error{input} for what cannot be placed.
void read_place(DicomSlice& s) {
    const auto position = s.file.numbers(tag::position), orientation = s.file.numbers(tag::orientation),
               spacing = s.file.numbers(tag::pixel_spacing);
    if (position.size() != 3 || orientation.size() != 6)
        bad_file(s.path, "the slice has no usable ImagePositionPatient and ImageOrientationPatient: it cannot be placed in a volume");
    if (spacing.size() != 2 || !(spacing[0] > 0) || !(spacing[1] > 0) || !std::isfinite(spacing[0]) || !std::isfinite(spacing[1]))
        bad_file(s.path, "PixelSpacing is \"{:.40}\": expected two finite numbers above 0", s.file.text(tag::pixel_spacing));
    std::copy_n(position.begin(), 3, s.position.begin());
    std::copy_n(orientation.begin(), 3, s.row.begin());
    std::copy_n(orientation.begin() + 3, 3, s.column.begin());
    const double row = norm(s.row), column = norm(s.column), angle = norm(cross(s.row, s.column));
    if (!(std::abs(row - 1) < 0.01) || !(std::abs(column - 1) < 0.01) || !(angle > 0.9) || !std::isfinite(norm(s.position)))
        bad_file(s.path,
                 "ImageOrientationPatient \"{:.80}\" or ImagePositionPatient is not usable: expected two perpendicular unit vectors and a "
                 "finite point",
                 s.file.text(tag::orientation));
    s.row = unit(s.row);
    s.column = unit(s.column);
    s.spacing_j = spacing[0]; // PixelSpacing is: between rows, between columns
    s.spacing_i = spacing[1];
    s.thickness = s.file.number(tag::slice_distance, s.file.number(tag::slice_thickness, 0));
}

/// A slice by its header; nothing when the file holds no image. Throws Error{input} for an image that is no slice of grey values.
std::optional<DicomSlice> slice_of(DicomFile&& file, const std::string& path) {
    DicomSlice s;
    s.file = std::move(file);
    const DicomFile& f = s.file;
    s.path = path;
    s.series = f.text(tag::series_uid);
    s.description = f.text(tag::series_description);
    s.instance_uid = f.text(tag::instance_uid);
    s.modality = f.text(tag::modality);
    s.instance = f.number(tag::instance_number, 0);
    s.acquisition = f.number(tag::temporal_position, f.number(tag::acquisition_number, 0));
    DicomPixels& p = s.pixels;
    p.rows = f.unsigned_short(tag::rows).value_or(0);
    p.columns = f.unsigned_short(tag::columns).value_or(0);
    if (!f.has_pixels || p.rows == 0 || p.columns == 0) return std::nullopt;
    if (s.modality == "SEG") bad_file(path, "the file is a segmentation (a label map): clvr renders measured values, not labels");
    const std::string colour = f.text(tag::photometric);
    const int samples = f.unsigned_short(tag::samples_per_pixel).value_or(1);
    if (samples != 1 || (colour != "MONOCHROME2" && colour != "MONOCHROME1" && !colour.empty()))
        bad_file(path, "the pixels are colours ({}, {} samples each): clvr renders scalar volumes", colour, samples);
    if (const double frames = f.number(tag::frames, 1); frames > 1)
        bad_file(path,
                 "the file holds {:g} frames (multi-frame DICOM): convert it to a series of slices or to NIfTI, for example with dcm2niix",
                 frames);
    p.inverse = colour == "MONOCHROME1";
    p.bits_allocated = f.unsigned_short(tag::bits_allocated).value_or(16);
    p.bits_stored = f.unsigned_short(tag::bits_stored).value_or(p.bits_allocated);
    p.is_signed = f.unsigned_short(tag::pixel_representation).value_or(0) == 1;
    const int high_bit = f.unsigned_short(tag::high_bit).value_or(p.bits_stored - 1);
    if ((p.bits_allocated != 8 && p.bits_allocated != 16 && p.bits_allocated != 32) || p.bits_stored < 1 ||
        p.bits_stored > p.bits_allocated || high_bit != p.bits_stored - 1)
        bad_file(path,
                 "pixels of {} bits stored in {}, high bit {}, are not read: expected 8, 16 or 32 bits with the value in the low bits",
                 p.bits_stored, p.bits_allocated, high_bit);
    s.slope = f.number(tag::rescale_slope, 1);
    s.intercept = f.number(tag::rescale_intercept, 0);
    read_place(s);
    s.file.values.clear(); // a series has many
    return s;
}

SampleType sample_type(const DicomPixels& p) { return *parse_sample_type(fmt::format("{}{}", p.is_signed ? 'i' : 'u', p.bits_allocated)); }

/// Loads slices into a volume: as stored, or as physical values.
struct SliceLoader {
    DicomPixelReader& reader;
    SampleType type;
    bool physical;

    /// The reader's next slice, which is `s`, becomes the voxels from `first` on.
    void operator()(const DicomSlice& s, Voxels& v, std::size_t first) {
        if (v.type == kept_type(type) && is_kept(type)) return reader.next(v.bytes.data() + first * sample_bytes(type));
        std::vector<unsigned char> scratch(s.pixels.bytes());
        reader.next(scratch.data());
        store_samples(scratch.data(), type, s.pixels.count(), v, first);
        if (!physical) return;
        float* const values = reinterpret_cast<float*>(v.bytes.data()) + first;
        for (std::size_t i = 0; i < s.pixels.count(); ++i) values[i] = static_cast<float>(s.slope * double{values[i]} + s.intercept);
    }
};

/// Voxels first .. first + n - 1 of `v` move by `share` of the way to those of `other`; integers are rounded.
void blend(Voxels& v, std::size_t first, const Voxels& other, std::size_t n, double share) {
    with_voxel_type(v.type, [&](auto zero) {
        using T = decltype(zero);
        T* const low = reinterpret_cast<T*>(v.bytes.data()) + first;
        const T* const high = other.data<T>();
        for (std::size_t i = 0; i < n; ++i) {
            const double value = static_cast<double>(low[i]) + share * (static_cast<double>(high[i]) - static_cast<double>(low[i]));
            low[i] = static_cast<T>(std::is_integral_v<T> ? std::round(value) : value);
        }
    });
}

std::string describe_series(const std::vector<DicomSlice>& slices) {
    const DicomSlice& s = slices.front();
    return fmt::format("{} ({}{}{}, {} x {} x {})", s.series, s.modality, s.description.empty() ? "" : ", ", s.description,
                       s.pixels.columns, s.pixels.rows, slices.size());
}

bool may_be_dicom(const std::string& path) {
    const std::string head = read_head(path, 132), ending = lower_case(fs::path(path).extension().string());
    return (head.size() == 132 && head.compare(128, 4, "DICM") == 0) || ending == ".dcm" || ending == ".ima";
}

/// Files in the folder, or beside the file, in order of their names.
std::vector<std::string> candidates(const std::string& path) {
    if (!fs::is_directory(path)) {
        const fs::path parent = fs::path(path).parent_path();
        auto files = candidates(parent.empty() ? "." : parent.string());
        if (std::none_of(files.begin(), files.end(), [&](const std::string& f) { return fs::equivalent(f, path); })) files.push_back(path);
        return files;
    }
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(path))
        if (entry.is_regular_file() && may_be_dicom(entry.path().string())) files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

/// Every series of the folder, or the series of one file among its neighbours. A damaged file is refused, as it may be a slice; with
/// `allow_gaps`, and where it is sound but no slice of grey values, it is left out and noted.
std::map<std::string, std::vector<DicomSlice>> scan(const std::string& path, bool allow_gaps, std::vector<std::string>& notes) {
    std::map<std::string, std::vector<DicomSlice>> series;
    std::optional<std::string> wanted;
    if (!fs::is_directory(path)) {
        const auto s = slice_of(scan_dicom(path), path);
        if (!s) bad_file(path, "the DICOM file holds no image");
        wanted = s->series;
    }
    std::vector<std::string> problems;
    for (const std::string& name : candidates(path)) {
        DicomFile file;
        try {
            file = scan_dicom(name);
        } catch (const Error& e) {
            if (!allow_gaps) throw Error(e.kind(), std::string(e.what()) + " (--allow-gaps leaves it out)", e.where());
            problems.push_back(e.line());
            continue;
        }
        try {
            auto s = slice_of(std::move(file), name);
            if (s && (!wanted || s->series == *wanted)) series[s->series].push_back(std::move(*s));
        } catch (const Error& e) {
            problems.push_back(e.line());
        }
    }
    if (series.empty())
        bad_file(path, "no DICOM slice in it can be used{}",
                 problems.empty() ? " (folders inside it are not searched)" : ": " + problems.front());
    if (!problems.empty())
        notes.push_back(
            fmt::format("{} DICOM file{} left out: {}", problems.size(), problems.size() == 1 ? " was" : "s were", problems.front()));
    return series;
}

const std::vector<DicomSlice>& choose_series(const std::map<std::string, std::vector<DicomSlice>>& series, const std::string& wanted,
                                             const std::string& path, std::vector<std::string>& notes) {
    std::string list;
    for (const auto& [uid, slices] : series) list += (list.empty() ? "" : "; ") + describe_series(slices);
    if (!wanted.empty()) {
        const auto found = series.find(wanted);
        if (found == series.end()) bad_file(path, "no series {}: there {} {}", wanted, series.size() == 1 ? "is" : "are", list);
        return found->second;
    }
    const auto voxels = [](const auto& s) {
        return static_cast<double>(s.second.size()) * s.second.front().pixels.columns * s.second.front().pixels.rows;
    };
    const auto largest =
        std::max_element(series.begin(), series.end(), [&](const auto& a, const auto& b) { return voxels(a) < voxels(b); });
    if (series.size() > 1)
        notes.push_back(fmt::format("{} series, the largest is taken ({}; --series chooses): {}", series.size(), largest->first, list));
    return largest->second;
}

} // namespace

Voxels read_dicom(const std::string& path, const VolumeReadOptions& options) {
    std::vector<std::string> notes;
    const auto all = scan(path, options.allow_gaps, notes);
    const std::vector<DicomSlice>& slices = choose_series(all, options.series, path, notes);
    const Arrangement a = arrange(slices, options.frame, options.allow_gaps, path);
    const DicomSlice& first = slices[a.slices.front().low];

    // PET scales each slice by itself: then the voxels become physical values.
    const bool one_scale = std::all_of(a.slices.begin(), a.slices.end(), [&](const SlicePlace& p) {
        return slices[p.low].slope == first.slope && slices[p.low].intercept == first.intercept && slices[p.high].slope == first.slope &&
               slices[p.high].intercept == first.intercept;
    });
    const SampleType file_type = sample_type(first.pixels), type = one_scale ? file_type : SampleType::f32;
    Voxels v;
    describe(v, path, "DICOM series", file_type);
    v.type = kept_type(type);
    v.notes.insert(v.notes.end(), notes.begin(), notes.end());
    v.notes.insert(v.notes.end(), a.notes.begin(), a.notes.end());
    if (!one_scale) v.notes.push_back("the slices are scaled differently: kept as f32 physical values");
    if (first.pixels.inverse) v.notes.push_back("the file shows its smallest values as white (MONOCHROME1): values are taken as stored");
    v.modality = first.modality;
    v.geometry = a.geometry;
    check_geometry(v.geometry, path);
    v.slope = one_scale ? first.slope : 1;
    v.intercept = one_scale ? first.intercept : 0;
    v.dims = check_dims({first.pixels.columns, first.pixels.rows, static_cast<std::int64_t>(a.slices.size())}, 1, type, path).dims;

    std::vector<const DicomSlice*> order;
    for (const SlicePlace& p : a.slices) {
        order.push_back(&slices[p.low]);
        if (p.share > 0) order.push_back(&slices[p.high]);
    }
    for (const DicomSlice* s : order)
        if (!s->file.encapsulated && s->file.pixel_bytes < first.pixels.bytes())
            bad_file(s->path, "expected {} bytes of pixels, found {}: the file is truncated", first.pixels.bytes(), s->file.pixel_bytes);
    DicomPixelReader reader(order);
    SliceLoader load{reader, file_type, !one_scale};
    allocate(v);
    const std::size_t pixels = first.pixels.count();
    Voxels other; // the upper of two slices to blend
    other.type = v.type;
    other.bytes.resize(pixels * voxel_bytes(v.type));
    for (std::size_t k = 0; k < a.slices.size(); ++k) {
        const SlicePlace& p = a.slices[k];
        load(slices[p.low], v, k * pixels);
        if (p.share == 0) continue;
        load(slices[p.high], other, 0);
        blend(v, k * pixels, other, pixels, p.share);
    }
    return v;
}

} // namespace clvr

// DICOM series: headers and pixels by GDCM, grouping, order and checks by clvr (ITK's series reader stretches the spacing over a gap).
#include "host/io/dicom_series.hpp"
#include "host/io/volume_itk.hpp"
#include "host/io/volume_readers.hpp"
#include "host/io/volume_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>

#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmTrace.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;

const gdcm::Tag pixel_data(0x7fe0, 0x0010);

/// The value of an element as text, without padding; empty where it is absent.
std::string text_of(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
    const gdcm::Tag tag(group, element);
    if (!data.FindDataElement(tag)) return {};
    const gdcm::ByteValue* value = data.GetDataElement(tag).GetByteValue();
    if (!value || !value->GetPointer()) return {};
    std::string text(value->GetPointer(), value->GetLength());
    if (const auto end = text.find('\0'); end != std::string::npos) text.resize(end);
    return std::string(trimmed(text));
}

std::optional<int> short_of(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
    const gdcm::Tag tag(group, element);
    if (!data.FindDataElement(tag)) return std::nullopt;
    const gdcm::ByteValue* value = data.GetDataElement(tag).GetByteValue();
    std::uint16_t number = 0;
    if (!value || !value->GetPointer() || value->GetLength() < sizeof number) return std::nullopt;
    std::memcpy(&number, value->GetPointer(), sizeof number);
    return number;
}

/// Decimal strings, separated by backslashes.
std::vector<double> numbers_of(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
    std::string text = text_of(data, group, element);
    std::replace(text.begin(), text.end(), '\\', ' ');
    return parse_numbers(text).value_or(std::vector<double>{});
}

double number_of(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element, double fallback) {
    const auto values = numbers_of(data, group, element);
    return values.empty() ? fallback : values.front();
}

/// Geometry of a slice. Throws Error{input} for what cannot be placed.
void read_place(DicomSlice& s, const gdcm::DataSet& data) {
    const auto position = numbers_of(data, 0x0020, 0x0032), orientation = numbers_of(data, 0x0020, 0x0037),
               spacing = numbers_of(data, 0x0028, 0x0030);
    if (position.size() != 3 || orientation.size() != 6)
        bad_file(s.path, "the slice has no ImagePositionPatient and ImageOrientationPatient: it cannot be placed in a volume");
    if (spacing.size() != 2 || !(spacing[0] > 0) || !(spacing[1] > 0) || !std::isfinite(spacing[0]) || !std::isfinite(spacing[1]))
        bad_file(s.path, "PixelSpacing is \"{:.40}\": expected two finite numbers above 0", text_of(data, 0x0028, 0x0030));
    for (int i = 0; i < 3; ++i) {
        s.position[i] = position[static_cast<std::size_t>(i)];
        s.row[i] = orientation[static_cast<std::size_t>(i)];
        s.column[i] = orientation[static_cast<std::size_t>(i) + 3];
    }
    const double row = norm(s.row), column = norm(s.column), angle = norm(cross(s.row, s.column));
    if (!(std::abs(row - 1) < 0.01) || !(std::abs(column - 1) < 0.01) || !(angle > 0.9) || !std::isfinite(norm(s.position)))
        bad_file(s.path,
                 "ImageOrientationPatient \"{:.80}\" or ImagePositionPatient is not usable: expected two perpendicular unit vectors and a "
                 "finite point",
                 text_of(data, 0x0020, 0x0037));
    s.row = unit(s.row);
    s.column = unit(s.column);
    s.spacing_j = spacing[0]; // PixelSpacing is: between rows, between columns
    s.spacing_i = spacing[1];
    s.thickness = number_of(data, 0x0018, 0x0088, number_of(data, 0x0018, 0x0050, 0));
}

/// The header of a file up to its pixels; nothing when the file holds no image.
std::optional<DicomSlice> read_header(const std::string& path) {
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.ReadUpToTag(pixel_data)) bad_file(path, "GDCM cannot read it as DICOM: the file is truncated or damaged");
    const gdcm::DataSet& data = reader.GetFile().GetDataSet();
    DicomSlice s;
    s.path = path;
    s.series = text_of(data, 0x0020, 0x000e);
    s.description = text_of(data, 0x0008, 0x103e);
    s.instance_uid = text_of(data, 0x0008, 0x0018);
    s.modality = text_of(data, 0x0008, 0x0060);
    s.instance = static_cast<long>(number_of(data, 0x0020, 0x0013, 0));
    s.acquisition = static_cast<long>(number_of(data, 0x0020, 0x0100, number_of(data, 0x0020, 0x0012, 0)));
    s.rows = short_of(data, 0x0028, 0x0010).value_or(0);
    s.columns = short_of(data, 0x0028, 0x0011).value_or(0);
    if (s.rows == 0 || s.columns == 0) return std::nullopt;
    if (s.modality == "SEG") bad_file(path, "the file is a segmentation (a label map): clvr renders measured values, not labels");
    const std::string colour = text_of(data, 0x0028, 0x0004);
    const int samples = short_of(data, 0x0028, 0x0002).value_or(1);
    if (samples != 1 || (colour != "MONOCHROME2" && colour != "MONOCHROME1" && !colour.empty()))
        bad_file(path, "the pixels are colours ({}, {} samples each): clvr renders scalar volumes", colour, samples);
    if (const double frames = number_of(data, 0x0028, 0x0008, 1); frames > 1)
        bad_file(path,
                 "the file holds {:g} frames (multi-frame DICOM): convert it to a series of slices or to NIfTI, for example with dcm2niix",
                 frames);
    s.inverse = colour == "MONOCHROME1";
    s.bits_allocated = short_of(data, 0x0028, 0x0100).value_or(16);
    s.bits_stored = short_of(data, 0x0028, 0x0101).value_or(s.bits_allocated);
    s.high_bit = short_of(data, 0x0028, 0x0102).value_or(s.bits_stored - 1);
    s.is_signed = short_of(data, 0x0028, 0x0103).value_or(0) == 1;
    if ((s.bits_allocated != 8 && s.bits_allocated != 16 && s.bits_allocated != 32) || s.bits_stored < 1 ||
        s.bits_stored > s.bits_allocated || s.high_bit != s.bits_stored - 1)
        bad_file(path,
                 "pixels of {} bits stored in {}, high bit {}, are not read: expected 8, 16 or 32 bits with the value in the low bits",
                 s.bits_stored, s.bits_allocated, s.high_bit);
    const gdcm::TransferSyntax syntax = reader.GetFile().GetHeader().GetDataSetTransferSyntax();
    s.compressed = syntax.IsEncapsulated() || syntax == gdcm::TransferSyntax::DeflatedExplicitVRLittleEndian;
    s.slope = number_of(data, 0x0028, 0x1053, 1);
    s.intercept = number_of(data, 0x0028, 0x1052, 0);
    read_place(s, data);
    return s;
}

SampleType sample_type(const DicomSlice& s) { return *parse_sample_type(fmt::format("{}{}", s.is_signed ? 'i' : 'u', s.bits_allocated)); }

/// Bits above the stored ones are not of the value (old files keep overlays there): cut off, or filled with the sign.
template <class T>
void clean(T* values, std::size_t n, int unused_bits) {
    using U = std::make_unsigned_t<T>;
    for (std::size_t i = 0; i < n; ++i)
        values[i] = static_cast<T>(static_cast<T>(static_cast<U>(static_cast<U>(values[i]) << unused_bits)) >> unused_bits);
}

void clean(unsigned char* pixels, std::size_t n, const DicomSlice& s) {
    const int unused = s.bits_allocated - s.bits_stored;
    if (unused == 0) return;
    switch (sample_type(s)) {
    case SampleType::u8:
        return clean(pixels, n, unused);
    case SampleType::i8:
        return clean(reinterpret_cast<std::int8_t*>(pixels), n, unused);
    case SampleType::u16:
        return clean(reinterpret_cast<std::uint16_t*>(pixels), n, unused);
    case SampleType::i16:
        return clean(reinterpret_cast<std::int16_t*>(pixels), n, unused);
    case SampleType::u32:
        return clean(reinterpret_cast<std::uint32_t*>(pixels), n, unused);
    default:
        return clean(reinterpret_cast<std::int32_t*>(pixels), n, unused);
    }
}

/// Decodes the pixels of one slice to `to`. GDCM forgives a truncated file, so the length of its pixels is checked.
void decode(const DicomSlice& s, unsigned char* to, std::size_t bytes) {
    gdcm::ImageReader reader;
    reader.SetFileName(s.path.c_str());
    if (!reader.Read())
        bad_file(s.path, "GDCM cannot read its pixels: the file is truncated, damaged, or compressed in a way that GDCM does not know");
    const gdcm::Image& image = reader.GetImage();
    const gdcm::DataElement& pixels = reader.GetFile().GetDataSet().GetDataElement(pixel_data);
    if (const gdcm::ByteValue* plain = pixels.GetByteValue(); plain && plain->GetLength() < bytes)
        bad_file(s.path, "expected {} bytes of pixels, found {}: the file is truncated", bytes, std::size_t{plain->GetLength()});
    if (image.GetBufferLength() != bytes) bad_file(s.path, "expected {} bytes of pixels, GDCM decodes {}", bytes, image.GetBufferLength());
    if (!image.GetBuffer(reinterpret_cast<char*>(to))) bad_file(s.path, "GDCM cannot decode its pixels: the file is truncated or damaged");
    clean(to, static_cast<std::size_t>(s.columns) * static_cast<std::size_t>(s.rows), s);
}

/// Loads a slice into a volume: as stored, or as physical values.
struct SliceLoader {
    SampleType type;
    bool physical;

    void operator()(const DicomSlice& s, Voxels& v, std::size_t first) const {
        const std::size_t pixels = static_cast<std::size_t>(s.columns) * static_cast<std::size_t>(s.rows),
                          bytes = pixels * sample_bytes(type);
        if (v.type == kept_type(type) && is_kept(type)) return decode(s, v.bytes.data() + first * sample_bytes(type), bytes);
        std::vector<unsigned char> scratch(bytes);
        decode(s, scratch.data(), bytes);
        store_samples(scratch.data(), type, pixels, v, first);
        if (!physical) return;
        float* const values = reinterpret_cast<float*>(v.bytes.data()) + first;
        for (std::size_t i = 0; i < pixels; ++i) values[i] = static_cast<float>(s.slope * double{values[i]} + s.intercept);
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
    return fmt::format("{} ({}{}{}, {} x {} x {})", s.series, s.modality, s.description.empty() ? "" : ", ", s.description, s.columns,
                       s.rows, slices.size());
}

/// Every series of the folder, or the series of one file among its neighbours.
std::map<std::string, std::vector<DicomSlice>> scan(const std::string& path, std::vector<std::string>& notes) {
    std::map<std::string, std::vector<DicomSlice>> series;
    const bool folder = fs::is_directory(path);
    std::string wanted;
    if (!folder) {
        const auto s = read_header(path);
        if (!s) bad_file(path, "the DICOM file holds no image");
        wanted = s->series;
    }
    const fs::path parent = fs::path(path).parent_path();
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder ? fs::path(path) : parent.empty() ? fs::path(".") : parent))
        if (entry.is_regular_file()) files.push_back(folder || !parent.empty() ? entry.path().string() : entry.path().filename().string());
    std::sort(files.begin(), files.end());
    std::string first_problem;
    std::size_t problems = 0;
    for (const std::string& file : files) {
        const std::string head = read_head(file, 132), ending = lower_case(fs::path(file).extension().string());
        if (!(head.size() == 132 && head.compare(128, 4, "DICM") == 0) && ending != ".dcm" && ending != ".ima" && file != path) continue;
        try {
            if (auto s = read_header(file); s && (folder || s->series == wanted)) series[s->series].push_back(std::move(*s));
        } catch (const Error& e) {
            if (problems++ == 0) first_problem = e.line();
        }
    }
    if (series.empty())
        bad_file(path, "no DICOM slice in it can be used{}{}", first_problem.empty() ? " (folders inside it are not searched)" : ": ",
                 first_problem);
    if (problems > 0)
        notes.push_back(fmt::format("{} DICOM file{} left out: {}", problems, problems == 1 ? " was" : "s were", first_problem));
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
        return static_cast<double>(s.second.size()) * s.second.front().columns * s.second.front().rows;
    };
    const auto largest =
        std::max_element(series.begin(), series.end(), [&](const auto& a, const auto& b) { return voxels(a) < voxels(b); });
    if (series.size() > 1)
        notes.push_back(fmt::format("{} series, the largest is taken ({}; --series chooses): {}", series.size(), largest->first, list));
    return largest->second;
}

} // namespace

Voxels read_dicom(const std::string& path, const VolumeReadOptions& options) {
    gdcm::Trace::DebugOff();
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    std::vector<std::string> notes;
    const auto all = scan(path, notes);
    const std::vector<DicomSlice>& slices = choose_series(all, options.series, path, notes);
    const Arrangement a = arrange(slices, options.frame, options.allow_gaps, path);
    const DicomSlice& first = slices[a.slices.front().low];

    // PET scales each slice by itself: then the voxels become physical values.
    const bool one_scale = std::all_of(a.slices.begin(), a.slices.end(), [&](const SlicePlace& p) {
        return slices[p.low].slope == first.slope && slices[p.low].intercept == first.intercept && slices[p.high].slope == first.slope &&
               slices[p.high].intercept == first.intercept;
    });
    const SampleType file_type = sample_type(first), type = one_scale ? file_type : SampleType::f32;
    Voxels v;
    describe(v, path, "DICOM series", file_type);
    v.type = kept_type(type);
    v.notes.insert(v.notes.end(), notes.begin(), notes.end());
    v.notes.insert(v.notes.end(), a.notes.begin(), a.notes.end());
    if (!one_scale) v.notes.push_back("the slices are scaled differently: kept as f32 physical values");
    if (first.inverse) v.notes.push_back("the file shows its smallest values as white (MONOCHROME1): values are taken as stored");
    v.modality = first.modality;
    v.geometry = a.geometry;
    check_geometry(v.geometry, path);
    v.slope = one_scale ? first.slope : 1;
    v.intercept = one_scale ? first.intercept : 0;
    v.dims = check_dims({first.columns, first.rows, static_cast<std::int64_t>(a.slices.size())}, 1, type, path).dims;

    const std::size_t pixels = static_cast<std::size_t>(first.columns) * static_cast<std::size_t>(first.rows),
                      slice_bytes = pixels * sample_bytes(file_type);
    for (const SlicePlace& p : a.slices)
        for (const std::size_t i : {p.low, p.high})
            if (const auto size = fs::file_size(slices[i].path); !slices[i].compressed && size < slice_bytes)
                bad_file(slices[i].path, "expected {} bytes of pixels, the file has {} in all: it is truncated", slice_bytes, size);
    allocate(v);
    const SliceLoader load{file_type, !one_scale};
    Voxels other; // the upper of two slices to blend
    other.type = v.type;
    for (std::size_t k = 0; k < a.slices.size(); ++k) {
        const SlicePlace& p = a.slices[k];
        load(slices[p.low], v, k * pixels);
        if (p.share == 0) continue;
        other.bytes.resize(pixels * voxel_bytes(v.type));
        load(slices[p.high], other, 0);
        blend(v, k * pixels, other, pixels, p.share);
    }
    return v;
}

} // namespace clvr

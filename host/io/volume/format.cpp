#include "host/io/volume/format.hpp"
#include "host/io/byte_stream.hpp"
#include "host/io/dicom/start.hpp"
#include "host/io/volume/file_pair.hpp"
#include "host/io/volume/header_bytes.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/mrc.hpp"
#include "host/io/volume/nifti_header.hpp"
#include "host/io/volume/not_volumes.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

namespace clvr {

namespace {

constexpr const char* supported =
    "NIfTI (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd), DICOM (a file or a folder), TIFF, PNG or JPEG (a file "
    "or a folder of slices), VTK image (.vti, .vtk), NumPy (.npy), MRC/CCP4 (.mrc, .map, .rec), MGH (.mgh, .mgz), HDF5 and Imaris (.h5, "
    "FILE:/path/of/dataset, .ims), RAW (name_WxHxD_type.raw, .raw.gz)";

} // namespace

bool ends_with(const std::string& s, const std::string& end) {
    return s.size() >= end.size() && s.compare(s.size() - end.size(), end.size(), end) == 0;
}
bool starts_with(const std::string& s, const std::string& start) { return s.compare(0, start.size(), start) == 0; }

namespace {

bool nifti_size(const std::string& head) {
    static const std::array<std::string, 4> sizes{{{"\x5c\x01\0\0", 4}, {"\0\0\x01\x5c", 4}, {"\x1c\x02\0\0", 4}, {"\0\0\x02\x1c", 4}}};
    return std::any_of(sizes.begin(), sizes.end(), [&](const std::string& s) { return starts_with(head, s); });
}

/// An XML file of VTK, of whatever type: its reader names those that are no images.
bool is_vtk_xml(const std::string& head) {
    const auto start = head.find_first_not_of("\xef\xbb\xbf \t\r\n");
    return start != std::string::npos && head[start] == '<' && head.find("<VTKFile") != std::string::npos;
}

/// FreeSurfer's header has no mark: version 1, four sizes, a known type, all big-endian.
bool mgh_header(const std::string& head) {
    if (head.size() < 284) return false;
    const HeaderBytes h(head, must_swap(true));
    const auto number = [&](std::size_t at) { return h.at<std::int32_t>(at); };
    for (const std::size_t at : {4, 8, 12, 16})
        if (number(at) < 1 || number(at) > 1 << 20) return false;
    return number(0) == 1 && number(20) >= 0 && number(20) <= 10;
}

const std::string hdf5_mark{"\x89HDF\r\n\x1a\n"};

/// HDF5 files may start with a block of the program that wrote them: then the mark stands at byte 512, 1024, 2048, ...
bool has_late_hdf5_mark(const std::string& path) {
    const std::uint64_t size = std::filesystem::file_size(path);
    std::string found(hdf5_mark.size(), '\0');
    for (std::uint64_t offset = 512; offset + found.size() <= size; offset *= 2)
        if (ByteStream(path, ByteStream::Coding::plain, offset).read(found.data(), found.size()) == found.size() && found == hdf5_mark)
            return true;
    return false;
}

/// Voxels of a NIfTI pair may start with any bytes: their header beside them counts first.
bool has_nifti_header_beside(const std::string& path) {
    const std::string header = file_beside(path, {".img", ".img.gz"}, {".hdr", ".hdr.gz"});
    return !header.empty() && nifti_size(read_head_inside(header, 540));
}

/// Formats with a mark so long that no RAW file starts with it by chance.
bool has_sure_mark(VolumeFormat f) {
    return f == VolumeFormat::nrrd || f == VolumeFormat::vtk || f == VolumeFormat::png || f == VolumeFormat::numpy ||
           f == VolumeFormat::hdf5;
}

bool reads_gzip(VolumeFormat f) {
    return f == VolumeFormat::nifti || f == VolumeFormat::numpy || f == VolumeFormat::mrc || f == VolumeFormat::mgh;
}

} // namespace

VolumeFormat format_of_head(const std::string& head) {
    if (starts_with(head, "NRRD000")) return VolumeFormat::nrrd;
    if (starts_with(head, "# vtk DataFile")) return VolumeFormat::vtk;
    if (head.size() >= 132 && head.compare(128, 4, "DICM") == 0) return VolumeFormat::dicom;
    for (const std::string& mark : {std::string("II*\0", 4), std::string("MM\0*", 4), std::string("II+\0", 4), std::string("MM\0+", 4)})
        if (starts_with(head, mark)) return VolumeFormat::tiff;
    if (starts_with(head, "\x89PNG\r\n\x1a\n")) return VolumeFormat::png;
    if (starts_with(head, "\xff\xd8\xff")) return VolumeFormat::jpeg;
    if (nifti_size(head) && head.size() >= 12) return VolumeFormat::nifti;
    if (starts_with(head, "\x93NUMPY")) return VolumeFormat::numpy;
    if (starts_with(head, hdf5_mark) || (head.size() > 512 && head.compare(512, hdf5_mark.size(), hdf5_mark) == 0))
        return VolumeFormat::hdf5;
    if (is_mrc_header(head)) return VolumeFormat::mrc;
    if (mgh_header(head)) return VolumeFormat::mgh;
    if (starts_with(head, "ObjectType") || starts_with(head, "NDims") || starts_with(head, "Comment")) return VolumeFormat::metaimage;
    if (is_vtk_xml(head)) return VolumeFormat::vti;
    if (dicom_start(head)) return VolumeFormat::dicom; // without preamble
    return VolumeFormat::unknown;
}

VolumeFormat format_of_name(const std::string& file_name) {
    const std::string name = lower_case(file_name);
    static const std::map<std::string, VolumeFormat> endings{
        {".nii", VolumeFormat::nifti},     {".nii.gz", VolumeFormat::nifti}, {".hdr", VolumeFormat::nifti},
        {".hdr.gz", VolumeFormat::nifti},  {".img", VolumeFormat::nifti},    {".img.gz", VolumeFormat::nifti},
        {".nrrd", VolumeFormat::nrrd},     {".nhdr", VolumeFormat::nrrd},    {".mha", VolumeFormat::metaimage},
        {".mhd", VolumeFormat::metaimage}, {".dcm", VolumeFormat::dicom},    {".ima", VolumeFormat::dicom},
        {".tif", VolumeFormat::tiff},      {".tiff", VolumeFormat::tiff},    {".png", VolumeFormat::png},
        {".jpg", VolumeFormat::jpeg},      {".jpeg", VolumeFormat::jpeg},    {".vtk", VolumeFormat::vtk},
        {".vti", VolumeFormat::vti},       {".npy", VolumeFormat::numpy},    {".npy.gz", VolumeFormat::numpy},
        {".mrc", VolumeFormat::mrc},       {".mrc.gz", VolumeFormat::mrc},   {".map", VolumeFormat::mrc},
        {".map.gz", VolumeFormat::mrc},    {".ccp4", VolumeFormat::mrc},     {".ccp4.gz", VolumeFormat::mrc},
        {".rec", VolumeFormat::mrc},       {".st", VolumeFormat::mrc},       {".mrcs", VolumeFormat::mrc},
        {".mgh", VolumeFormat::mgh},       {".mgh.gz", VolumeFormat::mgh},   {".mgz", VolumeFormat::mgh},
        {".h5", VolumeFormat::hdf5},       {".hdf5", VolumeFormat::hdf5},    {".hdf", VolumeFormat::hdf5},
        {".ims", VolumeFormat::hdf5},      {".raw", VolumeFormat::raw},      {".raw.gz", VolumeFormat::raw}};
    for (const auto& [ending, format] : endings)
        if (ends_with(name, ending)) return format;
    return VolumeFormat::unknown;
}

VolumeFormat format_of_file(const std::string& path, const VolumeReadOptions& options) {
    const std::string name = lower_case(std::filesystem::path(path).filename().string());
    const VolumeFormat by_name = format_of_name(name);
    if (options.dims) return VolumeFormat::raw;
    const std::string head = read_head(path, 1024);
    if (by_name == VolumeFormat::raw) return has_sure_mark(format_of_head(head)) ? format_of_head(head) : VolumeFormat::raw;
    if (has_nifti_header_beside(path)) return VolumeFormat::nifti;
    if (head.empty()) bad_file(path, "the file is empty");
    if (const VolumeFormat by_head = format_of_head(head); by_head != VolumeFormat::unknown) return by_head;
    if (starts_with(head, "\x1f\x8b"))
        if (const VolumeFormat inside = format_of_head(read_head_inside(path, 1024)); inside != VolumeFormat::unknown) {
            if (!reads_gzip(inside)) bad_file(path, "gzip is not read around this format: gunzip the file, it is read then");
            return inside;
        }
    if (by_name == VolumeFormat::hdf5 || by_name == VolumeFormat::unknown)
        if (has_late_hdf5_mark(path)) return VolumeFormat::hdf5;
    for (const std::string& other : {other_kind_of_head(head), other_kind_of_name(path)})
        if (!other.empty()) bad_file(path, "this is {}", other);
    if (by_name != VolumeFormat::unknown) return by_name;
    bad_file(path, "not a volume that clvr knows{}. Read are: {}", starts_with(head, "\x1f\x8b") ? ", inside gzip" : "", supported);
}

} // namespace clvr

#include "host/io/volume/format.hpp"
#include "host/io/byte_stream.hpp"
#include "host/io/volume/dicom/start.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>

namespace clvr {

namespace {

constexpr const char* supported =
    "NIfTI (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd), DICOM (a file or a folder), TIFF, PNG or JPEG (a file "
    "or a folder of slices), VTK image (.vti, .vtk), RAW (name_WxHxD_type.raw, .raw.gz)";

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

bool has_text_header(VolumeFormat f) {
    return f == VolumeFormat::nrrd || f == VolumeFormat::metaimage || f == VolumeFormat::vtk || f == VolumeFormat::vti;
}

/// An XML file of VTK, of whatever type: its reader names those that are no images.
bool is_vtk_xml(const std::string& head) {
    const auto start = head.find_first_not_of("\xef\xbb\xbf \t\r\n");
    return start != std::string::npos && head[start] == '<' && head.find("<VTKFile") != std::string::npos;
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
        {".vti", VolumeFormat::vti},       {".raw", VolumeFormat::raw},      {".raw.gz", VolumeFormat::raw}};
    for (const auto& [ending, format] : endings)
        if (ends_with(name, ending)) return format;
    return VolumeFormat::unknown;
}

VolumeFormat format_of_file(const std::string& path, const VolumeReadOptions& options) {
    const std::string name = lower_case(std::filesystem::path(path).filename().string());
    const VolumeFormat by_name = format_of_name(name);
    if (by_name == VolumeFormat::raw || options.dims) return VolumeFormat::raw;
    const std::string head = read_head(path, 1024);
    if (format_of_head(head) == VolumeFormat::dicom) return VolumeFormat::dicom;
    if (ends_with(name, ".img") || ends_with(name, ".img.gz")) return VolumeFormat::nifti; // voxels alone: the header is beside
    if (head.empty()) bad_file(path, "the file is empty");
    const VolumeFormat by_head = format_of_head(head);
    if (by_head != VolumeFormat::unknown) return by_head;
    const bool packed = is_gzip(path);
    if (by_name != VolumeFormat::unknown && !(packed && has_text_header(by_name))) return by_name;
    if (packed) {
        std::string inside(1024, '\0');
        inside.resize(ByteStream(path, ByteStream::Coding::deflated).read(inside.data(), inside.size()));
        if (format_of_head(inside) == VolumeFormat::nifti) return VolumeFormat::nifti;
        bad_file(path, "gzip is read around NIfTI and RAW only: gunzip the file first");
    }
    bad_file(path, "not a volume that clvr knows. Read are: {}", supported);
}

} // namespace clvr

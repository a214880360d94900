#include "host/io/volume_file.hpp"
#include "host/io/header_text.hpp"
#include "host/io/volume_readers.hpp"
#include "host/io/volume_samples.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <openssl/evp.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;

constexpr const char* supported =
    "NIfTI (.nii, .nii.gz, .hdr/.img), NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd), DICOM (a file or a folder), TIFF (.tif or a folder of "
    "slices), VTK image (.vtk), RAW (name_WxHxD_type.raw, .raw.gz)";

enum class Format { unknown, nifti, nrrd, metaimage, dicom, tiff, vtk, raw };

bool ends_with(const std::string& s, const std::string& end) {
    return s.size() >= end.size() && s.compare(s.size() - end.size(), end.size(), end) == 0;
}
bool starts_with(const std::string& s, const std::string& start) { return s.compare(0, start.size(), start) == 0; }

bool nifti_size(const std::string& head) {
    static const std::array<std::string, 4> sizes{{{"\x5c\x01\0\0", 4}, {"\0\0\x01\x5c", 4}, {"\x1c\x02\0\0", 4}, {"\0\0\x02\x1c", 4}}};
    return std::any_of(sizes.begin(), sizes.end(), [&](const std::string& s) { return starts_with(head, s); });
}

/// By what the bytes say.
Format format_of_head(const std::string& head) {
    if (starts_with(head, "NRRD000")) return Format::nrrd;
    if (starts_with(head, "# vtk DataFile")) return Format::vtk;
    if (head.size() >= 132 && head.compare(128, 4, "DICM") == 0) return Format::dicom;
    for (const std::string& mark : {std::string("II*\0", 4), std::string("MM\0*", 4), std::string("II+\0", 4), std::string("MM\0+", 4)})
        if (starts_with(head, mark)) return Format::tiff;
    if (nifti_size(head) && head.size() >= 12) return Format::nifti;
    if (starts_with(head, "ObjectType") || starts_with(head, "NDims") || starts_with(head, "Comment")) return Format::metaimage;
    return Format::unknown;
}

/// By the name, where the bytes are silent or damaged.
Format format_of_name(const std::string& name) {
    static const std::map<std::string, Format> endings{{".nii", Format::nifti},     {".nii.gz", Format::nifti}, {".hdr", Format::nifti},
                                                       {".hdr.gz", Format::nifti},  {".img", Format::nifti},    {".img.gz", Format::nifti},
                                                       {".nrrd", Format::nrrd},     {".nhdr", Format::nrrd},    {".mha", Format::metaimage},
                                                       {".mhd", Format::metaimage}, {".dcm", Format::dicom},    {".ima", Format::dicom},
                                                       {".tif", Format::tiff},      {".tiff", Format::tiff},    {".vtk", Format::vtk},
                                                       {".raw", Format::raw},       {".raw.gz", Format::raw}};
    for (const auto& [ending, format] : endings)
        if (ends_with(name, ending)) return format;
    return Format::unknown;
}

Format format_of_file(const std::string& path, const VolumeReadOptions& options) {
    const std::string name = lower_case(fs::path(path).filename().string());
    const Format by_name = format_of_name(name);
    if (by_name == Format::raw || options.dims) return Format::raw;
    if (ends_with(name, ".img") || ends_with(name, ".img.gz")) return Format::nifti; // voxels alone: the header is beside
    const std::string head = read_head(path, 1024);
    if (head.empty()) bad_file(path, "the file is empty");
    const Format by_head = format_of_head(head);
    if (by_head != Format::unknown) return by_head;
    if (by_name != Format::unknown) return by_name;
    if (starts_with(head, "<?xml") || starts_with(head, "<VTKFile"))
        bad_file(path, "XML VTK files (.vti) are not read: save as legacy VTK (.vtk), MetaImage or NRRD. Read are: {}", supported);
    if (is_gzip(path)) {
        std::string inside(1024, '\0');
        inside.resize(ByteStream(path, ByteStream::Coding::deflated).read(inside.data(), inside.size()));
        if (format_of_head(inside) == Format::nifti) return Format::nifti;
        bad_file(path, "gzip is read around NIfTI and RAW only: gunzip the file first");
    }
    bad_file(path, "not a volume that clvr knows. Read are: {}", supported);
}

/// "slice" and 12 of slice_0012.tif: files of one stack share the first, and are ordered by the second.
struct NumberedName {
    std::string base;
    unsigned long long number = 0;
    std::string path;
};
NumberedName split_number(const fs::path& path) {
    const std::string stem = path.stem().string();
    const auto last = stem.find_last_of("0123456789");
    if (last == std::string::npos) return {stem, 0, path.string()};
    const auto before = stem.find_last_not_of("0123456789", last);
    const auto first = before == std::string::npos ? 0 : before + 1;
    const std::string digits = stem.substr(first, std::min<std::size_t>(last + 1 - first, 18));
    return {stem.substr(0, first) + "#" + stem.substr(last + 1), std::stoull(digits), path.string()};
}

Voxels read_tiff_folder(const std::string& folder, const std::vector<fs::path>& files, const VolumeReadOptions& options) {
    std::map<std::string, std::vector<NumberedName>> stacks;
    for (const auto& f : files) {
        NumberedName n = split_number(f);
        stacks[n.base].push_back(std::move(n));
    }
    auto& stack = std::max_element(stacks.begin(), stacks.end(), [](const auto& a, const auto& b) {
                      return a.second.size() < b.second.size();
                  })->second;
    std::sort(stack.begin(), stack.end(),
              [](const auto& a, const auto& b) { return std::tie(a.number, a.path) < std::tie(b.number, b.path); });
    std::vector<std::string> paths;
    for (const auto& n : stack) paths.push_back(n.path);
    Voxels v = read_tiff(folder, paths, options);
    if (stack.size() < files.size())
        v.notes.push_back(fmt::format("{} of {} TIFF files in the folder have other names than the {} of this stack and were left out",
                                      files.size() - stack.size(), files.size(), stack.size()));
    if (const auto span = stack.back().number - stack.front().number + 1; span > stack.size())
        v.notes.push_back(fmt::format("the slices are numbered {} to {} but there are only {}: taken as neighbours", stack.front().number,
                                      stack.back().number, stack.size()));
    return v;
}

/// A DICOM series where any file is DICOM, else a stack of TIFF slices.
Voxels read_folder(const std::string& path, const VolumeReadOptions& options) {
    std::vector<fs::path> tiffs;
    for (const auto& entry : fs::directory_iterator(path)) {
        if (!entry.is_regular_file()) continue;
        const std::string head = read_head(entry.path().string(), 132);
        const Format format = format_of_head(head);
        const Format by_name = format_of_name(lower_case(entry.path().filename().string()));
        if (format == Format::dicom || by_name == Format::dicom) return read_dicom(path, options);
        if (format == Format::tiff || by_name == Format::tiff) tiffs.push_back(entry.path());
    }
    if (!tiffs.empty()) return read_tiff_folder(path, tiffs, options);
    bad_file(path, "the folder holds neither DICOM nor TIFF slices (folders inside it are not searched)");
}

Voxels read_any(const std::string& path, const VolumeReadOptions& options) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (status.type() == fs::file_type::not_found) bad_file(path, "there is no such file or folder");
    if (error) bad_file(path, "cannot be read: {}", error.message());
    if (fs::is_directory(status)) return read_folder(path, options);
    if (!fs::is_regular_file(status)) bad_file(path, "neither a file nor a folder: expected a volume");
    switch (format_of_file(path, options)) {
    case Format::nifti:
        return read_nifti(path, options);
    case Format::nrrd:
        return read_nrrd(path, options);
    case Format::metaimage:
        return read_metaimage(path, options);
    case Format::dicom:
        return read_dicom(path, options);
    case Format::tiff:
        return read_tiff(path, {path}, options);
    case Format::vtk:
        return read_vtk(path, options);
    case Format::raw:
        return read_raw(path, options);
    case Format::unknown:
        break;
    }
    throw Error(ErrorKind::internal, "no reader", path);
}

} // namespace

Voxels read_volume(const std::string& path, const VolumeReadOptions& options) {
    try {
        Voxels v = read_any(path, options);
        repair(v);
        for (int i = 0; i < 3; ++i) { // -0 becomes 0
            v.geometry.origin[i] += 0.0;
            for (double& x : v.geometry.direction.row[i]) x += 0.0;
        }
        const bool raw = v.format == "RAW", tiff = starts_with(v.format, "TIFF");
        if (!raw && (!options.type.empty() || !options.endian.empty()))
            v.notes.push_back("--type and --endian are for RAW files: the file's own were taken");
        if (!raw && !tiff && options.spacing) v.notes.push_back("--spacing is for RAW and TIFF: the file's own was taken");
        return v;
    } catch (const fs::filesystem_error& e) {
        throw Error(ErrorKind::input, fmt::format("cannot be read: {}", e.code().message()), path);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::memory, "not enough memory for this volume", path);
    }
}

std::string volume_sha256(const Voxels& v) {
    const std::string head = fmt::format("{} {} {} {}\n", v.dims[0], v.dims[1], v.dims[2], voxel_type_name(v.type));
    std::array<unsigned char, EVP_MAX_MD_SIZE> digest;
    unsigned size = 0;
    const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> hash(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
    if (!hash || !EVP_DigestInit_ex(hash.get(), EVP_sha256(), nullptr) || !EVP_DigestUpdate(hash.get(), head.data(), head.size()) ||
        !EVP_DigestUpdate(hash.get(), v.bytes.data(), v.bytes.size()) || !EVP_DigestFinal_ex(hash.get(), digest.data(), &size))
        throw Error(ErrorKind::internal, "OpenSSL offers no SHA-256");
    std::string hex;
    for (unsigned i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
    return hex;
}

} // namespace clvr

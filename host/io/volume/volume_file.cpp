#include "host/io/volume/volume_file.hpp"
#include "host/io/byte_stream.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/volume/dataset_path.hpp"
#include "host/io/volume/folder.hpp"
#include "host/io/volume/format.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/not_volumes.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"
#include "host/io/volume/slices.hpp"
#include "host/io/volume/tiff_ome.hpp"
#include "runtime/system/hashes.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>

namespace clvr {

namespace {

namespace fs = std::filesystem;

/// The format of a file in a folder: by its bytes, or by its name where they are silent.
VolumeFormat format_in_folder(const std::string& file) {
    const VolumeFormat by_head = format_of_head(read_head(file, 1024));
    return by_head == VolumeFormat::unknown ? format_of_name(file) : by_head;
}

using SliceReader = Voxels (*)(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options);
struct SliceFormat {
    VolumeFormat format;
    const char* name;
    SliceReader read;
};
/// Formats of slices. Those of the first format that a folder has are its slices; pictures of the others are previews or copies.
constexpr std::array slice_formats{SliceFormat{VolumeFormat::tiff, "TIFF", read_tiff},
                                   SliceFormat{VolumeFormat::png, "PNG", read_png_slices},
                                   SliceFormat{VolumeFormat::jpeg, "JPEG", read_jpeg_slices}};

/// Files of one OME-TIFF set say themselves how they belong together, others by their names.
Voxels read_stack(const std::string& path, const SliceFormat& format, const std::vector<std::string>& files,
                  const VolumeReadOptions& options) {
    if (format.format == VolumeFormat::tiff && files.size() > 1 && is_ome_set(path, files))
        return read_tiff(path, {files.front()}, options);
    const SliceStack stack = slice_stack(path, files, options.allow_gaps);
    Voxels v = format.read(path, stack.paths, options);
    v.notes.insert(v.notes.end(), stack.notes.begin(), stack.notes.end());
    v.decisions.insert(v.decisions.end(), stack.decisions.begin(), stack.decisions.end());
    return v;
}

/// The slices among the files of a folder, by format; what is left out is noted.
Voxels read_slices(const std::string& path, const std::map<VolumeFormat, std::vector<std::string>>& files,
                   const VolumeReadOptions& options) {
    std::optional<Voxels> v;
    const char* name = nullptr;
    for (const SliceFormat& format : slice_formats) {
        const auto found = files.find(format.format);
        if (found == files.end()) continue;
        if (!v) {
            v = read_stack(path, format, found->second, options);
            name = format.name;
            continue;
        }
        const std::size_t n = found->second.size();
        v->notes.push_back(fmt::format("{} {} file{} left out beside the {} slices", n, format.name, n == 1 ? " is" : "s are", name));
    }
    return std::move(*v);
}

/// Advice for pictures that clvr does not read.
std::string bitmaps(const std::vector<std::string>& files) {
    const auto is_bitmap = [](const std::string& file) { return ends_with(lower_case(file), ".bmp"); };
    const auto n = std::count_if(files.begin(), files.end(), is_bitmap);
    return n == 0 ? "" : fmt::format(" ({} BMP file{}: save them as PNG or TIFF)", n, n == 1 ? "" : "s");
}

/// Whether the folders inside `path` hold DICOM or TIFF.
bool has_volume_below(const std::string& path) {
    const std::vector<std::string> deep = files_in(path, true).paths;
    return std::any_of(deep.begin(), deep.end(), [](const std::string& file) {
        const VolumeFormat format = format_in_folder(file);
        return format == VolumeFormat::dicom || format == VolumeFormat::tiff;
    });
}

/// A DICOM series where any file is DICOM, else a stack of slices. Where nothing of a volume lies on top, the folders inside are searched
/// by themselves.
Voxels read_folder(const std::string& path, const VolumeReadOptions& options) {
    if (const std::string other = other_kind_of_folder(path); !other.empty()) bad_file(path, "this is {}", other);
    const FolderFiles all = files_in(path, options.recursive);
    const auto read = [&]() -> Voxels {
        std::map<VolumeFormat, std::vector<std::string>> files;
        for (const std::string& file : all.paths) {
            const VolumeFormat format = format_in_folder(file);
            if (format == VolumeFormat::dicom) return read_dicom(path, options);
            const auto is_slice = [&](const SliceFormat& s) { return s.format == format; };
            if (std::any_of(slice_formats.begin(), slice_formats.end(), is_slice)) files[format].push_back(file);
        }
        const bool only_pictures = !files.empty() && files.count(VolumeFormat::tiff) == 0; // they may be previews of what lies below
        if (only_pictures && !options.recursive && has_volume_below(path)) files.clear();
        if (!files.empty()) return read_slices(path, files, options);
        if (options.recursive)
            bad_file(path, "the folder holds neither DICOM nor TIFF, PNG or JPEG slices, nor do the folders inside it{}",
                     bitmaps(all.paths));
        VolumeReadOptions deep = options;
        deep.recursive = true;
        return read_folder(path, deep);
    };
    Voxels v = read();
    v.notes.insert(v.notes.end(), all.notes.begin(), all.notes.end());
    return v;
}

using Reader = Voxels (*)(const std::string& path, const VolumeReadOptions& options);
Voxels read_tiff_file(const std::string& path, const VolumeReadOptions& options) { return read_tiff(path, {path}, options); }
Voxels read_jpeg_file(const std::string& path, const VolumeReadOptions& options) { return read_jpeg_slices(path, {path}, options); }
Voxels read_png_file(const std::string& path, const VolumeReadOptions& options) { return read_png_slices(path, {path}, options); }

const std::map<VolumeFormat, Reader> readers{
    {VolumeFormat::nifti, read_nifti},    {VolumeFormat::nrrd, read_nrrd},      {VolumeFormat::metaimage, read_metaimage},
    {VolumeFormat::dicom, read_dicom},    {VolumeFormat::tiff, read_tiff_file}, {VolumeFormat::png, read_png_file},
    {VolumeFormat::jpeg, read_jpeg_file}, {VolumeFormat::vtk, read_vtk},        {VolumeFormat::vti, read_vti},
    {VolumeFormat::numpy, read_numpy},    {VolumeFormat::mrc, read_mrc},        {VolumeFormat::mgh, read_mgh},
    {VolumeFormat::hdf5, read_hdf5},      {VolumeFormat::raw, read_raw}};

/// Formats for which --spacing counts, as their files may hold no spacing.
bool takes_spacing(const std::string& format) {
    for (const char* taker : {"RAW", "TIFF", "PNG", "JPEG", "NumPy", "MRC", "HDF5", "Imaris"})
        if (starts_with(format, taker)) return true;
    return false;
}

Voxels read_any(const std::string& path, const VolumeReadOptions& options) {
    std::error_code error;
    const DatasetPath place = split_dataset_path(path);
    if (!place.inside.empty()) {
        if (format_of_file(place.file, options) != VolumeFormat::hdf5)
            bad_file(path, "{} is no HDF5 file: only those hold data sets that are named behind a colon", place.file);
        will_read(place.file);
        return read_hdf5(path, options);
    }
    const fs::file_status status = fs::status(path, error);
    if (const DatasetPath meant = file_within_path(path); status.type() == fs::file_type::not_found && !meant.inside.empty())
        bad_file(path, "{} is a file, not a folder: a data set of an HDF5 file is named {}", meant.file, join_dataset_path(meant));
    if (status.type() == fs::file_type::not_found) bad_file(path, "there is no such file or folder");
    if (error) bad_file(path, "cannot be read: {}", error.message());
    if (fs::is_directory(status)) return read_folder(path, options);
    if (!fs::is_regular_file(status)) bad_file(path, "neither a file nor a folder: expected a volume");
    will_read(path);
    return readers.at(format_of_file(path, options))(path, options);
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
        const bool raw = v.format == "RAW";
        if (!raw && (!options.type.empty() || !options.endian.empty()))
            v.notes.push_back("--type and --endian are for RAW files: the file's own were taken");
        if (options.spacing && !takes_spacing(v.format)) v.notes.push_back("--spacing is not for this format: the file's own was taken");
        return v;
    } catch (const fs::filesystem_error& e) {
        throw Error(ErrorKind::input, fmt::format("cannot be read: {}", e.code().message()), path);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::host_memory, "not enough memory for this volume", path);
    }
}

std::string volume_sha256(const Voxels& v) {
    return Hash()
        .add(fmt::format("{} {} {} {}\n", v.dims[0], v.dims[1], v.dims[2], voxel_type_name(v.type)))
        .add(v.bytes.data(), v.bytes.size())
        .hex();
}

} // namespace clvr

#include "host/io/volume/volume_file.hpp"
#include "host/io/byte_stream.hpp"
#include "host/io/volume/dataset_path.hpp"
#include "host/io/volume/folder.hpp"
#include "host/io/volume/format.hpp"
#include "host/io/volume/not_volumes.hpp"
#include "host/io/volume/readers.hpp"
#include "host/io/volume/samples.hpp"
#include "host/io/volume/slices.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <openssl/evp.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;

/// A DICOM series where any file is DICOM, else a stack of TIFF slices. Where nothing of a volume lies on top, the folders inside are
/// searched by themselves.
Voxels read_folder(const std::string& path, const VolumeReadOptions& options) {
    if (const std::string other = other_kind_of_folder(path); !other.empty()) bad_file(path, "this is {}", other);
    const FolderFiles all = files_in(path, options.recursive);
    std::vector<std::string> tiffs;
    const auto read = [&]() -> Voxels {
        for (const std::string& file : all.paths) {
            const VolumeFormat by_head = format_of_head(read_head(file, 1024)), by_name = format_of_name(file);
            if (by_head == VolumeFormat::dicom || (by_head == VolumeFormat::unknown && by_name == VolumeFormat::dicom))
                return read_dicom(path, options);
            if (by_head == VolumeFormat::tiff || (by_head == VolumeFormat::unknown && by_name == VolumeFormat::tiff)) tiffs.push_back(file);
        }
        if (tiffs.empty()) {
            if (options.recursive) bad_file(path, "the folder holds neither DICOM nor TIFF slices, nor do the folders inside it");
            VolumeReadOptions deep = options;
            deep.recursive = true;
            return read_folder(path, deep);
        }
        const SliceStack stack = slice_stack(path, tiffs);
        Voxels v = read_tiff(path, stack.paths, options);
        v.notes.insert(v.notes.end(), stack.notes.begin(), stack.notes.end());
        return v;
    };
    Voxels v = read();
    v.notes.insert(v.notes.end(), all.notes.begin(), all.notes.end());
    return v;
}

using Reader = Voxels (*)(const std::string& path, const VolumeReadOptions& options);
Voxels read_tiff_file(const std::string& path, const VolumeReadOptions& options) { return read_tiff(path, {path}, options); }

const std::map<VolumeFormat, Reader> readers{
    {VolumeFormat::nifti, read_nifti}, {VolumeFormat::nrrd, read_nrrd},      {VolumeFormat::metaimage, read_metaimage},
    {VolumeFormat::dicom, read_dicom}, {VolumeFormat::tiff, read_tiff_file}, {VolumeFormat::vtk, read_vtk},
    {VolumeFormat::numpy, read_numpy}, {VolumeFormat::mrc, read_mrc},        {VolumeFormat::mgh, read_mgh},
    {VolumeFormat::hdf5, read_hdf5},   {VolumeFormat::raw, read_raw}};

/// Formats that --spacing speaks to: theirs may have none.
bool takes_spacing(const std::string& format) {
    for (const char* taker : {"RAW", "TIFF", "NumPy", "MRC", "HDF5", "Imaris"})
        if (starts_with(format, taker)) return true;
    return false;
}

Voxels read_any(const std::string& path, const VolumeReadOptions& options) {
    std::error_code error;
    const DatasetPath place = split_dataset_path(path);
    if (!place.inside.empty()) {
        if (format_of_file(place.file, options) != VolumeFormat::hdf5)
            bad_file(path, "{} is no HDF5 file: only those hold data sets that are named behind a colon", place.file);
        return read_hdf5(path, options);
    }
    const fs::file_status status = fs::status(path, error);
    if (const DatasetPath meant = file_within_path(path); status.type() == fs::file_type::not_found && !meant.inside.empty())
        bad_file(path, "{} is a file, not a folder: a data set of an HDF5 file is named {}", meant.file, join_dataset_path(meant));
    if (status.type() == fs::file_type::not_found) bad_file(path, "there is no such file or folder");
    if (error) bad_file(path, "cannot be read: {}", error.message());
    if (fs::is_directory(status)) return read_folder(path, options);
    if (!fs::is_regular_file(status)) bad_file(path, "neither a file nor a folder: expected a volume");
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

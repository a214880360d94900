#include "host/io/volume/not_volumes.hpp"
#include "host/io/volume/file_pair.hpp"
#include "host/io/volume/format.hpp"
#include "host/io/volume/header_text.hpp"

#include <filesystem>
#include <utility>
#include <vector>

namespace clvr {

namespace {

using Kinds = std::vector<std::pair<std::string, const char*>>;

constexpr const char *archive = "an archive: unpack it, a .npz holds .npy files, which are read",
                     *czi = "a Zeiss CZI file: save it as OME-TIFF, for instance with Fiji",
                     *nd2 = "a Nikon ND2 file: save it as OME-TIFF, for instance with Fiji",
                     *lif = "a Leica LIF file: save it as OME-TIFF, for instance with Fiji",
                     *olympus = "an Olympus file (OIB, OIF): save it as OME-TIFF, for instance with Fiji",
                     *digital_micrograph = "a Digital Micrograph file: save it as TIFF, for instance with Fiji",
                     *matlab = "a MATLAB file before version 7.3: save it with -v7.3, which is HDF5, or as NIfTI with niftiwrite",
                     *netcdf3 = "a netCDF 3 file, of MINC 1 perhaps: convert it to NIfTI with mnc2nii",
                     *philips = "Philips PAR/REC: convert it to NIfTI with dcm2niix",
                     *afni = "an AFNI data set: convert it to NIfTI with 3dAFNItoNIFTI", *picture = "a picture, not a volume",
                     *surface = "a surface, not a volume: clvr renders voxels", *document = "a document, not a volume",
                     *fits = "a FITS file: save its cube as .npy, with Astropy and NumPy",
                     *vdb = "an OpenVDB file: sample its grid into a NumPy array and save it as .npy",
                     *bruker = "Bruker ParaVision data: convert them to NIfTI, with brkraw for instance",
                     *envi = "an ENVI or Interfile header: give its voxels as RAW, with --dims and --type",
                     *vol = "a .vol file, which says nothing of its voxels: name it name_WxHxD_type.raw, or give --dims and --type";

} // namespace

std::string other_kind_of_head(const std::string& head) {
    static const Kinds marks{{"PK\x03\x04", archive},
                             {"7z\xbc\xaf\x27\x1c", archive},
                             {"Rar!\x1a", archive},
                             {"BZh", "compressed by bzip2: unpack it with bunzip2"},
                             {"\xfd"
                              "7zXZ",
                              "compressed by xz: unpack it with unxz"},
                             {"\x28\xb5\x2f\xfd", "compressed by Zstandard: unpack it with unzstd"},
                             {"ZISRAWFILE", czi},
                             {"\xda\xce\xbe\x0a", nd2},
                             {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", olympus},
                             {"MATLAB 5.0", matlab},
                             {"CDF\x01", netcdf3},
                             {"CDF\x02", netcdf3},
                             {"CDF\x05", netcdf3},
                             {"# === DATA DESCRIPTION FILE", philips},
                             {"GIF8", picture},
                             {"#?RADIANCE", picture},
                             {"\x76\x2f\x31\x01", "an OpenEXR picture, not a volume: clvr denoise reads it"},
                             {"%PDF", document},
                             {"SIMPLE  =", fits},
                             {{"\x20"
                               "BDV\0\0\0\0",
                               8},
                              vdb},
                             {"ENVI", envi},
                             {"!INTERFILE", envi},
                             {"##TITLE=", bruker}};
    for (const auto& [mark, kind] : marks)
        if (starts_with(head, mark)) return kind;
    return {};
}

std::string other_kind_of_name(const std::string& path) {
    static const Kinds endings{{".npz", archive},
                               {".zip", archive},
                               {".tar", archive},
                               {".tar.gz", archive},
                               {".tgz", archive},
                               {".czi", czi},
                               {".nd2", nd2},
                               {".lif", lif},
                               {".oib", olympus},
                               {".oif", olympus},
                               {".dm3", digital_micrograph},
                               {".dm4", digital_micrograph},
                               {".mat", matlab},
                               {".mnc", netcdf3},
                               {".nc", netcdf3},
                               {".par", philips},
                               {".head", afni},
                               {".brik", afni},
                               {".brik.gz", afni},
                               {".bmp", picture},
                               {".gif", picture},
                               {".pgm", picture},
                               {".ppm", picture},
                               {".stl", surface},
                               {".obj", surface},
                               {".ply", surface},
                               {".gltf", surface},
                               {".glb", surface},
                               {".vtp", surface},
                               {".pdf", document},
                               {".fits", fits},
                               {".fit", fits},
                               {".fits.gz", fits},
                               {".vdb", vdb},
                               {".nvdb", vdb},
                               {"2dseq", bruker},
                               {".vol", vol}};
    const std::string name = lower_case(std::filesystem::path(path).filename().string());
    for (const auto& [ending, kind] : endings)
        if (ends_with(name, ending)) return kind;
    return file_beside(path, {".rec"}, {".par"}).empty() ? "" : philips; // MRC files end in .rec too
}

std::string other_kind_of_folder(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const auto has = [&](const char* name) { return fs::exists(fs::path(path) / name, error); };
    if (has(".zarray") || has(".zgroup") || has("zarr.json") || has(".zattrs"))
        return "a Zarr store: save the level you want as .npy, HDF5 or OME-TIFF";
    if (has("2dseq") && has("visu_pars")) return bruker;
    return {};
}

} // namespace clvr

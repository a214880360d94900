// Every container that clvr reads, written from one sample: what the suites over all formats run on.
#pragma once
#include "host/io/volume/volume_file.hpp"
#include "tests/io/dicom_writers.hpp"
#include "tests/io/hdf5_writers.hpp"
#include "tests/io/mgh_writers.hpp"
#include "tests/io/mrc_writers.hpp"
#include "tests/io/numpy_writers.hpp"
#include "tests/io/text_header_writers.hpp"
#include "tests/io/tiff_writers.hpp"
#include "tests/io/volume_writers.hpp"

#include <ostream>

namespace clvr::test {

struct Written {
    std::string path;    ///< what is read
    std::string payload; ///< the file that holds (the last of) the voxels: what the damage goes to
};

struct VolumeFormat {
    const char* name;
    Written (*write)(const Folder& to, const Sample& s);
    enum Keeps { geometry, spacing_and_origin, spacing_only, no_geometry } keeps = geometry;
    bool checksum = false; ///< a flipped bit among the voxels is found
    int spare = 1;         ///< how many bytes at the end must be cut to lose something
    int step = 1;          ///< the slow suite damages one byte of so many: a reader that starts a process takes long

    friend void PrintTo(const VolumeFormat& f, std::ostream* out) { *out << f.name; }
};

inline Written single(const std::string& path, const std::string& bytes) {
    write(path, bytes);
    return {path, path};
}
inline Written two(const std::string& header_path, const std::string& header, const std::string& data_path, const std::string& data) {
    write(header_path, header);
    write(data_path, data);
    return {header_path, data_path};
}
inline std::string text_of(const Sample& s) { return text_of(s.voxels); }
/// One .vti; `spare` of its format must be that of its mode.
template <VtiFields::Mode mode, VtiFields::Compressor compressor, bool big>
Written vti_file(const Folder& to, const Sample& s) {
    VtiFields f;
    f.mode = mode, f.compressor = compressor, f.big = f.wide_header = big;
    if (big) f.first = {2, -1, 5};
    return single(to / "a.vti", vti(s, f));
}
inline Written dicom_folder(const Folder& to, const Sample& s, bool rle) {
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.rle = rle;
        write(to / fmt::format("series/{}.dcm", k), dicom(f));
    }
    return {to / "series", to / fmt::format("series/{}.dcm", s.dims[2] / 2)};
}

inline const std::vector<VolumeFormat>& volume_formats() {
    static const std::string sidecar =
        R"({"spacing": [0.5, 0.75, 2], "origin": [-10.5, 20.25, 31], "direction": [0.866025, -0.5, 0, 0.5, 0.866025, 0, 0, 0, 1]})";
    static const auto raw_name = [](const Sample& s) { return fmt::format("sample_{}x{}x{}_int16", s.dims[0], s.dims[1], s.dims[2]); };
    static const auto big = [](const Sample& s) { return bytes_of(s.voxels, true); };
    static const auto little = [](const Sample& s) { return bytes_of(s.voxels); };
    static const auto packed_tiff = [](const Sample& s, std::uint16_t compression, std::uint32_t tile) {
        auto pages = tiff_pages(s);
        for (auto& p : pages) p.compression = compression, p.tile = tile;
        return tiff(pages);
    };
    static const int vti_spare = static_cast<int>(std::string(vti_tail).size()) + 1;
    static const std::vector<VolumeFormat> formats{
        {"nifti", [](const Folder& to, const Sample& s) { return single(to / "a.nii", nifti(s)); }},
        {"nifti_gzip", [](const Folder& to, const Sample& s) { return single(to / "a.nii.gz", deflated(nifti(s))); },
         VolumeFormat::geometry, true},
        {"nifti_2_big_endian",
         [](const Folder& to, const Sample& s) {
             NiftiFields f;
             f.version = 2, f.big = true;
             return single(to / "a.nii", nifti(s, f, big(s)));
         }},
        {"nifti_pair",
         [](const Folder& to, const Sample& s) {
             NiftiFields f;
             f.pair = true;
             return two(to / "a.hdr", nifti_header(s, f), to / "a.img", little(s));
         }},
        {"nrrd", [](const Folder& to, const Sample& s) { return single(to / "a.nrrd", nrrd_header(s, "raw") + "\n" + little(s)); }},
        {"nrrd_gzip",
         [](const Folder& to, const Sample& s) { return single(to / "a.nrrd", nrrd_header(s, "gzip") + "\n" + deflated(little(s))); },
         VolumeFormat::geometry, true},
        {"nrrd_detached",
         [](const Folder& to, const Sample& s) {
             return two(to / "a.nhdr", nrrd_header(s, "raw", "data file: a.raw\n"), to / "a.raw", little(s));
         }},
        {"nrrd_text", [](const Folder& to, const Sample& s) { return single(to / "a.nrrd", nrrd_header(s, "ascii") + "\n" + text_of(s)); },
         VolumeFormat::geometry, false, 8},
        {"nrrd_bzip2",
         [](const Folder& to, const Sample& s) { return single(to / "a.nrrd", nrrd_header(s, "bzip2") + "\n" + bzip2ed(little(s))); }},
        {"nrrd_hex",
         [](const Folder& to, const Sample& s) { return single(to / "a.nrrd", nrrd_header(s, "hex") + "\n" + hexed(little(s))); },
         VolumeFormat::geometry, false, 2},
        {"nrrd_list",
         [](const Folder& to, const Sample& s) {
             const auto names = write_slices(to, s, "s{:02}.raw");
             write(to / "a.nhdr", nrrd_header(s, "raw", "data file: LIST\n" + lines_of(names)));
             return Written{to / "a.nhdr", to / names.back()};
         }},
        {"metaimage_text",
         [](const Folder& to, const Sample& s) {
             return single(to / "a.mha", replaced(metaimage_header(s, ""), "BinaryData = True", "BinaryData = False") + text_of(s));
         },
         VolumeFormat::geometry, false, 8},
        {"metaimage_list",
         [](const Folder& to, const Sample& s) {
             const auto names = write_slices(to, s, "s{:02}.raw");
             write(to / "a.mhd", metaimage_header(s, "", "LIST") + lines_of(names));
             return Written{to / "a.mhd", to / names.front()};
         }},
        {"metaimage", [](const Folder& to, const Sample& s) { return single(to / "a.mha", metaimage_header(s, "") + little(s)); }},
        {"metaimage_zlib",
         [](const Folder& to, const Sample& s) {
             const std::string packed = deflated(little(s), false);
             return single(to / "a.mha",
                           metaimage_header(s, fmt::format("CompressedData = True\nCompressedDataSize = {}\n", packed.size())) + packed);
         },
         VolumeFormat::geometry, true},
        {"metaimage_detached",
         [](const Folder& to, const Sample& s) { return two(to / "a.mhd", metaimage_header(s, "", "a.raw"), to / "a.raw", little(s)); }},
        {"vtk", [](const Folder& to, const Sample& s) { return single(to / "a.vtk", vtk_header(s) + big(s)); },
         VolumeFormat::spacing_and_origin},
        {"vtk_text", [](const Folder& to, const Sample& s) { return single(to / "a.vtk", vtk_header(s, "ASCII") + text_of(s)); },
         VolumeFormat::spacing_and_origin, false, 8},
        {"vti_text", vti_file<VtiFields::ascii, VtiFields::none, false>},
        {"vti_base64", vti_file<VtiFields::binary, VtiFields::none, false>},
        {"vti_base64_zlib", vti_file<VtiFields::binary, VtiFields::zlib, true>},
        {"vti_raw", vti_file<VtiFields::appended_raw, VtiFields::none, true>, VolumeFormat::geometry, false, vti_spare},
        {"vti_raw_lz4", vti_file<VtiFields::appended_raw, VtiFields::lz4, false>, VolumeFormat::geometry, false, vti_spare},
        {"vti_appended_base64", vti_file<VtiFields::appended_base64, VtiFields::none, false>, VolumeFormat::geometry, false, vti_spare + 2},
        {"vti_appended_base64_zlib", vti_file<VtiFields::appended_base64, VtiFields::zlib, false>, VolumeFormat::geometry, false,
         vti_spare + 2},
        {"tiff", [](const Folder& to, const Sample& s) { return single(to / "a.tif", tiff(tiff_pages(s))); }, VolumeFormat::no_geometry},
        {"tiff_deflate", [](const Folder& to, const Sample& s) { return single(to / "a.tif", packed_tiff(s, 8, 0)); },
         VolumeFormat::no_geometry},
        {"tiff_tiles", [](const Folder& to, const Sample& s) { return single(to / "a.tif", packed_tiff(s, 1, 16)); },
         VolumeFormat::no_geometry},
        {"tiff_ome",
         [](const Folder& to, const Sample& s) {
             const Double3 mm = s.geometry.spacing;
             const std::string sizes = fmt::format(
                 R"(SizeX="{}" SizeY="{}" SizeC="1" SizeZ="{}" SizeT="1" DimensionOrder="XYZCT" PhysicalSizeX="{}" PhysicalSizeY="{}" PhysicalSizeZ="{}")",
                 s.dims[0], s.dims[1], s.dims[2], 1000 * mm[0], 1000 * mm[1], 1000 * mm[2]);
             auto pages = tiff_pages(s);
             pages[0].description = ome_xml(sizes);
             return single(to / "a.ome.tif", tiff(pages));
         },
         VolumeFormat::spacing_only},
        {"tiff_imagej_one_directory",
         [](const Folder& to, const Sample& s) {
             return single(to / "a.tif", one_directory(s.dims, s.voxels,
                                                       fmt::format("ImageJ=1.53t\nimages={}\nslices={}\n", s.dims[2], s.dims[2]), true));
         },
         VolumeFormat::no_geometry},
        {"tiff_image_depth", [](const Folder& to, const Sample& s) { return single(to / "a.tif", deep_tiff(s.dims, s.voxels)); },
         VolumeFormat::no_geometry},
        {"tiff_folder",
         [](const Folder& to, const Sample& s) {
             const auto pages = tiff_pages(s);
             for (std::size_t k = 0; k < pages.size(); ++k)
                 write(to / fmt::format("stack/slice{}.tif", k + 8), tiff({pages[k]})); // 8, 9, 10: by number, not by letter
             return Written{to / "stack", to / "stack/slice9.tif"};
         },
         VolumeFormat::no_geometry},
        {"dicom", [](const Folder& to, const Sample& s) { return dicom_folder(to, s, false); }},
        {"dicom_enhanced",
         [](const Folder& to, const Sample& s) { return single(to / "a.dcm", dicom_file(enhanced_set(s, all_frames(s)))); },
         VolumeFormat::geometry, false, 1, 5},
        {"dicom_enhanced_implicit",
         [](const Folder& to, const Sample& s) {
             return single(to / "a.dcm", dicom_file(enhanced_set(s, all_frames(s)), DicomSyntax{true}, true));
         },
         VolumeFormat::geometry, false, 1, 5},
        {"dicom_enhanced_deflated",
         [](const Folder& to, const Sample& s) {
             return single(to / "a.dcm", dicom_file(enhanced_set(s, all_frames(s)), DicomSyntax{false, false, true}));
         },
         VolumeFormat::geometry, false, 1, 5},
        {"dicom_mosaic", [](const Folder& to, const Sample& s) { return single(to / "a.ima", dicom_file(mosaic_set(s))); },
         VolumeFormat::geometry, false, 1, 5},
        {"dicom_rle", [](const Folder& to, const Sample& s) { return dicom_folder(to, s, true); }, VolumeFormat::geometry, false, 1, 7},
        {"numpy", [](const Folder& to, const Sample& s) { return single(to / "a.npy", numpy(s)); }, VolumeFormat::no_geometry},
        {"numpy_gzip", [](const Folder& to, const Sample& s) { return single(to / "a.npy.gz", deflated(numpy(s))); },
         VolumeFormat::no_geometry, true},
        {"mrc", [](const Folder& to, const Sample& s) { return single(to / "a.mrc", mrc(s)); }, VolumeFormat::spacing_and_origin},
        {"mrc_big_endian",
         [](const Folder& to, const Sample& s) {
             MrcFields f;
             f.big = true, f.extended_bytes = 80;
             return single(to / "a.map", mrc(s, f));
         },
         VolumeFormat::spacing_and_origin},
        {"mgh", [](const Folder& to, const Sample& s) { return single(to / "a.mgh", mgh(s)); }},
        {"mgz", [](const Folder& to, const Sample& s) { return single(to / "a.mgz", deflated(mgh(s))); }, VolumeFormat::geometry, true},
        {"hdf5",
         [](const Folder& to, const Sample& s) {
             write_hdf5(to / "a.h5", s, false);
             return Written{to / "a.h5:/volume", to / "a.h5"};
         },
         VolumeFormat::no_geometry, false, 1, 17},
        {"hdf5_gzip",
         [](const Folder& to, const Sample& s) {
             write_hdf5(to / "a.h5", s, true);
             return Written{to / "a.h5", to / "a.h5"};
         },
         VolumeFormat::no_geometry, false, 1, 17},
        {"imaris",
         [](const Folder& to, const Sample& s) {
             write_imaris(to / "a.ims", s);
             return Written{to / "a.ims", to / "a.ims"};
         },
         VolumeFormat::spacing_and_origin, false, 1, 37},
        {"raw",
         [](const Folder& to, const Sample& s) {
             write(to / (raw_name(s) + ".json"), sidecar);
             return single(to / (raw_name(s) + ".raw"), little(s));
         }},
        {"raw_gzip",
         [](const Folder& to, const Sample& s) {
             write(to / (raw_name(s) + ".json"), sidecar);
             return single(to / (raw_name(s) + ".raw.gz"), deflated(little(s)));
         },
         VolumeFormat::geometry, true}};
    return formats;
}

/// Reads a damaged file: an Error, or a volume whose parts fit together. Anything else is a failure of the test.
inline bool reads_or_throws(const std::string& path) {
    try {
        const Voxels v = read_volume(path);
        EXPECT_EQ(v.bytes.size(), v.count() * voxel_bytes(v.type));
        EXPECT_GT(v.count(), 0u);
        return true;
    } catch (const Error& e) {
        EXPECT_TRUE(e.kind() == ErrorKind::input || e.kind() == ErrorKind::host_memory) << e.line();
        return false;
    }
}

} // namespace clvr::test

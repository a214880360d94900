// Every container that clvr reads, written from one sample: what the suites over all formats run on.
#pragma once
#include "host/io/volume/volume_file.hpp"
#include "tests/io/dicom_writers.hpp"
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
    enum Keeps { geometry, spacing_and_origin, no_geometry } keeps = geometry;
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
inline std::string text_of(const Sample& s) {
    std::string text;
    for (const auto v : s.voxels) text += fmt::format("{}\n", v);
    return text;
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
        {"tiff", [](const Folder& to, const Sample& s) { return single(to / "a.tif", tiff(tiff_pages(s))); }, VolumeFormat::no_geometry},
        {"tiff_deflate", [](const Folder& to, const Sample& s) { return single(to / "a.tif", packed_tiff(s, 8, 0)); },
         VolumeFormat::no_geometry},
        {"tiff_tiles", [](const Folder& to, const Sample& s) { return single(to / "a.tif", packed_tiff(s, 1, 16)); },
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
        EXPECT_TRUE(e.kind() == ErrorKind::input || e.kind() == ErrorKind::memory) << e.line();
        return false;
    }
}

} // namespace clvr::test

// Files that people try and that are no volumes: each is named, with what to do; and gzip around what is read.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/numpy_writers.hpp"

#include <utility>

namespace clvr::test {
namespace {

TEST(OtherKinds, AreKnownByTheirBytesWhateverTheName) {
    const Folder folder;
    for (const auto& [bytes, word] : std::vector<std::pair<std::string, std::string>>{{"PK\x03\x04", "archive"},
                                                                                      {"ZISRAWFILE", "CZI"},
                                                                                      {"\xda\xce\xbe\x0a", "ND2"},
                                                                                      {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "Olympus"},
                                                                                      {"MATLAB 5.0 MAT-file", "-v7.3"},
                                                                                      {"CDF\x01", "mnc2nii"},
                                                                                      {"#?RADIANCE\n", "picture"},
                                                                                      {"%PDF-1.7", "document"},
                                                                                      {"SIMPLE  =    T", "FITS"},
                                                                                      {"BZh9", "bunzip2"}})
        for (const char* name : {"a.dat", "b.nii", "c.tif"})
            expect_error([&] { read_volume(write(folder / name, bytes + std::string(600, ' '))); }, {word});
}

TEST(OtherKinds, AreKnownByTheirNamesInAnyCase) {
    const Folder folder;
    for (const auto& [name, word] : std::vector<std::pair<const char*, const char*>>{{"a.npz", ".npy"},
                                                                                     {"a.LIF", "OME-TIFF"},
                                                                                     {"a.dm3", "Digital Micrograph"},
                                                                                     {"a.Dm4", "Digital Micrograph"},
                                                                                     {"a+orig.HEAD", "3dAFNItoNIFTI"},
                                                                                     {"a+orig.BRIK.gz", "3dAFNItoNIFTI"},
                                                                                     {"a.PAR", "dcm2niix"},
                                                                                     {"2dseq", "Bruker"},
                                                                                     {"a.stl", "surface"},
                                                                                     {"a.obj", "surface"},
                                                                                     {"a.pgm", "picture"},
                                                                                     {"a.vol", "--dims"},
                                                                                     {"a 100%.mat", "-v7.3"}})
        expect_error([&] { read_volume(write(folder / name, "some bytes of another kind")); }, {word});
}

TEST(OtherKinds, AZarrFolderIsNamed) {
    const Folder folder;
    write(folder / "a.zarr/.zgroup", "{}");
    write(folder / "a.zarr/0/.zarray", "{}");
    expect_error([&] { read_volume(folder / "a.zarr"); }, {"Zarr"});
}

TEST(OtherKinds, GzipIsReadAroundWhatReadsItAndElseNamed) {
    const Folder folder;
    const Sample s;
    EXPECT_EQ(read_volume(write(folder / "a", deflated(numpy(s)))).dims, s.dims);
    const std::string nrrd = nrrd_header(s, "raw") + "\n" + bytes_of(s.voxels);
    expect_error([&] { read_volume(write(folder / "a.nrrd.gz", deflated(nrrd))); }, {"gunzip", "is read then"});
    expect_error([&] { read_volume(write(folder / "a.txt.gz", deflated("just text"))); }, {"inside gzip", "Read are"});
}

} // namespace
} // namespace clvr::test

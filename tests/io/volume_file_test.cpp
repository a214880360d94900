// What is a volume at all, by content and by name; the hash.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/volume_writers.hpp"

#include <sys/stat.h>

namespace clvr::test {
namespace {

TEST(VolumeFile, ContentCountsMoreThanTheName) {
    const Folder folder;
    const Sample s;
    EXPECT_EQ(read_volume(write(folder / "a.dat", nifti(s))).format, "NIfTI");
    EXPECT_EQ(read_volume(write(folder / "b", deflated(nifti(s)))).format, "NIfTI");
    EXPECT_EQ(read_volume(write(folder / "c.nii", nrrd_header(s, "raw") + "\n" + bytes_of(s.voxels))).format, "NRRD");
    EXPECT_EQ(read_volume(write(folder / "d.tif", vtk_header(s) + bytes_of(s.voxels, true))).format, "VTK image");
    EXPECT_EQ(read_volume(write(folder / "e", tiff(tiff_pages(s)))).format, "TIFF");
}

TEST(VolumeFile, RefusesWhatIsNoVolume) {
    const Folder folder;
    expect_error([&] { read_volume(folder / "nothing.nii"); }, {"nothing.nii", "no such file"});
    expect_error([&] { read_volume(folder.path()); }, {"neither DICOM nor TIFF"});
    write(folder / "text/readme.txt", "hello");
    expect_error([&] { read_volume(folder / "text"); }, {"neither DICOM nor TIFF"});
    expect_error([&] { read_volume(folder / "text/readme.txt"); },
                 {"not a volume", "NIfTI", "NRRD", "MetaImage", "DICOM", "TIFF", "VTK", "NumPy", "MRC", "MGH", "HDF5", "RAW"});
    expect_error([&] { read_volume(write(folder / "empty.nii", "")); }, {"empty"});
    expect_error([&] { read_volume(write(folder / "x.gz", deflated("just text"))); }, {"not a volume", "gzip"});
    expect_error([&] { read_volume(write(folder / "x.nii.gz", "\x1f\x8bnot gzip at all")); }, {"corrupt"});
    expect_error([&] { read_volume(write(folder / "x.nii", "not nifti at all")); }, {"truncated"});
    std::filesystem::create_symlink("gone", folder / "dangling.nii");
    expect_error([&] { read_volume(folder / "dangling.nii"); }, {"no such file"});
    ASSERT_EQ(mkfifo((folder / "pipe.nii").c_str(), 0600), 0);
    expect_error([&] { read_volume(folder / "pipe.nii"); }, {"neither a file nor a folder"}); // and does not wait for a writer
}

TEST(VolumeFile, RefusesAnUnreadableFile) {
    if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
    const Folder folder;
    const std::string path = write(folder / "a.nii", nifti(Sample()));
    std::filesystem::permissions(path, std::filesystem::perms::none);
    expect_error([&] { read_volume(path); }, {"cannot be read", "Permission denied"});
}

TEST(VolumeFile, SaysWhenAnOptionIsNotForTheFormat) {
    const Folder folder;
    VolumeReadOptions options;
    options.spacing = Double3{1, 1, 1};
    options.type = "uint8";
    EXPECT_EQ(read_volume(write(folder / "a.nii", nifti(Sample())), options).notes.size(), 2u);
}

TEST(VolumeFile, HashDependsOnDimsTypeAndVoxelsAlone) {
    const Folder folder;
    const Sample s;
    const Voxels v = read_volume(write(folder / "a.nii", nifti(s)));
    Voxels w = read_volume(write(folder / "b.mha", metaimage_header(s, "") + bytes_of(s.voxels)));
    const std::string hash = volume_sha256(v);
    EXPECT_EQ(hash.size(), 64u);
    EXPECT_EQ(volume_sha256(w), hash);
    w.geometry.spacing = {9, 9, 9};
    EXPECT_EQ(volume_sha256(w), hash);
    w.type = VoxelType::u16;
    EXPECT_NE(volume_sha256(w), hash);
    w.type = VoxelType::i16;
    w.dims = {4, 5, 3};
    EXPECT_NE(volume_sha256(w), hash);
    w.dims = s.dims;
    w.bytes[7] ^= 1;
    EXPECT_NE(volume_sha256(w), hash);
}

TEST(VolumeFile, HashIsThatOfTheWrittenText) {
    Voxels v; // sha256 of "2 1 1 u8\n" and bytes 1, 2, by another program
    v.dims = {2, 1, 1};
    v.bytes = {1, 2};
    EXPECT_EQ(volume_sha256(v), "4079d87a29992d425f101505616fe3d33dcfd0353a832c058efffb7be8272ea0");
}

} // namespace
} // namespace clvr::test

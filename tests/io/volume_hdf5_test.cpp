// HDF5 by FILE:/path/of/dataset, and Imaris.
#include "host/io/scene/scene_file.hpp"
#include "host/io/volume/volume_file.hpp"
#include "tests/io/hdf5_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// 0, 1, 2, ...
std::vector<std::int16_t> counted(std::size_t n) {
    std::vector<std::int16_t> values(n);
    for (std::size_t i = 0; i < n; ++i) values[i] = static_cast<std::int16_t>(i);
    return values;
}
VolumeReadOptions reading(int frame, std::optional<int> channel = {}) {
    VolumeReadOptions o;
    o.frame = frame;
    o.channel = channel;
    return o;
}

TEST(VolumeHdf5, ReadsTypesAsTheFileStoresThem) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "a.h5");
        h.dataset<std::uint8_t>("/u8", {1, 1, 2}, {254, 1});
        h.dataset<std::int16_t>("/big", {1, 1, 2}, {-300, 3}, {}, false, H5T_STD_I16BE);
        h.dataset<std::int32_t>("/i32", {1, 1, 2}, {-70000, 3}, {}, false, H5T_STD_I32BE);
        h.dataset<double>("/f64", {1, 1, 2}, {-0.5, 3});
        h.dataset<float>("/f32", {1, 1, 2}, {-0.5, 3}, {}, false, H5T_IEEE_F32BE);
        const hid_t half = H5Tcopy(H5T_IEEE_F32LE); // IEEE binary16
        H5Tset_fields(half, 15, 10, 5, 0, 10);
        H5Tset_size(half, 2);
        H5Tset_ebias(half, 15);
        h.dataset<float>("/f16", {1, 1, 2}, {-2.5f, 0.333251953125f}, {}, false, half);
        H5Tclose(half);
        const hid_t yes_no = H5Tenum_create(H5T_NATIVE_INT8);
        for (std::int8_t i = 0; i < 2; ++i) H5Tenum_insert(yes_no, i ? "TRUE" : "FALSE", &i);
        h.dataset<std::int16_t>("/bool", {1, 1, 2}, {}, {}, false, yes_no);
        H5Tclose(yes_no);
    }
    const auto two = [&](const char* name) { return values_of(read_volume(folder / "a.h5:" + name)); };
    EXPECT_THAT(two("/u8"), ElementsAre(254, 1));
    EXPECT_THAT(two("/big"), ElementsAre(-300, 3));
    EXPECT_THAT(two("big"), ElementsAre(-300, 3)); // the first / may be left out
    EXPECT_THAT(two("/i32"), ElementsAre(-70000, 3));
    EXPECT_THAT(two("/f64"), ElementsAre(-0.5, 3));
    EXPECT_THAT(two("/f32"), ElementsAre(-0.5, 3));
    EXPECT_THAT(two("/f16"), ElementsAre(-2.5, 0.333251953125));
    expect_error([&] { two("/bool"); }, {"empty"});
    EXPECT_EQ(read_volume(folder / "a.h5:/u8").type, VoxelType::u8);
    EXPECT_EQ(read_volume(folder / "a.h5:/f16").type, VoxelType::f32);
}

TEST(VolumeHdf5, AFileOfSeveralDataSetsListsThem) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "my scan: 50%.h5");
        h.dataset("/volume/raw", {3, 4, 5}, counted(60));
        h.dataset("/volume/mask", {3, 4, 5}, std::vector<std::uint8_t>(60, 1));
        h.dataset("/other/only", {2, 4, 5}, counted(40));
        h.dataset("/table", {3, 4}, counted(12));
        h.group("/empty");
    }
    const std::string file = folder / "my scan: 50%.h5";
    expect_error([&] { read_volume(file); },
                 {"holds 3 data sets", file + ":/volume/raw (3 x 4 x 5 i16)", file + ":/volume/mask (3 x 4 x 5 u8)"});
    expect_error([&] { read_volume(file + ":/volume"); }, {"2 data sets"});
    expect_error([&] { read_volume(file + ":"); }, {"3 data sets"});
    const Voxels v = read_volume(file + ":/other");
    EXPECT_EQ(v.dims, (Int3{5, 4, 2}));
    EXPECT_THAT(v.decisions, Contains(HasSubstr("/other/only, the only one")));
    EXPECT_EQ(read_volume(file + ":/table").dims, (Int3{4, 3, 1}));
    expect_error([&] { read_volume(file + ":/volume/rwa"); }, {"no data set /volume/rwa", file + ":/volume/raw (3 x 4 x 5 i16)"});
    expect_error([&] { read_volume(file + ":/empty"); }, {"no data set in /empty"});
    expect_error([&] { read_volume(folder / "gone.h5:/volume"); }, {"no such file"});
    expect_error([&] { read_volume(file + "/volume/raw"); }, {"is named " + file + ":/volume/raw"});
    expect_error([&] { read_volume(write(folder / "a.nii", nifti(Sample())) + ":/volume"); }, {"a.nii is no HDF5 file"});
}

TEST(VolumeHdf5, TakesSpacingInMicrometresAndByOption) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "a.h5");
        h.dataset("/v", {3, 4, 5}, counted(60));
        h.numbers("/v", "element_size_um", {2, 0.5, 0.25}); // z, y, x
        h.dataset("/bad", {3, 4, 5}, counted(60));
        h.numbers("/bad", "element_size_um", {0, 0.5, 0.25});
        h.dataset("/unknown", {3, 4, 5}, counted(60));
        h.numbers("/unknown", "resolution", {2, 0.5, 0.25});
    }
    const Voxels v = read_volume(folder / "a.h5:/v");
    EXPECT_NEAR(v.geometry.spacing[0], 0.25e-3, 1e-12);
    EXPECT_NEAR(v.geometry.spacing[1], 0.5e-3, 1e-12);
    EXPECT_NEAR(v.geometry.spacing[2], 2e-3, 1e-12);
    EXPECT_TRUE(v.notes.empty());
    EXPECT_THAT(v.decisions, Contains("spacing from element_size_um"));
    expect_error([&] { read_volume(folder / "a.h5:/bad"); }, {"spacing"});
    VolumeReadOptions options;
    options.spacing = Double3{1, 2, 3};
    EXPECT_EQ(read_volume(folder / "a.h5:/bad", options).geometry.spacing, (Double3{1, 2, 3}));
    const Voxels unknown = read_volume(folder / "a.h5:/unknown");
    EXPECT_EQ(unknown.geometry.spacing, (Double3{1, 1, 1}));
    EXPECT_THAT(unknown.notes, Contains(HasSubstr("resolution")));
}

TEST(VolumeHdf5, LabelsTellTheAxes) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "a.h5");
        h.dataset("/tczyx", {2, 3, 4, 5, 6}, counted(720), {1, 2, 2, 3, 4}, true);
        h.texts("/tczyx", "DIMENSION_LABELS", {"t", "c", "z", "y", "x"});
        h.numbers("/tczyx", "element_size_um", {1, 1, 3000, 2000, 1000});
        h.dataset("/xyzc", {6, 5, 4, 3}, counted(360));
        h.text("/xyzc", "axistags", R"({"axes": [{"key": "x"}, {"key": "y"}, {"key": "z"}, {"key": "c"}]})");
        h.dataset("/energy", {4, 5, 6, 7}, counted(840));
        h.texts("/energy", "DIMENSION_LABELS", {"energy", "z", "y", "x"});
    }
    for (const auto& [t, c] : {std::pair{0, 0}, {1, 2}}) {
        const Voxels v = read_volume(folder / "a.h5:/tczyx", reading(t, c));
        ASSERT_EQ(v.dims, (Int3{6, 5, 4}));
        EXPECT_EQ(v.geometry.spacing, (Double3{1, 2, 3}));
        for (int i = 0; i < 120; ++i) ASSERT_EQ(v.data<std::int16_t>()[i], (t * 3 + c) * 120 + i);
    }
    EXPECT_THAT(read_volume(folder / "a.h5:/tczyx").notes, Contains(HasSubstr("3 channels")));
    expect_error([&] { read_volume(folder / "a.h5:/tczyx", reading(2)); }, {"frame 2"});
    expect_error([&] { read_volume(folder / "a.h5:/tczyx", reading(0, 3)); }, {"channel 3"});
    const Voxels v = read_volume(folder / "a.h5:/xyzc", reading(0, 1));
    ASSERT_EQ(v.dims, (Int3{6, 5, 4}));
    for (int z = 0; z < 4; ++z)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 6; ++x) ASSERT_EQ(v.data<std::int16_t>()[(z * 5 + y) * 6 + x], ((x * 5 + y) * 4 + z) * 3 + 1);
    expect_error([&] { read_volume(folder / "a.h5:/energy"); }, {"4 x 5 x 6 x 7", "energy, z, y, x"});
}

TEST(VolumeHdf5, WithoutLabelsAFourthAxisIsNotGuessed) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "a.h5");
        h.dataset("/one", {1, 3, 4, 5, 1}, counted(60));
        h.dataset("/front", {2, 5, 6, 7}, counted(420));
        h.dataset("/behind", {5, 6, 7, 2}, counted(420));
        h.dataset("/line", {60}, counted(60));
        h.dataset("/five", {2, 2, 3, 4, 5}, counted(240));
    }
    EXPECT_EQ(read_volume(folder / "a.h5:/one").dims, (Int3{5, 4, 3}));
    expect_error([&] { read_volume(folder / "a.h5:/front"); }, {"2 x 5 x 6 x 7", "--channel"});
    EXPECT_EQ(values_of(read_volume(folder / "a.h5:/front", reading(0, 1))).front(), 210);
    const std::vector<double> behind = values_of(read_volume(folder / "a.h5:/behind", reading(0, 1)));
    EXPECT_EQ(behind.size(), 210u);
    EXPECT_EQ(behind[3], 7);
    expect_error([&] { read_volume(folder / "a.h5:/line"); }, {"shape 60"});
    expect_error([&] { read_volume(folder / "a.h5:/five", reading(0, 1)); }, {"2 x 2 x 3 x 4 x 5"});
}

TEST(VolumeHdf5, ReadsLargePackedDataInPieces) {
    const Folder folder;
    const Sample s({120, 110, 701}); // 18 MB: more than one piece, the last one not whole
    write_hdf5(folder / "a.h5", s, false);
    {
        Hdf5Writer h(folder / "b.h5");
        h.dataset("/volume", hdf5_dims(s), s.voxels, {50, 64, 64}, true);
    }
    for (const char* name : {"a.h5", "b.h5"}) {
        const Voxels v = read_volume(folder / name);
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>())) << name;
    }
}

TEST(VolumeHdf5, RefusesWhatIsNotStoredOrNoNumbers) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "a.h5");
        h.dataset("/huge", {100000, 100000, 100000}, std::vector<std::int16_t>{}, {10, 10, 10});
        h.dataset("/sparse", {64, 64, 64}, std::vector<std::int16_t>{}, {8, 8, 8}, true);
        const hid_t sparse = H5Dopen2(h.file(), "/sparse", H5P_DEFAULT), all = H5Dget_space(sparse);
        const hsize_t first[] = {0, 0, 0}, one[] = {1, 1, 1};
        const hid_t single = H5Screate_simple(3, one, nullptr);
        H5Sselect_hyperslab(all, H5S_SELECT_SET, first, nullptr, one, nullptr);
        const std::int16_t value = 5;
        H5Dwrite(sparse, H5T_NATIVE_INT16, single, all, H5P_DEFAULT, &value);
        H5Sclose(single), H5Sclose(all), H5Dclose(sparse);
        h.dataset("/flat", {30000, 300, 300}, std::vector<std::int16_t>{});
        const hid_t complex = H5Tcreate(H5T_COMPOUND, 8);
        H5Tinsert(complex, "r", 0, H5T_IEEE_F32LE);
        H5Tinsert(complex, "i", 4, H5T_IEEE_F32LE);
        h.dataset("/complex", {2, 3, 4}, std::vector<float>{}, {}, false, complex);
        H5Tclose(complex);
        const hid_t text = H5Tcopy(H5T_C_S1);
        h.dataset("/text", {2, 3, 4}, std::vector<float>{}, {}, false, text);
        H5Tclose(text);
        const hsize_t dims[] = {2, 3, 4};
        const hid_t space = H5Screate_simple(3, dims, nullptr), create = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_external(create, "/etc/passwd", 0, 48);
        H5Dclose(H5Dcreate2(h.file(), "/external", H5T_NATIVE_INT16, space, H5P_DEFAULT, create, H5P_DEFAULT));
        H5Pclose(create), H5Sclose(space);
    }
    expect_error([&] { read_volume(folder / "a.h5:/huge"); }, {"empty"});
    expect_error([&] { read_volume(folder / "a.h5:/sparse"); }, {"524288 bytes", "most of it is empty"});
    expect_error([&] { read_volume(folder / "a.h5:/flat"); }, {"empty"});
    expect_error([&] { read_volume(folder / "a.h5:/complex"); }, {"complex"});
    expect_error([&] { read_volume(folder / "a.h5:/text"); }, {"texts"});
    expect_error([&] { read_volume(folder / "a.h5:/external"); }, {"other files"});
}

TEST(VolumeHdf5, NamesAFilterThatIsNotThere) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "a.h5");
        const hsize_t dims[] = {2, 3, 4};
        const hid_t space = H5Screate_simple(3, dims, nullptr), create = H5Pcreate(H5P_DATASET_CREATE);
        H5Pset_chunk(create, 3, dims);
        H5Pset_filter(create, 32001, H5Z_FLAG_OPTIONAL, 0, nullptr);
        H5Dclose(H5Dcreate2(h.file(), "/blosc", H5T_NATIVE_INT16, space, H5P_DEFAULT, create, H5P_DEFAULT));
        H5Pclose(create), H5Sclose(space);
    }
    expect_error([&] { read_volume(folder / "a.h5"); }, {"Blosc", "not supported", "gzip"});
}

TEST(VolumeHdf5, FilesMayStartWithABlockOfTheirWriters) {
    const Folder folder;
    const Sample s;
    for (const hsize_t block : {512, 1024, 4096}) {
        {
            Hdf5Writer h(folder / "a.bin", block);
            h.dataset("/v", hdf5_dims(s), s.voxels);
        }
        EXPECT_EQ(read_volume(folder / "a.bin").dims, s.dims) << block;
    }
}

TEST(VolumeHdf5, AGroupThatHoldsItselfEndsTheSearch) {
    const Folder folder;
    {
        Hdf5Writer h(folder / "a.h5");
        h.dataset("/g/v", {3, 4, 5}, counted(60));
        H5Lcreate_hard(h.file(), "/g", h.file(), "/g/again", H5P_DEFAULT, H5P_DEFAULT);
    }
    expect_error([&] { read_volume(folder / "a.h5"); }, {"name one of them", "/g/v (3 x 4 x 5 i16)"});
    EXPECT_EQ(read_volume(folder / "a.h5:/g/again/again/v").dims, (Int3{5, 4, 3}));
}

TEST(VolumeHdf5, AScenesVolumeMayBeADataSet) {
    const Folder folder;
    write_hdf5(folder / "data/a.h5", Sample(), false);
    Scene scene;
    scene.volume = folder / "data/a.h5:/volume";
    std::filesystem::create_directories(folder / "scenes");
    write_scene(scene, folder / "scenes/s.json");
    EXPECT_THAT(read(folder / "scenes/s.json"), HasSubstr("\"../data/a.h5:/volume\""));
    EXPECT_EQ(read_volume(read_scene(folder / "scenes/s.json").volume).dims, (Int3{5, 4, 3}));
    EXPECT_THAT(provenance_json(scene), HasSubstr("\"a.h5:/volume\""));
}

TEST(VolumeImaris, CropsThePaddingAndTakesUnitsAndExtents) {
    const Folder folder;
    const Sample s;
    write_imaris(folder / "a.IMS", s, 2, 3);
    for (const auto& [t, c] : {std::pair{0, 0}, {1, 2}}) {
        const Voxels v = read_volume(folder / "a.IMS", reading(t, c));
        EXPECT_EQ(v.format, "Imaris");
        ASSERT_EQ(v.dims, s.dims);
        for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], s.voxels[i] + 10 * t + c);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(v.geometry.spacing[i], s.geometry.spacing[i], 1e-9);
            EXPECT_NEAR(v.geometry.origin[i], s.geometry.origin[i], 1e-9);
        }
        EXPECT_TRUE(v.notes.empty());
    }
    EXPECT_THAT(read_volume(folder / "a.IMS").notes, Contains(HasSubstr("3 channels")));
    expect_error([&] { read_volume(folder / "a.IMS", reading(2)); }, {"frame 2"});
    expect_error([&] { read_volume(folder / "a.IMS", reading(0, 3)); }, {"channel 3"});
    EXPECT_EQ(read_volume((folder / "a.IMS") + ":/DataSet/ResolutionLevel 0/TimePoint 0/Channel 1/Data").dims, (Int3{8, 5, 5}));
}

TEST(VolumeMinc, TakesGeometryAndScale) {
    const Folder folder;
    const Sample s;
    write_minc(folder / "a.mnc", s);
    const Voxels v = read_volume(folder / "a.mnc");
    EXPECT_EQ(v.format, "MINC 2");
    EXPECT_EQ(v.type, VoxelType::i16);
    EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
    EXPECT_NEAR(v.slope, 2, 1e-12);
    EXPECT_NEAR(v.intercept, -5, 1e-9);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(v.geometry.spacing[i], s.geometry.spacing[i], 1e-9);
        EXPECT_NEAR(v.geometry.origin[i], s.geometry.origin[i], 1e-5);
        for (int j = 0; j < 3; ++j) EXPECT_NEAR(v.geometry.direction.row[i][j], s.geometry.direction.row[i][j], 1e-6);
    }
    write_minc(folder / "b.mnc", s, true);
    const Voxels f = read_volume(folder / "b.mnc");
    ASSERT_EQ(f.type, VoxelType::f32);
    for (std::size_t i = 0; i < s.voxels.size(); ++i)
        EXPECT_NEAR(f.data<float>()[i], (2.0 + static_cast<double>(i / 20)) * s.voxels[i] - 5, 1e-2);
}

} // namespace
} // namespace clvr::test

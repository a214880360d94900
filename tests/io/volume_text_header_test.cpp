// NRRD, MetaImage and VTK: what their headers can say, and what is refused.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/volume_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

class VolumeHeader : public ::testing::Test {
protected:
    Folder folder;
    Sample s;
    std::string voxels = bytes_of(s.voxels);
    std::string nrrd = nrrd_header(s, "raw") + "\n" + voxels, metaimage = metaimage_header(s, "") + voxels,
                vtk = vtk_header(s) + bytes_of(s.voxels, true);

    Voxels read(const std::string& name, const std::string& bytes, const VolumeReadOptions& options = {}) {
        return read_volume(write(folder / name, bytes), options);
    }
    void refused(const std::string& name, const std::string& bytes, const std::vector<std::string>& words) {
        SCOPED_TRACE(words.empty() ? name : words.front());
        expect_error([&] { read(name, bytes); }, words);
    }
};

TEST_F(VolumeHeader, NrrdInRasIsTurnedToLps) {
    const Voxels v = read("a.nrrd", replaced(nrrd, "left-posterior-superior", "right-anterior-superior"));
    EXPECT_NEAR(v.geometry.origin[0], 10.5, 1e-6);
    EXPECT_NEAR(v.geometry.origin[1], -20.25, 1e-6);
    EXPECT_NEAR(v.geometry.origin[2], 31, 1e-6);
    EXPECT_NEAR(v.geometry.direction.row[0][0], -0.866025, 1e-5);
    EXPECT_NEAR(v.geometry.direction.row[2][2], 1, 1e-6);
}

TEST_F(VolumeHeader, NrrdWithSpacingsAlone) {
    std::string header = "NRRD0001\ntype: unsigned short\ndimension: 3\nsizes: 5 4 3\nspacings: 0.5 0.75 2\nencoding: raw\nendian: big\n\n";
    std::vector<std::uint16_t> values(s.voxels.begin(), s.voxels.end());
    const Voxels v = read("a.nrrd", header + bytes_of(values, true));
    EXPECT_EQ(v.type, VoxelType::u16);
    EXPECT_TRUE(std::equal(values.begin(), values.end(), v.data<std::uint16_t>()));
    EXPECT_EQ(v.geometry.spacing, (Double3{0.5, 0.75, 2}));
    EXPECT_THAT(read("b.nrrd", replaced(header, "spacings: 0.5 0.75 2\n", "") + bytes_of(values)).notes,
                Contains(HasSubstr("1 mm is assumed")));
}

TEST_F(VolumeHeader, NrrdUnitsBecomeMillimetres) {
    const Voxels v = read("a.nrrd", replaced(nrrd, "endian", "space units: \"um\" \"um\" \"um\"\nendian"));
    EXPECT_NEAR(v.geometry.spacing[2], 2e-3, 1e-9);
    EXPECT_NEAR(v.geometry.origin[2], 31e-3, 1e-9);
}

TEST_F(VolumeHeader, NrrdListAxisIsAFrame) {
    std::vector<std::int16_t> all;
    for (const auto v : s.voxels)
        for (std::int16_t t = 0; t < 2; ++t) all.push_back(static_cast<std::int16_t>(v + t));
    std::string file = replaced(replaced(replaced(replaced(nrrd_header(s, "raw"), "dimension: 3", "dimension: 4"), "sizes: ", "sizes: 2 "),
                                         "space directions: ", "space directions: none "),
                                "kinds: ", "kinds: list ") +
                       "\n" + bytes_of(all);
    VolumeReadOptions options;
    options.frame = 1;
    const Voxels v = read("a.nrrd", file, options);
    ASSERT_EQ(v.dims, s.dims);
    for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], s.voxels[i] + 1);
    options.frame = 2;
    expect_error([&] { read("a.nrrd", file, options); }, {"2 frames"});
    refused("a.nrrd", replaced(file, "kinds: list", "kinds: RGB-color"), {"2 values", "rgb-color"});
    refused("a.nrrd", replaced(file, "kinds: list", "kinds: vector"), {"2 values"});
}

TEST_F(VolumeHeader, NrrdByteSkipAndMinusOne) {
    write(folder / "a.raw", std::string(100, 'x') + voxels);
    for (const char* skip : {"100", "-1"}) {
        const Voxels v = read("a.nhdr", nrrd_header(s, "raw", std::string("byte skip: ") + skip + "\ndata file: a.raw\n"));
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>())) << skip;
    }
}

TEST_F(VolumeHeader, NrrdRefuses) {
    for (const char* bad : {"(0,0,0)", "(nan,0,0)", "(inf,0,0)"})
        refused("a.nrrd", replaced(nrrd, triple(s.geometry.index_to_world().column(0)), bad), {"space directions"});
    refused("a.nrrd", replaced(nrrd, triple(s.geometry.index_to_world().column(0)), triple(s.geometry.index_to_world().column(1))),
            {"singular"});
    for (const char* bad : {"0", "nan", "inf", "x"})
        refused("a.nrrd",
                std::string("NRRD0001\ntype: short\ndimension: 3\nsizes: 5 4 3\nspacings: 0.5 ") + bad +
                    " 2\nencoding: raw\nendian: little\n\n" + voxels,
                {"spacings"});
    refused("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 5 4 4"), {"expected 160 bytes", "120"});
    refused("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 1000000000 1000000000 1000000000"), {"impossible"});
    refused("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 5 4"), {"sizes"});
    refused("a.nrrd", replaced(nrrd, "sizes: 5 4 3", "sizes: 5 -4 3"), {"sizes"});
    refused("a.nrrd", replaced(nrrd, "type: short", "type: block"), {"block"});
    refused("a.nrrd", replaced(nrrd, "encoding: raw", "encoding: bzip2"), {"bzip2", "gzip"});
    refused("a.nrrd", replaced(nrrd, "endian", "Segment0_ID:=Segment_1\nendian"), {"segmentation"});
    refused("a.nhdr", nrrd_header(s, "raw", "data file: not_there.raw\n"), {"not_there.raw"});
    refused("a.nhdr", nrrd_header(s, "raw", "data file: LIST\na.raw\n"), {"many files"});
    refused("a.nhdr", nrrd_header(s, "raw", "data file: a%02d.raw 1 3 1\n"), {"many files"});
    refused("a.nrrd", replaced(nrrd, "endian: little", "sizes: 5 4 3"), {"twice"});
}

TEST_F(VolumeHeader, MetaImageKeepsScaleModalityAndUnit) {
    const Voxels v = read(
        "a.mha",
        metaimage_header(
            s,
            "Modality = MET_MOD_CT\nElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = -1000\nDistanceUnits = um\n") +
            voxels);
    EXPECT_EQ(v.modality, "CT");
    EXPECT_EQ(v.slope, 2);
    EXPECT_EQ(v.intercept, -1000);
    EXPECT_NEAR(v.geometry.spacing[0], 0.5e-3, 1e-12);
}

TEST_F(VolumeHeader, MetaImageBigEndianAndWidened) {
    std::vector<double> values(s.voxels.begin(), s.voxels.end());
    const std::string header = replaced(replaced(metaimage_header(s, ""), "MET_SHORT", "MET_DOUBLE"), "MSB = False", "MSB = True");
    const Voxels v = read("a.mha", header + bytes_of(values, true));
    EXPECT_EQ(v.type, VoxelType::f32);
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(v.data<float>()[i], static_cast<float>(values[i]));
}

TEST_F(VolumeHeader, MetaImageFramesAndHeaderSize) {
    std::string header = "ObjectType = Image\nNDims = 4\nDimSize = 5 4 3 2\nElementSpacing = 1 1 2 1\nElementType = MET_SHORT\n";
    std::vector<std::int16_t> second;
    for (const auto v : s.voxels) second.push_back(static_cast<std::int16_t>(v + 1));
    VolumeReadOptions options;
    options.frame = 1;
    const Voxels v = read("a.mha", header + "ElementDataFile = LOCAL\n" + voxels + bytes_of(second), options);
    ASSERT_EQ(v.dims, s.dims);
    EXPECT_TRUE(std::equal(second.begin(), second.end(), v.data<std::int16_t>()));
    write(folder / "a.raw", std::string(33, 'x') + voxels + bytes_of(second));
    for (const char* skip : {"33", "-1"}) {
        const Voxels w = read("a.mhd", header + "HeaderSize = " + skip + "\nElementDataFile = a.raw\n");
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), w.data<std::int16_t>())) << skip;
    }
}

TEST_F(VolumeHeader, MetaImageRefuses) {
    for (const char* bad : {"0 0.75 2", "nan 0.75 2", "inf 1 1", "1 1", "a b c"})
        refused("a.mha", replaced(metaimage, "ElementSpacing = 0.5 0.75 2", std::string("ElementSpacing = ") + bad), {"ElementSpacing"});
    std::string singular = metaimage;
    const auto at = singular.find("TransformMatrix = ");
    singular.replace(at, singular.find('\n', at) - at, "TransformMatrix = 1 0 0 1 0 0 0 0 1");
    refused("a.mha", singular, {"singular"});
    refused("a.mha", replaced(metaimage, "DimSize = 5 4 3", "DimSize = 5 4 4"), {"expected 160 bytes", "120"});
    refused("a.mha", replaced(metaimage, "DimSize = 5 4 3", "DimSize = 2000000000 2000000000 2000000000"), {"impossible"});
    refused("a.mha", replaced(metaimage, "NDims = 3", "NDims = 50"), {"50 dimensions"});
    refused("a.mha", replaced(metaimage, "MET_SHORT", "MET_SHORT_ARRAY"), {"MET_SHORT_ARRAY"});
    refused("a.mha", replaced(metaimage, "ElementType", "ElementNumberOfChannels = 3\nElementType"), {"3 values"});
    refused("a.mha", replaced(metaimage, "ObjectType = Image", "ObjectType = Mesh"), {"Mesh"});
    refused("a.mha", replaced(metaimage, "ElementDataFile = LOCAL", "ElementDataFile = LIST"), {"many files"});
    refused("a.mha", replaced(metaimage, "ElementDataFile = LOCAL", "ElementDataFile = gone.raw"), {"gone.raw"});
    refused("a.mha", replaced(metaimage, "NDims = 3", "NDims = 3\n" + std::string(3000, 'a') + " = 1"), {"MetaImage header"});
    refused("a.mha", metaimage_header(s, "CompressedData = True\n") + deflated(voxels.substr(2), false),
            {"expected 120 bytes", "found 118"});
}

TEST_F(VolumeHeader, VtkTypesAndNames) {
    std::vector<float> values(s.voxels.begin(), s.voxels.end());
    values[4] = std::nanf("");
    const Voxels v = read("a.vtk", vtk_header(s, "BINARY", "float") + bytes_of(values, true));
    EXPECT_EQ(v.type, VoxelType::f32);
    EXPECT_EQ(v.repaired, 1u);
    EXPECT_EQ(read("a.vtk", replaced(vtk, "SPACING", "ASPECT_RATIO")).geometry.spacing, s.geometry.spacing);
}

TEST_F(VolumeHeader, VtkRefuses) {
    for (const char* bad : {"0 1 1", "nan 1 1", "1 inf 1"})
        refused("a.vtk", replaced(vtk, "SPACING 0.5 0.75 2", std::string("SPACING ") + bad), {"SPACING"});
    refused("a.vtk", replaced(vtk, "DIMENSIONS 5 4 3", "DIMENSIONS 5 4 4"), {"POINT_DATA 60"});
    refused("a.vtk", replaced(replaced(vtk, "DIMENSIONS 5 4 3", "DIMENSIONS 5000 4000 3000"), "POINT_DATA 60", "POINT_DATA 60000000000"),
            {"120000000000 bytes"});
    refused("a.vtk", replaced(vtk, "STRUCTURED_POINTS", "UNSTRUCTURED_GRID"), {"UNSTRUCTURED_GRID"});
    refused("a.vtk", replaced(vtk, "density short 1", "density short 3"), {"3 values"});
    refused("a.vtk", replaced(vtk, "SCALARS density short 1", "VECTORS v float"), {"VECTORS"});
    refused("a.vtk", replaced(vtk, "POINT_DATA", "CELL_DATA"), {"CELL_DATA"});
    refused("a.vtk", replaced(vtk, "density short", "density quad"), {"quad"});
    refused("a.vtk", vtk_header(s, "ASCII") + "1 2 three" + std::string(200, ' '), {"three"});
    refused("a.vtk", vtk_header(s, "ASCII", "float") + "1 2 nan" + std::string(200, ' '), {"nan"});
    refused("a.vti", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">", {".vti", "legacy VTK"});
}

} // namespace
} // namespace clvr::test

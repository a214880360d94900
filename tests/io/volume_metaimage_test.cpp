// MetaImage: what its header can say, and what is refused.
#include "tests/io/volume_header.hpp"

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MetaImage : public VolumeHeader {
protected:
    std::string metaimage = metaimage_header(s, "") + voxels;
    std::string bare = "ObjectType = Image\nNDims = 3\nDimSize = 5 4 3\nElementType = MET_SHORT\n"; ///< no spacing, matrix, origin, data
    const std::string local = "ElementDataFile = LOCAL\n";
};

TEST_F(MetaImage, ScaleModalityAndUnits) {
    const Voxels v =
        read("a.mha", metaimage_header(s, "Modality = MET_MOD_CT\nElementToIntensityFunctionSlope = 2\nElementToIntensityFunctionOffset = "
                                          "-1000\nDistanceUnits = um\n") +
                          voxels);
    EXPECT_EQ(v.modality, "CT");
    EXPECT_EQ(v.slope, 2);
    EXPECT_EQ(v.intercept, -1000);
    expect_near(v.geometry.spacing, {0.5e-3, 0.75e-3, 2e-3});
    expect_near(v.geometry.origin, {-10.5e-3, 20.25e-3, 31e-3});
    for (const auto& [unit, mm] : std::vector<std::pair<std::string, double>>{{"cm", 10}, {"mm", 1}, {"meters", 1000}, {"?", 1}}) {
        const Voxels w = read("a.mha", metaimage_header(s, "DistanceUnits = " + unit + "\n") + voxels);
        EXPECT_NEAR(w.geometry.spacing[0], 0.5 * mm, 1e-9) << unit;
        EXPECT_THAT(w.notes, IsEmpty()) << unit;
    }
    EXPECT_THAT(read("a.mha", metaimage_header(s, "DistanceUnits = furlong\n") + voxels).notes, Contains(HasSubstr("furlong")));
}

TEST_F(MetaImage, BigEndianAndWidened) {
    std::vector<double> values(s.voxels.begin(), s.voxels.end());
    const std::string header = replaced(replaced(metaimage_header(s, ""), "MET_SHORT", "MET_DOUBLE"), "MSB = False", "MSB = True");
    for (const std::string& h : {header, replaced(header, "BinaryDataByteOrderMSB", "ElementByteOrderMSB")}) {
        const Voxels v = read("a.mha", h + bytes_of(values, true));
        EXPECT_EQ(v.type, VoxelType::f32);
        for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(v.data<float>()[i], static_cast<float>(values[i]));
    }
    refused("a.mha", metaimage_header(s, "ElementByteOrderMSB = True\n") + voxels, {"contradict"});
}

TEST_F(MetaImage, LongIs32Bits) {
    std::vector<std::int32_t> values(s.voxels.begin(), s.voxels.end());
    const Voxels v = read("a.mha", replaced(metaimage_header(s, ""), "MET_SHORT", "MET_LONG") + bytes_of(values));
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(v.data<float>()[i], static_cast<float>(values[i]));
    EXPECT_THAT(v.decisions, Contains(HasSubstr("32 bits")));
}

TEST_F(MetaImage, WhichOfSeveralTagsWins) {
    const auto rotated = [](const char* tag) { return std::string(tag) + " = 0 1 0 1 0 0 0 0 1\n"; };
    Voxels v = read("a.mha", bare + "ElementSize = 2 3 4\n" + local + voxels);
    expect_near(v.geometry.spacing, {2, 3, 4});
    EXPECT_THAT(v.notes, IsEmpty());
    v = read("a.mha", bare + "ElementSize = 2 3 4\nElementSpacing = 5 6 7\nOffset = 1 2 3\nPosition = 1 2 3\nOrigin = 7 8 9\n" +
                          rotated("Rotation") + "TransformMatrix = 1 0 0 0 0 1 0 1 0\n" + local + voxels);
    expect_near(v.geometry.spacing, {5, 6, 7});
    expect_near(v.geometry.origin, {7, 8, 9});
    expect_direction(v, {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}});
    EXPECT_THAT(v.notes, Contains(HasSubstr("ElementSpacing and ElementSize differ")));
    EXPECT_THAT(v.notes, Contains(HasSubstr("Origin and Offset differ")));
    EXPECT_THAT(v.notes, Contains(HasSubstr("TransformMatrix and Rotation differ")));
    EXPECT_THAT(read("a.mha", bare + "AnatomicalOrientation = LPI\nElementSpacing = 1 1 1\n" + local + voxels).notes,
                Contains(HasSubstr("AnatomicalOrientation LPI")));
    EXPECT_THAT(read("a.mha", bare + "AnatomicalOrientation = RAI\nElementSpacing = 1 1 1\n" + local + voxels).notes, IsEmpty());
    v = read("a.mha", bare + "ElementSpacing = 1 -2 3\nTransformMatrix = 2 0 0 0 1 0 0 0 1\n" + local + voxels);
    expect_near(v.geometry.spacing, {2, 2, 3});
    expect_direction(v, {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}});
}

TEST_F(MetaImage, FramesAndHeaderSize) {
    const std::string header = "ObjectType = Image\nNDims = 4\nDimSize = 5 4 3 2\nElementSpacing = 1 1 2 1\nElementType = MET_SHORT\n";
    const Voxels v = read("a.mha", header + local + several(2, false), frame(1));
    expect_voxels(v, 1);
    EXPECT_THAT(v.decisions, Contains(HasSubstr("frame 1 of 0 to 1")));
    EXPECT_EQ(v.frames, 2);
    refused("a.mha", header + local + several(2, false), {"frame 2"}, frame(2));
    write(folder / "a.raw", std::string(33, 'x') + several(2, false));
    for (const char* skip : {"33", "-1"}) expect_voxels(read("a.mhd", header + "HeaderSize = " + skip + "\nElementDataFile = a.raw\n"));
    write(folder / "a.zraw", "head" + deflated(voxels, false));
    expect_voxels(read("a.mhd", metaimage_header(s, "CompressedData = True\nHeaderSize = 4\n", "a.zraw")));
    expect_voxels(read("a.mha", bare + "HeaderSize = -1\n" + local + "xxxx" + voxels));
    refused("a.mha", bare + "HeaderSize = 7\n" + local + voxels, {"HeaderSize 7", "within the header"});
    refused("a.mhd", metaimage_header(s, "CompressedData = True\nHeaderSize = -1\n", "a.zraw"), {"HeaderSize -1"});
}

TEST_F(MetaImage, Channels) {
    const std::string header = metaimage_header(s, "ElementNumberOfChannels = 3\n");
    const Voxels first = read("a.mha", header + several(3, true));
    expect_voxels(first);
    EXPECT_THAT(first.notes, Contains(HasSubstr("3 channels")));
    expect_voxels(read("a.mha", header + several(3, true), channel(2)), 2);
    refused("a.mha", header + several(3, true), {"channel 3"}, channel(3));
    refused("a.mha", metaimage, {"channel 1"}, channel(1));
}

TEST_F(MetaImage, FilesInARow) {
    const auto names = write_slices(folder, s, "s_{:02}.raw");
    for (const std::string& data : {"LIST\n" + lines_of(names), "LIST 2D\n" + lines_of(names), "LIST 2\n" + lines_of(names),
                                    std::string("s_%02d.raw 0 2 1"), std::string("s_%02d.raw 0")})
        expect_voxels(read("a.mhd", metaimage_header(s, "", data)));
    refused("a.mhd", metaimage_header(s, "", "LIST\n" + names[0]), {"1 data files", "expected 3"});
    refused("a.mhd", metaimage_header(s, "", "s_%02d.raw"), {"s_03.raw"}); // from 1 on
    write(folder / "lung 50%.raw", voxels);
    expect_voxels(read("a.mhd", metaimage_header(s, "", "lung 50%.raw")));
    write(folder / "a%03d.raw", voxels);
    expect_voxels(read("a.mhd", metaimage_header(s, "", "a%03d.raw")));
    write(folder / "sub/B.Raw", voxels);
    expect_voxels(read("a.mhd", metaimage_header(s, "", "sub\\b.raw")));
}

TEST_F(MetaImage, UnknownAndLongTagsPass) {
    const std::string more = "0018|1030 = " + std::string(20000, 'x') + "\n" + std::string(3000, 'a') + " = 1\nObjectSubType = x\n";
    const Voxels v = read("a.mha", metaimage_header(s, more) + voxels);
    expect_voxels(v);
    EXPECT_THAT(v.notes, IsEmpty());
}

TEST_F(MetaImage, Refuses) {
    for (const char* bad : {"0 0.75 2", "nan 0.75 2", "inf 1 1", "1 1", "a b c"})
        refused("a.mha", replaced(metaimage, "ElementSpacing = 0.5 0.75 2", std::string("ElementSpacing = ") + bad), {"ElementSpacing"});
    refused("a.mha", bare + "TransformMatrix = 1 0 0 1 0 0 0 0 1\n" + local + voxels, {"singular"});
    refused("a.mha", replaced(metaimage, "DimSize = 5 4 3", "DimSize = 5 4 4"), {"expected 160 bytes", "120"});
    refused("a.mha", replaced(metaimage, "DimSize = 5 4 3", "DimSize = 2000000000 2000000000 2000000000"), {"impossible"});
    refused("a.mha", replaced(metaimage, "NDims = 3", "NDims = 50"), {"50 dimensions"});
    refused("a.mha", replaced(metaimage, "MET_SHORT", "MET_SHORT_ARRAY"), {"MET_SHORT_ARRAY"});
    refused("a.mha", metaimage_header(s, "ElementNumberOfChannels = 3000000000000000000\n") + voxels, {"impossible"}, channel(0));
    refused("a.mha", replaced(metaimage, "ObjectType = Image", "ObjectType = Mesh"), {"Mesh"});
    refused("a.mha", replaced(metaimage, "ElementDataFile = LOCAL", "ElementDataFile = gone.raw"), {"gone.raw"});
    refused("a.mha", replaced(metaimage, "NDims = 3", "NDims = 3\nno tag"), {"MetaImage header"});
    refused("a.mha", replaced(metaimage, "NDims = 3", "NDims = 3\nNDims = 3"), {"twice"});
    refused("a.mha", metaimage_header(s, "CompressedData = True\n") + deflated(voxels.substr(2), false),
            {"expected 120 bytes", "found 118"});
}

} // namespace
} // namespace clvr::test

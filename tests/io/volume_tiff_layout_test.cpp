// What the pages of TIFF files mean: OME-XML, ImageJ's and tifffile's descriptions, microscopes' own tags.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/tiff_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Whether v's 6 x 7 slices are the pages of these numbers.
void expect_pages(const Voxels& v, const std::vector<std::size_t>& pages) {
    ASSERT_EQ(v.dims, (Int3{6, 7, static_cast<int>(pages.size())}));
    ASSERT_EQ(v.type, VoxelType::i16);
    for (std::size_t k = 0; k < pages.size(); ++k)
        for (std::size_t i = 0; i < 42; ++i)
            ASSERT_EQ(v.data<std::int16_t>()[42 * k + i], 3 * static_cast<int>(42 * pages[k] + i) - 100) << "slice " << k << " voxel " << i;
}
void expect_spacing(const Voxels& v, const Double3& mm) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(v.geometry.spacing[i], mm[i], 1e-6 * mm[i]) << "axis " << i;
}
VolumeReadOptions channel_and_frame(int channel, int frame) {
    VolumeReadOptions o;
    o.channel = channel, o.frame = frame;
    return o;
}

class TiffLayouts : public ::testing::Test {
protected:
    std::string file(const std::string& bytes, const std::string& name = "a.tif") const { return write(folder_ / name, bytes); }
    std::string ome(std::size_t pages, const std::string& pixels, const std::string& inside = "<TiffData/>", const std::string& more = "",
                    const std::string& name = "a.tif") const {
        return file(described_tiff(pages, ome_xml(pixels, inside, more)), name);
    }
    Folder folder_;
};

constexpr const char* two_by_four_by_three = R"(SizeX="6" SizeY="7" SizeC="2" SizeZ="4" SizeT="3")";

TEST_F(TiffLayouts, OmeGivesEachOrderOfItsAxes) {
    struct Order {
        const char* name;
        std::size_t c, z, t; ///< pages from one to the next
    };
    for (const Order& o :
         {Order{"XYCZT", 1, 2, 8}, {"XYZCT", 4, 1, 8}, {"XYZTC", 12, 1, 4}, {"XYTZC", 12, 3, 1}, {"XYCTZ", 1, 6, 2}, {"XYTCZ", 3, 6, 1}}) {
        const std::string path = ome(24, fmt::format("{} DimensionOrder=\"{}\"", two_by_four_by_three, o.name));
        const Voxels v = read_volume(path, channel_and_frame(1, 2));
        std::vector<std::size_t> pages;
        for (std::size_t z = 0; z < 4; ++z) pages.push_back(o.c + z * o.z + 2 * o.t);
        SCOPED_TRACE(o.name);
        expect_pages(v, pages);
        EXPECT_THAT(v.decisions, Contains(HasSubstr(fmt::format("OME-XML: {}", o.name))));
    }
}

TEST_F(TiffLayouts, OmeSaysWhichChannelAndTimeAreRead) {
    const std::string path = ome(24, std::string(two_by_four_by_three) + R"( DimensionOrder="XYCZT")",
                                 R"(<Channel Name="DAPI"/><Channel Name="GFP"/><TiffData/>)");
    const Voxels v = read_volume(path);
    expect_pages(v, {0, 2, 4, 6});
    EXPECT_THAT(v.notes, Contains(HasSubstr("2 channels (DAPI, GFP): channel 0 is read")));
    EXPECT_THAT(v.notes, Contains(HasSubstr("3 times")));
    expect_error([&] { read_volume(path, channel_and_frame(2, 0)); }, {"channel 2", "2 channels (DAPI, GFP)"});
    expect_error([&] { read_volume(path, channel_and_frame(-1, 0)); }, {"channel -1"});
    expect_error([&] { read_volume(path, channel_and_frame(0, 3)); }, {"frame 3"});
}

TEST_F(TiffLayouts, OmePlacesPagesAsTiffDataSays) {
    const std::string backwards = R"(<TiffData IFD="2"/><TiffData IFD="1" FirstZ="1"/><TiffData IFD="0" FirstZ="2" PlaneCount="1"/>)";
    const std::string sizes = R"(SizeX="6" SizeY="7" SizeC="1" SizeZ="3" SizeT="1" DimensionOrder="XYZCT")";
    expect_pages(read_volume(ome(3, sizes, backwards)), {2, 1, 0});
    expect_pages(read_volume(ome(5, sizes, R"(<TiffData IFD="1" PlaneCount="3"/>)")), {1, 2, 3});
    expect_pages(read_volume(ome(3, sizes, R"(<TiffData PlaneCount="3"/>)")), {0, 1, 2});
    expect_pages(read_volume(ome(3, sizes, "")), {0, 1, 2});
    expect_error([&] { read_volume(ome(3, sizes, R"(<TiffData IFD="0"/>)")); }, {"slice 1 of 3"});
    expect_error([&] { read_volume(ome(2, sizes, R"(<TiffData IFD="0" PlaneCount="3"/>)")); }, {"page 2", "the file has 2"});
    expect_error([&] { read_volume(ome(3, sizes, R"(<TiffData IFD="0" FirstZ="3"/>)")); }, {"Z 3"});
    expect_error([&] { read_volume(ome(3, sizes, R"(<TiffData/><TiffData IFD="0"/>)")); }, {"twice"});
    expect_error([&] { read_volume(ome(2, sizes)); }, {"slice 2 of 3"});
    expect_error([&] { read_volume(ome(3, R"(SizeX="6" SizeY="9" SizeC="1" SizeZ="3" SizeT="1" DimensionOrder="XYZCT")")); },
                 {"6 x 9", "6 x 7"});
    expect_error([&] { read_volume(ome(3, R"(SizeX="6" SizeY="7" SizeC="1" SizeZ="x" SizeT="1")")); }, {"SizeZ"});
    expect_error([&] { read_volume(ome(3, R"(SizeX="6" SizeY="7" SizeC="2000000000" SizeZ="2000000000" SizeT="2000000000")")); },
                 {"planes"});
    expect_error([&] { read_volume(ome(3, R"(SizeX="6" SizeY="7" SizeZ="3" DimensionOrder="XYZZT")")); }, {"DimensionOrder"});
    const std::string whole = ome_xml(sizes);
    expect_error([&] { read_volume(file(described_tiff(3, whole.substr(0, whole.size() - 9)))); }, {"OME-XML breaks off"});
}

TEST_F(TiffLayouts, OmeGivesEachAxisItsUnit) {
    const auto with = [&](const std::string& sizes) {
        return read_volume(ome(3, R"(SizeX="6" SizeY="7" SizeC="1" SizeZ="3" SizeT="1" DimensionOrder="XYZCT" )" + sizes));
    };
    Voxels v = with(R"(PhysicalSizeX="0.2" PhysicalSizeY="0.25" PhysicalSizeZ="0.5")"); // micrometres unless said otherwise
    expect_spacing(v, {2e-4, 2.5e-4, 5e-4});
    EXPECT_THAT(v.notes, IsEmpty());
    EXPECT_THAT(v.decisions, Contains(HasSubstr("spacing z from OME-XML PhysicalSizeZ: 0.5")));
    v = with(
        R"(PhysicalSizeX="200" PhysicalSizeXUnit="nm" PhysicalSizeY="0.002" PhysicalSizeYUnit="cm" PhysicalSizeZ="5" PhysicalSizeZUnit="Å")");
    expect_spacing(v, {2e-4, 2e-2, 5e-7});
    v = with(
        R"(PhysicalSizeX="1" PhysicalSizeXUnit="in" PhysicalSizeY="2" PhysicalSizeYUnit="m" PhysicalSizeZ="3" PhysicalSizeZUnit="pm")");
    expect_spacing(v, {25.4, 2000, 3e-9});
    v = with(R"(PhysicalSizeX="0.2" PhysicalSizeY="0.2")");
    expect_spacing(v, {2e-4, 2e-4, 2e-4});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("no spacing z")));
    v = with(
        R"(PhysicalSizeX="1" PhysicalSizeXUnit="reference frame" PhysicalSizeY="2" PhysicalSizeYUnit="reference frame" PhysicalSizeZ="3" PhysicalSizeZUnit="reference frame")");
    expect_spacing(v, {1, 2, 3});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("1 : 2 : 3")));
    v = with(R"(PhysicalSizeX="1" PhysicalSizeXUnit="pixel" PhysicalSizeY="1" PhysicalSizeYUnit="pixel")");
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("1 mm is assumed")));
    v = with(R"(PhysicalSizeX="0.2" PhysicalSizeY="0.2" PhysicalSizeZ="7" PhysicalSizeZUnit="steps")");
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("\"steps\"")));
    EXPECT_THAT(with(R"(PhysicalSizeX="0" PhysicalSizeY="nan" PhysicalSizeZ="-1")").notes, ElementsAre(HasSubstr("1 mm is assumed")));
}

TEST_F(TiffLayouts, OmeImagesAreChosenBySeries) {
    const std::string sizes = R"(SizeX="6" SizeY="7" SizeC="1" SizeZ="{}" SizeT="1" DimensionOrder="XYZCT")";
    const std::string path =
        ome(5, fmt::format(fmt::runtime(sizes), 2), R"(<TiffData PlaneCount="2"/>)",
            fmt::format(R"(<Image ID="Image:1" Name="second"><Pixels {}><TiffData IFD="2" PlaneCount="3"/></Pixels></Image>)",
                        fmt::format(fmt::runtime(sizes), 3)));
    const Voxels v = read_volume(path);
    expect_pages(v, {0, 1});
    EXPECT_THAT(v.notes, Contains(HasSubstr("2 images (0 \"first\", 1 \"second\")")));
    for (const char* name : {"second", "1", "Image:1"}) {
        VolumeReadOptions o;
        o.series = name;
        expect_pages(read_volume(path, o), {2, 3, 4});
        o.series = "third";
        expect_error([&] { read_volume(path, o); }, {"third", "second"});
    }
}

TEST_F(TiffLayouts, OmeSetsOfFilesAreReadOrAMissingOneNamed) {
    const std::string sizes = R"(SizeX="6" SizeY="7" SizeC="1" SizeZ="2" SizeT="1" DimensionOrder="XYZCT")";
    const auto at = [](int z, const char* name) {
        return fmt::format(R"(<TiffData IFD="0" FirstZ="{}"><UUID FileName="{}">urn:uuid:{}</UUID></TiffData>)", z, name, name);
    };
    const std::string both = at(0, "a.ome.tif") + at(1, "b.ome.tif");
    ome(1, sizes, both, "", "s/a.ome.tif");
    expect_error([&] { read_volume(folder_ / "s/a.ome.tif"); }, {"b.ome.tif", "missing"});
    TiffWriter other;
    other.page(other.grey(6, 7, 16, 2), {bytes_of(std::vector<std::int16_t>(42, 7))});
    file(other.file(), "s/b.ome.tif");
    for (const char* name : {"s/a.ome.tif", "s"}) {
        const Voxels v = read_volume(folder_ / name);
        ASSERT_EQ(v.dims, (Int3{6, 7, 2}));
        EXPECT_EQ(v.data<std::int16_t>()[1], -97);
        EXPECT_EQ(v.data<std::int16_t>()[42], 7);
    }
    ome(1, sizes, both, "", "s/c.ome.tif");
    expect_error([&] { read_volume(folder_ / "s"); }, {"c.ome.tif"});
    // One file that was renamed.
    const std::string one = R"(<TiffData PlaneCount="2"><UUID FileName="old.ome.tif">urn:uuid:9</UUID></TiffData>)";
    expect_pages(read_volume(ome(2, sizes, one)), {0, 1});
    // Metadata in another file.
    const std::string only = R"(<OME><BinaryOnly MetadataFile="m.companion.ome" UUID="urn:uuid:1"/></OME>)";
    const std::string path = file(described_tiff(2, only), "b.tif");
    expect_error([&] { read_volume(path); }, {"m.companion.ome"});
    write(folder_ / "m.companion.ome", ome_xml(sizes, R"(<TiffData PlaneCount="2"><UUID FileName="b.tif">urn:uuid:1</UUID></TiffData>)"));
    expect_pages(read_volume(path), {0, 1});
}

TEST_F(TiffLayouts, ImageJHyperstacksHaveChannelsFastest) {
    const std::string path = file(described_tiff(12,
                                                 "ImageJ=1.53t\nimages=12\nchannels=2\nslices=3\nframes=2\nhyperstack=true\nunit=micron\n"
                                                 "spacing=3.5\nloop=false\n",
                                                 {2, 1}, true));
    Voxels v = read_volume(path);
    expect_pages(v, {0, 2, 4});
    expect_spacing(v, {5e-4, 5e-4, 3.5e-3});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("2 channels"), HasSubstr("2 times")));
    v = read_volume(path, channel_and_frame(1, 1));
    expect_pages(v, {7, 9, 11});
    EXPECT_THAT(v.notes, IsEmpty());
}

TEST_F(TiffLayouts, ImageJsUnits) {
    const auto with = [&](const std::string& lines, std::array<std::uint32_t, 2> resolution) {
        return read_volume(file(described_tiff(3, "ImageJ=1.53t\nimages=3\nslices=3\n" + lines, resolution)));
    };
    const std::pair<const char*, double> units[]{
        {"micron", 1e-3}, {"um", 1e-3}, {"\xc2\xb5m", 1e-3}, {"\xb5m", 1e-3}, {"\\u00B5m", 1e-3}, {"microns", 1e-3},    {"nm", 1e-6},
        {"mm", 1},        {"cm", 10},   {"m", 1000},         {"inch", 25.4},  {"pm", 1e-9},       {"Micrometers", 1e-3}};
    for (const auto& [unit, mm] : units) {
        const Voxels v = with(fmt::format("unit={}\nspacing=3\n", unit), {4, 1});
        SCOPED_TRACE(unit);
        expect_spacing(v, {mm / 4, mm / 4, 3 * mm});
        EXPECT_THAT(v.notes, IsEmpty());
    }
    expect_spacing(with("unit=nm\nyunit=micron\nzunit=mm\nspacing=25\n", {2, 33}), {16.5e-6, 16.5e-3, 25});
    expect_spacing(with("unit=nm\nspacing=-25\n", {1, 1}), {1e-6, 1e-6, 25e-6}); // from the top down
    expect_spacing(with("unit=um\n", {1, 1}), {1e-3, 1e-3, 1e-3});
    Voxels v = with("spacing=3\n", {1, 1});
    expect_spacing(v, {1, 1, 3});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("1 : 1 : 3")));
    v = with("unit=pixel\nspacing=3\n", {4, 1});
    expect_spacing(v, {1, 1, 12});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("\"pixel\"")));
    v = with("unit=furlong\nspacing=2\n", {1, 1});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("\"furlong\"")));
    EXPECT_THAT(with("", {1, 1}).notes, ElementsAre(HasSubstr("1 mm is assumed")));
    v = with("unit=um\nxorigin=2\nyorigin=3\nspacing=2\n", {1, 1});
    EXPECT_NEAR(v.geometry.origin[0], -2e-3, 1e-9);
    EXPECT_NEAR(v.geometry.origin[1], -3e-3, 1e-9);
}

TEST_F(TiffLayouts, ImageJsCalibrationIsAScale) {
    const auto with = [&](const std::string& lines) {
        return read_volume(file(described_tiff(3, "ImageJ=1.53t\nimages=3\nslices=3\n" + lines)));
    };
    Voxels v = with("cf=0\nc0=-32768.0\nc1=2.0\nvunit=Gray Value\n");
    EXPECT_EQ(v.intercept, -32768);
    EXPECT_EQ(v.slope, 2);
    v = with("cf=3\nc0=1\nc1=2\nc2=3\nvunit=OD\n");
    EXPECT_EQ(v.slope, 1);
    EXPECT_THAT(v.notes, Contains(HasSubstr("not a straight line")));
}

TEST_F(TiffLayouts, FramesOrManyChannelsAloneAreSlicesAndThatIsSaid) {
    Voxels v = read_volume(file(described_tiff(8, "ImageJ=1.53t\nimages=8\nframes=8\n")));
    expect_pages(v, {0, 1, 2, 3, 4, 5, 6, 7});
    EXPECT_THAT(v.notes, Contains(HasSubstr("8 times (frames) are taken as slices")));
    expect_error([&] { read_volume(folder_ / "a.tif", channel_and_frame(0, 3)); }, {"frame 3"});
    v = read_volume(file(described_tiff(6, "ImageJ=1.53t\nimages=6\nchannels=6\n")));
    expect_pages(v, {0, 1, 2, 3, 4, 5});
    EXPECT_THAT(v.notes, Contains(HasSubstr("channels: taken as slices")));
    expect_pages(read_volume(folder_ / "a.tif", channel_and_frame(4, 0)), {4});
    v = read_volume(file(described_tiff(2, "ImageJ=1.53t\nimages=2\nchannels=2\n"))); // as microscopes have them
    expect_pages(v, {0});
    EXPECT_THAT(v.notes, Contains(HasSubstr("2 channels")));
    const std::string six = R"(SizeX="6" SizeY="7" SizeC="6" SizeZ="1" SizeT="1" DimensionOrder="XYCZT")";
    expect_pages(read_volume(ome(6, six)), {0, 1, 2, 3, 4, 5});
    std::string names;
    for (int i = 0; i < 6; ++i) names += fmt::format("<Channel Name=\"dye {}\"/>", i);
    expect_pages(read_volume(ome(6, six, names + "<TiffData/>")), {0});
}

std::string one_ramp(int planes, const std::string& description, bool big, std::size_t cut = 0) {
    const std::string file = one_directory({6, 7, planes}, ramp(42 * static_cast<std::size_t>(planes)), description, big);
    return file.substr(0, file.size() - cut);
}

TEST_F(TiffLayouts, PlanesBehindOneDirectory) {
    for (const bool big : {false, true}) {
        const std::string fields = "ImageJ=1.53t\nimages=8\nchannels=2\nslices=4\nunit=mm\nspacing=3.0\n";
        Voxels v = read_volume(file(one_ramp(8, fields, big)), channel_and_frame(1, 0));
        expect_pages(v, {1, 3, 5, 7});
        EXPECT_THAT(v.decisions, Contains(HasSubstr("above 4 GB")));
        v = read_volume(file(one_ramp(8, R"({"shape": [8, 7, 6], "truncated": true})", big)));
        expect_pages(v, {0, 1, 2, 3, 4, 5, 6, 7});
    }
    expect_error([&] { read_volume(file(one_ramp(8, "ImageJ=1.53t\nimages=8\n", true, 1))); }, {"8 images", "room for 7"});
    expect_error([&] { read_volume(file(described_tiff(1, "ImageJ=1.53t\nimages=600\n"))); }, {"600 images", "1 page"});
    expect_error([&] { read_volume(file(described_tiff(1, "ImageJ=1.53t\nimages=2147483647\nslices=2147483647\nchannels=99999\n"))); },
                 {"images"});
    expect_error([&] { read_volume(file(described_tiff(6, "ImageJ=1.53t\nimages=8\nslices=8\n"))); }, {"8 slices", "6 pages"});
    expect_error([&] { read_volume(file(described_tiff(6, "ImageJ=1.53t\nimages=4\nchannels=2\nslices=2\n"))); },
                 {"2 channels", "6 pages"});
}

TEST_F(TiffLayouts, TifffilesShape) {
    const auto read = [&](std::size_t pages, const std::string& json, const VolumeReadOptions& o = {}) {
        return read_volume(file(described_tiff(pages, json)), o);
    };
    Voxels v = read(8, R"({"shape": [8, 7, 6]})");
    expect_pages(v, {0, 1, 2, 3, 4, 5, 6, 7});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("1 mm is assumed")));
    v = read(8, R"({"shape": [2, 4, 7, 6], "axes": "CZYX"})");
    expect_pages(v, {0, 1, 2, 3});
    EXPECT_THAT(v.notes, Contains(HasSubstr("2 channels")));
    expect_pages(read(8, R"({"shape": [2, 4, 7, 6], "axes": "CZYX"})", channel_and_frame(1, 0)), {4, 5, 6, 7});
    expect_pages(read(8, R"({"shape": [4, 2, 7, 6], "axes": "ZCYX"})", channel_and_frame(1, 0)), {1, 3, 5, 7});
    expect_pages(read(8, R"({"shape": [2, 4, 7, 6], "axes": "TZYX"})", channel_and_frame(0, 1)), {4, 5, 6, 7});
    expect_pages(read(8, R"({"shape": [1, 8, 1, 7, 6], "axes": "TZCYX"})"), {0, 1, 2, 3, 4, 5, 6, 7});
    v = read(8, R"({"shape": [8, 7, 6], "axes": "IYX"})");
    expect_pages(v, {0, 1, 2, 3, 4, 5, 6, 7});
    EXPECT_THAT(v.notes, Contains(HasSubstr("axis I")));
    EXPECT_THAT(read(8, R"({"shape": [8, 7, 6], "axes": "TYX"})").notes, Contains(HasSubstr("taken as slices")));
    expect_error([&] { read(8, R"({"shape": [2, 4, 7, 6]})"); }, {"2 (unnamed) x 4 (unnamed)"});
    expect_error([&] { read(8, R"({"shape": [2, 4, 7, 6], "axes": "RZYX"})"); }, {"2 R x 4 Z"});
    expect_error([&] { read(8, R"({"shape": [8, 7, 6], "axes": "YXZ"})"); }, {"columns", "Z"});
    expect_error([&] { read(6, R"({"shape": [8, 7, 6]})"); }, {"8 pages", "6"});
    EXPECT_THAT(read(8, R"({"shape": [9, 9]})").notes, Contains(HasSubstr("not that of its pages")));
    EXPECT_THAT(read(8, R"({"shape": [4, 7, 6]})").notes, Contains(HasSubstr("first 4 of 8 pages")));
    EXPECT_EQ(read(8, R"({"shape": )").dims[2], 8); // no JSON: a text
}

TEST_F(TiffLayouts, ZeissLsm) {
    TiffWriter w;
    std::string info(512, '\0');
    const std::int32_t sizes[]{0x00400494, 512, 6, 7, 3, 2, 1};
    std::memcpy(&info[0], sizes, sizeof sizes);
    const double metres[]{0.2e-6, 0.3e-6, 1e-6};
    std::memcpy(&info[40], metres, sizeof metres);
    const auto all = ramp(42 * 6);
    for (std::size_t z = 0; z < 3; ++z) {
        auto tags = w.grey(6, 7, 16, 2);
        if (z == 0) tags[34412] = w.bytes(info);
        tags[277] = w.words({2}), tags[258] = w.words({16, 16}), tags[339] = w.words({2, 2}), tags[284] = w.words({2});
        std::vector<std::string> planes;
        for (std::size_t c = 0; c < 2; ++c)
            planes.push_back(w.pixels(std::vector<std::int16_t>(all.begin() + 42 * (2 * z + c), all.begin() + 42 * (2 * z + c + 1))));
        w.page(tags, planes);
        auto thumbnail = w.grey(2, 2, 8);
        thumbnail[254] = w.longs({1});
        w.page(thumbnail, {std::string(4, 'x')});
    }
    Voxels v = read_volume(file(w.file()));
    expect_pages(v, {0, 2, 4});
    expect_spacing(v, {2e-4, 3e-4, 1e-3});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("2 channels")));
    expect_pages(read_volume(folder_ / "a.tif", channel_and_frame(1, 0)), {1, 3, 5});
    std::string wrong = w.file();
    wrong.replace(wrong.find(info) + 16, 1, "\4"); // four slices
    expect_error([&] { read_volume(file(wrong)); }, {"LSM", "4 slices", "3 pages"});
}

TEST_F(TiffLayouts, MetaMorphStk) {
    TiffWriter w;
    const std::uint32_t calibration = w.append(number(std::uint32_t{1}) + number(std::uint32_t{4})),
                        unit = w.append(number(std::uint32_t{3}) + std::string("um\0", 3));
    w.append(std::string(1, '\0'));
    std::vector<std::uint32_t> planes;
    for (int k = 0; k < 5; ++k) planes.insert(planes.end(), {3, 2, 0, 0, 0, 0}); // 1.5 apart
    auto tags = w.grey(6, 7, 16, 2);
    tags[33628] = w.longs({4, calibration, 5, calibration, 6, unit});
    tags[33628].count = 3;
    tags[33629] = w.longs(planes);
    tags[33629].type = 5, tags[33629].count = 5;
    w.page(tags, {w.pixels(ramp(42 * 5))});
    std::string bytes = w.file();
    const Voxels v = read_volume(file(bytes));
    expect_pages(v, {0, 1, 2, 3, 4});
    expect_spacing(v, {2.5e-4, 2.5e-4, 1.5e-3});
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("MetaMorph")));
}

TEST_F(TiffLayouts, ScanImage) {
    const std::string head = "SI.VERSION_MAJOR = 2020\nSI.hChannels.channelSave = [1;2]\nSI.hStackManager.framesPerSlice = 1\n";
    const Voxels v = read_volume(file(described_tiff(6, head + "SI.hStackManager.numSlices = 3\n")), channel_and_frame(1, 0));
    expect_pages(v, {1, 3, 5});
    expect_error([&] { read_volume(file(described_tiff(6, head + "SI.hStackManager.numSlices = 4\n"))); },
                 {"ScanImage", "4 slices", "6 pages"});
}

} // namespace
} // namespace clvr::test

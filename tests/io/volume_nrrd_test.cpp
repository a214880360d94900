// NRRD: what its header can say, and what is refused.
#include "tests/io/volume_header.hpp"

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Nrrd : public VolumeHeader {
protected:
    std::string nrrd = nrrd_header(s, "raw") + "\n" + voxels;
    /// Axis-aligned, 1 apart, the first voxel at (1, 2, 3).
    std::string plain(const std::string& space, const std::string& more = {}) {
        return fmt::format("NRRD0004\ntype: short\ndimension: 3\n{}sizes: 5 4 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nkinds: domain "
                           "domain domain\nendian: little\nencoding: raw\nspace origin: (1,2,3)\n{}\n",
                           space.empty() ? space : "space: " + space + "\n", more) +
               voxels;
    }
    /// Another axis before or behind those of space.
    std::string with_axis(int count, const std::string& kind, bool fastest, const std::string& direction = "none") {
        std::string h = replaced(nrrd_header(s, "raw"), "dimension: 3", "dimension: 4");
        h = replaced(h, "sizes: 5 4 3", fastest ? fmt::format("sizes: {} 5 4 3", count) : fmt::format("sizes: 5 4 3 {}", count));
        h = fastest ? replaced(h, "space directions: ", "space directions: " + direction + " ")
                    : replaced(h, "\nkinds", " " + direction + "\nkinds");
        h = kind.empty() ? replaced(h, "kinds: domain domain domain\n", "")
                         : replaced(h, "kinds: domain domain domain",
                                    "kinds: " + (fastest ? kind + " domain domain domain" : "domain domain domain " + kind));
        return h + "\n" + several(count, fastest);
    }
};

TEST_F(Nrrd, SpacesAreTurnedToLps) {
    const std::array<std::tuple<const char*, Double3, Double3>, 8> spaces{{{"left-posterior-superior", {1, 1, 1}, {1, 2, 3}},
                                                                           {"LPS", {1, 1, 1}, {1, 2, 3}},
                                                                           {"right-anterior-superior", {-1, -1, 1}, {-1, -2, 3}},
                                                                           {"RAS", {-1, -1, 1}, {-1, -2, 3}},
                                                                           {"left-anterior-superior", {1, -1, 1}, {1, -2, 3}},
                                                                           {"LAS", {1, -1, 1}, {1, -2, 3}},
                                                                           {"Left-Anterior-Superior", {1, -1, 1}, {1, -2, 3}},
                                                                           {"scanner-xyz", {1, 1, 1}, {1, 2, 3}}}};
    for (const auto& [space, signs, origin] : spaces) {
        SCOPED_TRACE(space);
        const Voxels v = read("a.nrrd", plain(space));
        expect_voxels(v);
        expect_near(v.geometry.origin, origin);
        expect_direction(v, {{{signs[0], 0, 0}, {0, signs[1], 0}, {0, 0, signs[2]}}});
        EXPECT_EQ(v.decisions.empty(), std::string(space) != "scanner-xyz");
    }
    EXPECT_THAT(read("a.nrrd", plain("3D-left-handed")).decisions, Contains(HasSubstr("3d-left-handed")));
    EXPECT_THAT(read("a.nrrd", plain("")).decisions, Contains(HasSubstr("no space")));
    refused("a.nrrd", plain("left-right-superior"), {"left-right-superior", "not known"});
}

TEST_F(Nrrd, SpacesWithTime) {
    for (const char* space : {"right-anterior-superior-time", "RAST"}) {
        std::string h = fmt::format("NRRD0005\ntype: short\ndimension: 4\nspace: {}\nsizes: 5 4 3 2\nspace directions: (1,0,0,0) (0,2,0,0) "
                                    "(0,0,3,0) (0,0,0,0.5)\nendian: little\nencoding: raw\nspace origin: (1,2,3,9)\nspace units: \"mm\" "
                                    "\"mm\" \"mm\" \"s\"\n\n",
                                    space);
        const Voxels v = read("a.nrrd", h + several(2, false), frame(1));
        expect_voxels(v, 1);
        expect_near(v.geometry.spacing, {1, 2, 3});
        expect_near(v.geometry.origin, {-1, -2, 3});
        EXPECT_THAT(v.notes, IsEmpty());
        EXPECT_THAT(v.decisions, Contains(HasSubstr("frame 1 of 0 to 1")));
        expect_error([&] { read("a.nrrd", h + several(2, false), frame(2)); }, {"2 frames"});
    }
}

TEST_F(Nrrd, SpacingsAlone) {
    std::string header = "NRRD0001\ntype: unsigned short\ndimension: 3\nsizes: 5 4 3\nspacings: 0.5 0.75 2\nencoding: raw\nendian: big\n\n";
    std::vector<std::uint16_t> values(s.voxels.begin(), s.voxels.end());
    const Voxels v = read("a.nrrd", header + bytes_of(values, true));
    EXPECT_EQ(v.type, VoxelType::u16);
    EXPECT_TRUE(std::equal(values.begin(), values.end(), v.data<std::uint16_t>()));
    EXPECT_EQ(v.geometry.spacing, (Double3{0.5, 0.75, 2}));
    EXPECT_THAT(read("b.nrrd", replaced(header, "spacings: 0.5 0.75 2\n", "") + bytes_of(values)).notes,
                Contains(HasSubstr("1 mm is assumed")));
}

TEST_F(Nrrd, AxisMinsAndCenterings) {
    const std::string header = "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nencoding: raw\nendian: little\naxis mins: 10 20 30\n";
    const Voxels cells = read("a.nrrd", header + "spacings: 2 3 4\n\n" + voxels);
    expect_near(cells.geometry.origin, {11, 21.5, 32});
    const Voxels nodes = read("a.nrrd", header + "spacings: 2 3 4\ncenters: node node cell\n\n" + voxels);
    expect_near(nodes.geometry.origin, {10, 20, 32});
    const Voxels range = read("a.nrrd", header + "axis maxs: 20 26 36\ncenterings: cell node node\n\n" + voxels);
    expect_near(range.geometry.spacing, {2, 2, 3});
    expect_near(range.geometry.origin, {11, 20, 30});
    EXPECT_THAT(range.decisions, Contains(HasSubstr("axis maxs")));
}

TEST_F(Nrrd, UnitsBecomeMillimetres) {
    const std::array<std::pair<const char*, double>, 14> units{{{"um", 1e-3},
                                                                {"micrometers", 1e-3},
                                                                {"microns", 1e-3},
                                                                {"\xc2\xb5m", 1e-3},
                                                                {"\xce\xbcm", 1e-3},
                                                                {"\xb5m", 1e-3},
                                                                {"nm", 1e-6},
                                                                {"Nanometres", 1e-6},
                                                                {"meters", 1000},
                                                                {"m", 1000},
                                                                {"cm", 10},
                                                                {"inches", 25.4},
                                                                {"ft", 304.8},
                                                                {"mm", 1}}};
    for (const auto& [unit, mm] : units) {
        SCOPED_TRACE(unit);
        const Voxels v = read("a.nrrd", plain("LPS", fmt::format("space units: \"{0}\" \"{0}\" \"{0}\"\n", unit)));
        expect_near(v.geometry.spacing, {mm, mm, mm});
        expect_near(v.geometry.origin, {mm, 2 * mm, 3 * mm});
        EXPECT_THAT(v.notes, IsEmpty());
    }
    const Voxels mixed = read("a.nrrd", plain("RAS", "space units: \"um\" \"um\" \"mm\"\n"));
    expect_near(mixed.geometry.spacing, {1e-3, 1e-3, 1});
    expect_near(mixed.geometry.origin, {-1e-3, -2e-3, 3});
    const Voxels unknown = read("a.nrrd", plain("LPS", "space units: \"parsec\" \"parsec\" \"parsec\"\n"));
    expect_near(unknown.geometry.spacing, {1, 1, 1});
    EXPECT_THAT(unknown.notes, ::testing::ElementsAre(HasSubstr("\"parsec\"")));
    const std::string spaced = "NRRD0001\ntype: short\ndimension: 3\nsizes: 5 4 3\nspacings: 2 2 2\nunits: \"nm\" \"um\" mm\nendian: "
                               "little\nencoding: raw\n\n";
    expect_near(read("a.nrrd", spaced + voxels).geometry.spacing, {2e-6, 2e-3, 2});
    refused("a.nrrd", plain("LPS", "space units: \"mm\" \"mm\"\n"), {"space units", "2 entries"});
}

TEST_F(Nrrd, TimesAreFrames) {
    for (const char* kind : {"time", "list", "domain", ""})
        for (const bool fastest : {true, false}) {
            SCOPED_TRACE(fmt::format("{} {}", kind, fastest));
            const Voxels v = read("a.nrrd", with_axis(3, kind, fastest), frame(2));
            expect_voxels(v, 2);
            expect_near(v.geometry.origin, s.geometry.origin);
            EXPECT_THAT(v.decisions, Contains(HasSubstr("frame 2 of 0 to 2")));
            EXPECT_EQ(v.frames, 3);
            refused("a.nrrd", with_axis(3, kind, fastest), {"frame 3", "3 frames"}, frame(3));
        }
    // In the middle of the axes of space.
    std::vector<std::int16_t> all;
    for (std::size_t row = 0; row < s.voxels.size() / 20; ++row)
        for (int t = 0; t < 2; ++t)
            for (std::size_t i = 0; i < 20; ++i) all.push_back(static_cast<std::int16_t>(s.voxels[row * 20 + i] + t));
    const std::string h =
        "NRRD0005\ntype: short\ndimension: 4\nsizes: 5 4 2 3\nspacings: 1 1 nan 2\nkinds: domain domain time domain\nendian: "
        "little\nencoding: raw\n\n";
    const Voxels v = read("a.nrrd", h + bytes_of(all), frame(1));
    expect_voxels(v, 1);
    expect_near(v.geometry.spacing, {1, 1, 2});
}

TEST_F(Nrrd, VectorsAreChannels) {
    for (const bool fastest : {true, false}) {
        const std::string file = with_axis(3, "vector", fastest);
        const Voxels first = read("a.nrrd", file);
        expect_voxels(first, 0);
        EXPECT_THAT(first.notes, Contains(HasSubstr("3 channels")));
        const Voxels last = read("a.nrrd", file, channel(2));
        expect_voxels(last, 2);
        EXPECT_THAT(last.notes, IsEmpty());
        refused("a.nrrd", file, {"channel 3"}, channel(3));
        refused("a.nrrd", file, {"frame 1"}, frame(1));
        expect_voxels(read("a.nrrd", with_axis(3, "list", fastest), channel(1)), 1);
    }
    for (const char* kind : {"RGB-color", "complex", "3D-matrix"}) {
        refused("a.nrrd", with_axis(3, kind, true), {"3 values", "--channel"});
        expect_voxels(read("a.nrrd", with_axis(3, kind, true), channel(1)), 1);
    }
    refused("a.nrrd", with_axis(3, "colour", true), {"colour", "not known"});
    for (const char* kind : {"vector", "scalar", "stub", "list", "time"}) {
        const Voxels v = read("a.nrrd", with_axis(1, kind, true));
        expect_voxels(v);
        EXPECT_THAT(v.notes, IsEmpty());
    }
}

TEST_F(Nrrd, FewerAxesOfSpace) {
    const Voxels v =
        read("a.nrrd", "NRRD0004\ntype: short\ndimension: 2\nspace: LPS\nsizes: 20 3\nspace directions: (0,2,0) (0,0,3)\nendian: "
                       "little\nencoding: raw\n\n" +
                           voxels);
    EXPECT_EQ(v.dims, (Int3{20, 3, 1}));
    expect_near(v.geometry.spacing, {2, 3, 1});
    EXPECT_NEAR(std::abs(v.geometry.direction.determinant()), 1, 1e-12);
}

TEST_F(Nrrd, EncodingsAndSkips) {
    write(folder / "a.raw", std::string(100, 'x') + voxels);
    for (const char* skip : {"100", "-1"})
        expect_voxels(read("a.nhdr", nrrd_header(s, "raw", std::string("byte skip: ") + skip + "\ndata file: a.raw\n")));
    write(folder / "b.raw", "two\r\nlines\nxx" + voxels + "tail");
    expect_voxels(read("b.nhdr", nrrd_header(s, "raw", "line skip: 2\nbyte skip: 2\ndata file: B.RAW\n"))); // case does not matter
    expect_voxels(read("b.nhdr", nrrd_header(s, "raw", "byte skip: -5\ndata file: b.raw\n")));
    write(folder / "c.gz", "a line\n" + deflated("head" + voxels));
    expect_voxels(read("c.nhdr", nrrd_header(s, "gz", "lineskip: 1\nbyteskip: 4\ndatafile: c.gz\n")));
    expect_voxels(read("d.nrrd", nrrd_header(s, "bz2") + "\n" + bzip2ed(voxels.substr(0, 50)) + bzip2ed(voxels.substr(50))));
    expect_voxels(read("d.nrrd", nrrd_header(s, "gzi") + "\n" + deflated(voxels)));
    expect_voxels(read("d.nrrd", nrrd_header(s, "HEX") + "\n" + hexed(voxels) + "\n"));
    std::vector<float> reals{0.1f, -1e-3f, 3e38f, std::nanf("")};
    const Voxels text = read("e.nrrd", "NRRD0004\ntype: float\ndimension: 1\nsizes: 4\nencoding: text\n\n0.1, -1e-3\n3e38 nan");
    EXPECT_TRUE(std::equal(reals.begin(), reals.end() - 1, text.data<float>()));
    EXPECT_EQ(text.repaired, 1u);
    refused("a.nhdr", nrrd_header(s, "gzip", "byte skip: -1\ndata file: c.gz\n"), {"byte skip", "raw"});
    refused("d.nrrd", nrrd_header(s, "hex") + "\n" + replaced(hexed(voxels), "\n", "z"), {"hexadecimal"});
    refused("d.nrrd", nrrd_header(s, "bzip2") + "\n" + bzip2ed(voxels.substr(2)), {"expected 120 bytes", "found 118"});
    refused("d.nrrd", nrrd_header(s, "gzip") + "\n" + deflated(voxels + "more"), {"expected 120 bytes", "found 124"});
}

TEST_F(Nrrd, DamagedBzip2IsFound) {
    const std::string head = nrrd_header(s, "bzip2") + "\n", packed = bzip2ed(voxels);
    for (std::size_t i = 0; i + 1 < packed.size(); ++i) { // the last byte has unused bits
        std::string damaged = packed;
        damaged[i] ^= 4;
        refused("a.nrrd", head + damaged, {"a.nrrd"});
    }
}

TEST_F(Nrrd, HostileBzip2IsDecodedBeforeMemoryIsTaken) {
    std::string h = nrrd_header(s, "bzip2");
    h = replaced(h, "sizes: 5 4 3", "sizes: 100000 100000 10");
    refused("a.nrrd", h + "\n" + bzip2ed(voxels), {"200000000000 bytes", "found 120"});
}

TEST_F(Nrrd, FilesInARow) {
    const auto names = write_slices(folder, s, "s_{:02}.raw");
    const auto list = [&](const std::string& field) { return nrrd_header(s, "raw", field); };
    for (const std::string& field : {"data file: LIST\n" + lines_of(names), "data file: LIST 2\n" + lines_of(names),
                                     "datafile: list\n" + lines_of(names), "data file: LIST 3\n" + lines_of(names),
                                     std::string("data file: s_%02d.raw 0 2 1\n"), std::string("data file: s_%02d.raw 0 2 1 2\n")})
        expect_voxels(read("a.nhdr", list(field)));
    const Voxels turned = read("a.nhdr", list("data file: s_%02d.raw 2 0 -1\n"));
    EXPECT_EQ(turned.data<std::int16_t>()[0], s.voxels[40]);
    refused("a.nhdr", list("data file: LIST\n" + names[0] + "\n"), {"1 data files", "expected 3"});
    refused("a.nhdr", list("data file: s_%02d.raw 0 3 1\n"), {"4 data files", "expected 3"});
    refused("a.nhdr", list("data file: s_%02d.raw 1 3 1\n"), {"s_03.raw"});
    refused("a.nhdr", list("data file: s_%02d.raw 0 2 0\n"), {"step"});
    refused("a.nhdr", list("data file: s_%02d.raw 0 2000000000000000 1\n"), {"no list"});
    refused("a.nhdr", list("data file: LIST 1\n" + lines_of(names)), {"expected 12"});
    write(folder / names[1], "short");
    refused("a.nhdr", list("data file: LIST\n" + lines_of(names)), {"s_01.raw", "expected 40 bytes"});
}

TEST_F(Nrrd, APercentSignIsNoPattern) {
    for (const char* name : {"lung 50%.raw", "100%d.raw", "%", "50% 1 2.raw"}) {
        write(folder / name, voxels);
        expect_voxels(read("a.nhdr", nrrd_header(s, "raw", fmt::format("data file: {}\n", name))));
    }
}

TEST_F(Nrrd, UnknownAndLongFieldsPass) {
    const std::string longer(20000, 'u');
    const Voxels v = read("a.nrrd", replaced(nrrd, "endian",
                                             "AnatomicalOrientation: RAI\nDICOM.instanceUIDs:=" + longer + "\nunheard of: " + longer +
                                                 "\nunheard of: twice\nmeasurement frame: (1,0,0) (0,1,0) (0,0,1)\ncontent: a: b\nold "
                                                 "min: 3\nthicknesses: nan nan 2\nendian"));
    expect_voxels(v);
    EXPECT_THAT(v.notes, IsEmpty());
}

TEST_F(Nrrd, Refuses) {
    for (const char* bad : {"(0,0,0)", "(nan,0,0)", "(inf,0,0)", "(1,0)", "(1,0,0,0)"})
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
    refused("a.nrrd", replaced(nrrd, "encoding: raw", "encoding: zrl"), {"zrl", "bzip2"});
    refused("a.nrrd", replaced(nrrd, "endian: little", "endian: middle"), {"endian", "middle"});
    refused("a.nrrd", replaced(nrrd, "endian: little\n", ""), {"endian"});
    refused("a.nrrd", replaced(nrrd, "endian", "Segment0_ID:=Segment_1\nendian"), {"segmentation"});
    refused("a.nhdr", nrrd_header(s, "raw", "data file: not_there.raw\n"), {"not_there.raw"});
    refused("a.nrrd", replaced(nrrd, "endian: little", "sizes: 5 4 3"), {"twice"});
    refused("a.nrrd", nrrd_header(s, "ascii") + "\n1 2 70000 4" + std::string(200, ' '), {"value 2", "70000", "-32768 to 32767"});
    refused("a.nrrd", nrrd_header(s, "ascii") + "\n1 2.5 7" + std::string(200, ' '), {"value 1", "2.5"});
}

} // namespace
} // namespace clvr::test

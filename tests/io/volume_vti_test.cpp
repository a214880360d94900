// VTK's XML image files: every way of writing values, grids, pieces, arrays; what is refused.
#include "tests/io/volume_header.hpp"

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class Vti : public VolumeHeader {
protected:
    static std::vector<VtiFields> every_coding() {
        std::vector<VtiFields> all;
        for (const auto mode : {VtiFields::ascii, VtiFields::binary, VtiFields::appended_raw, VtiFields::appended_base64})
            for (const auto compressor : {VtiFields::none, VtiFields::zlib, VtiFields::lz4})
                for (const bool big : {false, true})
                    for (const bool wide : {false, true})
                        for (const std::size_t block : {40u, 48u, 4096u}) all.push_back({mode, compressor, big, wide, block, {0, 0, 0}});
        return all;
    }
    /// A box of the sample: points first .. first + size - 1.
    VtiArray box(const Int3& first, const Int3& size, const VtiFields& f) {
        std::vector<std::int16_t> values;
        for (int k = first[2]; k < first[2] + size[2]; ++k)
            for (int j = first[1]; j < first[1] + size[1]; ++j)
                for (int i = first[0]; i < first[0] + size[0]; ++i)
                    values.push_back(s.voxels[static_cast<std::size_t>(i + s.dims[0] * (j + s.dims[1] * k))]);
        return vti_array("density", "Int16", values, f);
    }
};

TEST_F(Vti, EveryCoding) {
    for (const VtiFields& f : every_coding()) {
        SCOPED_TRACE(fmt::format("mode {} compressor {} big {} wide {} block {}", static_cast<int>(f.mode), static_cast<int>(f.compressor),
                                 f.big, f.wide_header, f.block));
        const Voxels v = read("a.vti", vti(s, f));
        expect_voxels(v);
        EXPECT_THAT(v.notes, IsEmpty());
        EXPECT_EQ(v.format, "VTK XML image");
    }
}

TEST_F(Vti, GridExtentAndDirection) {
    VtiFields f;
    const std::string direction = "Direction=\"0 1 0 -1 0 0 0 0 1\"";
    const Voxels v = read("a.vti", vti("WholeExtent=\"2 6 -1 2 5 7\" Origin=\"1 2 3\" Spacing=\"0.5 2 4\" " + direction,
                                       {{{2, -1, 5}, s.dims, {vti_array("density", "Int16", s.voxels, f)}}}, f));
    expect_voxels(v);
    expect_near(v.geometry.spacing, {0.5, 2, 4});
    expect_near(v.geometry.origin, {1 - 2, 2 - 1, 3 + 20}); // the first index (2, -1, 5) runs along -y, x, z
    expect_direction(v, {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}});
    EXPECT_THAT(
        read("a.vti", vti("WholeExtent=\"0 4 0 3 0 2\"", {{{0, 0, 0}, s.dims, {vti_array("density", "Int16", s.voxels, f)}}}, f)).notes,
        Contains(HasSubstr("1 mm is assumed")));
}

TEST_F(Vti, CellsLieBetweenPoints) {
    VtiFields f;
    VtiArray a = vti_array("density", "Int16", s.voxels, f);
    a.of_cells = true;
    const Voxels v = read("a.vti", vti("WholeExtent=\"0 5 1 5 0 3\" Origin=\"0 0 0\" Spacing=\"1 2 4\"", {{{0, 1, 0}, {6, 5, 4}, {a}}}, f));
    expect_voxels(v);
    expect_near(v.geometry.origin, {0.5, 3, 2});
    EXPECT_THAT(v.decisions, Contains(HasSubstr("cells")));
}

TEST_F(Vti, PiecesAreJoined) {
    for (const auto mode : {VtiFields::ascii, VtiFields::binary, VtiFields::appended_raw}) {
        VtiFields f;
        f.mode = mode;
        f.compressor = VtiFields::zlib;
        const std::string image = "WholeExtent=\"0 4 0 3 0 2\" Origin=\"0 0 0\" Spacing=\"1 1 1\"";
        // As VTK cuts: the pieces share a plane of points.
        const std::vector<VtiPiece> pieces{{{0, 0, 0}, {3, 4, 3}, {box({0, 0, 0}, {3, 4, 3}, f)}},
                                           {{2, 0, 0}, {3, 2, 3}, {box({2, 0, 0}, {3, 2, 3}, f)}},
                                           {{2, 1, 0}, {3, 3, 3}, {box({2, 1, 0}, {3, 3, 3}, f)}}};
        expect_voxels(read("a.vti", vti(image, pieces, f)));
        refused("a.vti", vti(image, {pieces[0], pieces[1]}, f), {"2 pieces leave"});
        refused("a.vti", vti(image, {pieces[0]}, f), {"1 pieces leave"});
        std::vector<VtiPiece> wrong = pieces;
        wrong[1].arrays[0].name = "other";
        refused("a.vti", vti(image, wrong, f), {"piece 1", "density"});
        refused("a.vti", vti("WholeExtent=\"0 4 0 3 0 1\"", pieces, f), {"outside of WholeExtent"});
    }
    VtiFields f; // two layers of cells
    const std::size_t layer = s.voxels.size() / 3;
    VtiArray low = vti_array("d", "Int16", std::vector<std::int16_t>(s.voxels.begin(), s.voxels.begin() + layer), f);
    VtiArray high = vti_array("d", "Int16", std::vector<std::int16_t>(s.voxels.begin() + layer, s.voxels.end()), f);
    low.of_cells = high.of_cells = true;
    expect_voxels(read(
        "a.vti", vti("WholeExtent=\"0 5 0 4 0 3\" Spacing=\"1 1 1\"", {{{0, 0, 0}, {6, 5, 2}, {low}}, {{0, 0, 1}, {6, 5, 3}, {high}}}, f)));
}

TEST_F(Vti, ArraysAndComponents) {
    VtiFields f;
    std::vector<std::int16_t> all;
    for (const auto v : s.voxels)
        for (std::int16_t c = 0; c < 2; ++c) all.push_back(static_cast<std::int16_t>(v + c));
    VtiArray pairs = vti_array("pairs", "Int16", all, f), cells = vti_array("cells", "Float64", std::vector<double>(24, 0.5), f),
             bytes = vti_array("bytes", "UInt8", std::vector<std::uint8_t>(60, 9), f);
    pairs.components = 2;
    cells.of_cells = true;
    const std::string image = "WholeExtent=\"0 4 0 3 0 2\" Spacing=\"1 1 1\"";
    const std::vector<VtiPiece> pieces{{{0, 0, 0}, s.dims, {pairs, bytes, vti_array("density", "Int16", s.voxels, f), cells}}};
    const Voxels active = read("a.vti", vti(image, pieces, f, "density"));
    expect_voxels(active);
    EXPECT_THAT(active.notes,
                Contains(AllOf(HasSubstr("\"pairs\""), HasSubstr("\"cells\" (of cells)"), HasSubstr("\"density\" is taken"))));
    EXPECT_EQ(read("a.vti", vti(image, pieces, f)).type, VoxelType::u8); // the first with one component
    const Voxels other = read("a.vti", vti(image, pieces, f, "density"), array("cells"));
    EXPECT_EQ(other.dims, (Int3{4, 3, 2}));
    EXPECT_EQ(other.data<float>()[23], 0.5f);
    VolumeReadOptions second = channel(1);
    second.array = "pairs";
    expect_voxels(read("a.vti", vti(image, pieces, f), second), 1);
    EXPECT_THAT(read("a.vti", vti(image, pieces, f), array("pairs")).notes, Contains(HasSubstr("2 channels")));
    refused("a.vti", vti(image, pieces, f), {"no data array \"x\"", "\"bytes\""}, array("x"));
    second.channel = 2;
    refused("a.vti", vti(image, pieces, f), {"channel 2"}, second);
    refused("a.vti", vti(image, {{{0, 0, 0}, s.dims, {}}}, f), {"no data array"});
    const std::string twice =
        replaced(vti(image, {{{0, 0, 0}, s.dims, {vti_array("d", "Int16", s.voxels, f), bytes}}}, f), "Name=\"bytes\"", "Name=\"d\"");
    refused("a.vti", twice, {"piece 0"}, frame(1)); // another type at the second step
}

TEST_F(Vti, DamagedZlibBlocksAreFound) {
    VtiFields f;
    f.compressor = VtiFields::zlib;
    const std::string file = vti(s, f);
    for (std::size_t i = file.find("   _") + 4; i < file.size() - std::string(vti_tail).size(); ++i) {
        std::string damaged = file;
        damaged[i] ^= 4;
        try {
            expect_voxels(read("a.vti", damaged)); // deflate has a few unused bits
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input) << e.line();
        }
    }
}

TEST_F(Vti, Refuses) {
    VtiFields f;
    const std::string good = vti(s, f);
    for (const auto& [type, word] : std::vector<std::pair<std::string, std::string>>{{"UnstructuredGrid", "UnstructuredGrid"},
                                                                                     {"PolyData", "PolyData"},
                                                                                     {"RectilinearGrid", "RectilinearGrid"},
                                                                                     {"PImageData", ".pvti"}})
        refused("a.vti", replaced(good, "type=\"ImageData\"", "type=\"" + type + "\""), {word});
    refused("a.vti", replaced(good, "LittleEndian", "MiddleEndian"), {"MiddleEndian"});
    refused("a.vti", replaced(good, "UInt32", "UInt16"), {"UInt16"});
    refused("a.vti", replaced(good, "header_type", "compressor=\"vtkLZMADataCompressor\" header_type"), {"vtkLZMADataCompressor", "zlib"});
    refused("a.vti", replaced(good, "WholeExtent=\"0 4 0 3 0 2\"", "WholeExtent=\"0 4 0 3 0 3\""), {"1 pieces leave"});
    refused("a.vti", replaced(good, "WholeExtent=\"0 4 0 3 0 2\"", "WholeExtent=\"0 4 0 3 2 0\""), {"WholeExtent"});
    refused("a.vti", replaced(good, "offset=\"0\"", "offset=\"100000\""), {"truncated"});
    refused("a.vti", replaced(good, "offset=\"0\"", "offset=\"-1\""), {"offset"});
    refused("a.vti", replaced(good, "\"Int16\"", "\"Int32\""), {"expected 240 bytes", "found 120"});
    refused("a.vti", replaced(good, "\"Int16\"", "\"Bit\""), {"Bit"});
    refused("a.vti", replaced(good, "encoding=\"raw\"", "encoding=\"rot13\""), {"encoding"});
    refused("a.vti", good.substr(0, good.find("<AppendedData") + 20), {"AppendedData", "truncated"});
    refused("a.vti", good.substr(0, good.find("<AppendedData")), {"XML"});
    refused("a.vti", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\">", {"XML"});
    refused("a.vti", "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\"></VTKFile>", {"no ImageData"});
    refused("a.vti", "<?xml version=\"1.0\"?>\n<svg/>", {"a.vti"});
    refused("a.vti", deflated(good), {"gunzip"});
    refused("a.vti.gz", deflated(good), {"gunzip"});
    const std::string huge = replaced(replaced(good, "0 4 0 3 0 2", "0 99999 0 99999 0 9"), "0 4 0 3 0 2", "0 99999 0 99999 0 9");
    refused("a.vti", huge, {"expected 200000000000 bytes"});
}

TEST_F(Vti, HostileBlocks) {
    VtiFields f;
    f.compressor = VtiFields::lz4;
    const std::string good = vti(s, f);
    const std::size_t at = good.find("   _") + 4;
    for (std::size_t number = 0; number < 6; ++number)
        for (const std::uint32_t value : {0u, 1u, 0x7fffffffu, 0xffffffffu}) {
            std::string bad = good;
            bad.replace(at + 4 * number, 4, clvr::test::number(value));
            if (bad != good) refused("a.vti", bad, {"a.vti"});
        }
}

TEST_F(Vti, IsKnownByItsBytes) {
    EXPECT_EQ(read("a.dat", vti(s, {})).format, "VTK XML image");
    EXPECT_EQ(read("a.VTI", replaced(vti(s, {}), "<?xml version=\"1.0\"?>\n", "")).format, "VTK XML image");
}

} // namespace
} // namespace clvr::test

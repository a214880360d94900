// Legacy VTK: what its header can say, and what is refused.
#include "tests/io/volume_header.hpp"

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class LegacyVtk : public VolumeHeader {
protected:
    std::string big = bytes_of(s.voxels, true), vtk = vtk_header(s) + big;
    /// Up to the arrays.
    std::string grid(const std::string& coding = "BINARY", const std::string& data = "POINT_DATA 60") {
        return "# vtk DataFile Version 5.1\n# a title\n" + coding +
               "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 4 3\nSPACING 0.5 0.75 2\nORIGIN -10.5 20.25 31\n" + data + "\n";
    }
    /// The bytes of the sample as unsigned char: modulo 256.
    std::vector<std::uint8_t> bytes() { return {s.voxels.begin(), s.voxels.end()}; }
    void expect_bytes(const Voxels& v) {
        ASSERT_EQ(v.type, VoxelType::u8);
        ASSERT_EQ(v.dims, s.dims);
        const auto expected = bytes();
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), v.data<std::uint8_t>()));
    }
};

TEST_F(LegacyVtk, TypesAndNames) {
    std::vector<float> values(s.voxels.begin(), s.voxels.end());
    values[4] = std::nanf("");
    for (const Voxels& v : {read("a.vtk", vtk_header(s, "BINARY", "float") + bytes_of(values, true)),
                            read("a.vtk", vtk_header(s, "ASCII", "float") + text_of(values))}) {
        EXPECT_EQ(v.type, VoxelType::f32);
        EXPECT_EQ(v.repaired, 1u);
        EXPECT_EQ(v.data<float>()[5], values[5]);
    }
    EXPECT_EQ(read("a.vtk", replaced(vtk, "SPACING", "ASPECT_RATIO")).geometry.spacing, s.geometry.spacing);
    expect_voxels(read("a.vtk", replaced(vtk, "density short 1", "density short")));
    expect_voxels(read("a.vtk", replaced(vtk, "SCALARS", "\r\nSCALARS")));
    std::vector<std::int8_t> small(s.voxels.begin(), s.voxels.end());
    const Voxels v = read("a.vtk", vtk_header(s, "BINARY", "signed_char") + bytes_of(small));
    ASSERT_EQ(v.type, VoxelType::i8);
    EXPECT_TRUE(std::equal(small.begin(), small.end(), v.data<std::int8_t>()));
    std::vector<std::int32_t> ids(s.voxels.begin(), s.voxels.end());
    EXPECT_EQ(read("a.vtk", vtk_header(s, "BINARY", "vtkIdType") + bytes_of(ids, true)).data<float>()[7], static_cast<float>(ids[7]));
    std::vector<std::int64_t> wide(s.voxels.begin(), s.voxels.end());
    EXPECT_EQ(read("a.vtk", vtk_header(s, "BINARY", "vtktypeint64") + bytes_of(wide, true)).data<float>()[7], static_cast<float>(wide[7]));
}

TEST_F(LegacyVtk, ColorScalarsOfOneByte) {
    std::string text;
    for (const auto b : bytes()) text += fmt::format("{} ", static_cast<float>(b) / 255.0f);
    expect_bytes(read("a.vtk", grid() + "COLOR_SCALARS density 1\n" + bytes_of(bytes())));
    expect_bytes(read("a.vtk", grid("ASCII") + "COLOR_SCALARS density 1\n" + text));
}

TEST_F(LegacyVtk, ArraysAreChosen) {
    const std::string other(60, '\x7'), vectors = bytes_of(std::vector<float>(180, 2.5f), true),
                                        metadata = "METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 9\n\n";
    const std::string file = grid() + "VECTORS way float\n" + vectors + "\n" + metadata + "FIELD FieldData 3\ncount 1 60 unsigned_char\n" +
                             other + "\n" + metadata + "names 1 2 string\n\xc3one\xc3two\nthe%20density 1 60 short\n" + big + "\n" +
                             metadata + "SCALARS flags unsigned_char 1\nLOOKUP_TABLE mine\n" + other + "\nLOOKUP_TABLE mine 2\n" +
                             std::string(8, 'x') + "\n";
    expect_voxels(read("a.vtk", file, array("the density")));
    const Voxels v = read("a.vtk", file);
    EXPECT_EQ(v.type, VoxelType::u8);
    EXPECT_THAT(v.notes, Contains(AllOf(HasSubstr("\"way\""), HasSubstr("\"the density\""), HasSubstr("\"flags\" is taken"))));
    EXPECT_EQ(read("a.vtk", file, array("way")).data<float>()[0], 2.5f);
    refused("a.vtk", file, {"no data array \"x\"", "\"the density\""}, array("x"));
    refused("a.vtk", file.substr(0, file.find("SCALARS") - 40 - 120), {"truncated"});
    // A field of the data set is no voxels.
    const std::string field =
        "FIELD FieldData 2\ntime 1 1 double\n" + bytes_of(std::vector<double>{2}, true) + "\n" + metadata + "note 1 1 string\n\xc3xyz\n";
    expect_voxels(read("a.vtk", replaced(vtk, "DIMENSIONS", field + "DIMENSIONS")));
    const std::string text = "FIELD FieldData 2\ntime 1 1 double\n2.5\nnote 1 1 string\nfree%20text\n";
    expect_voxels(read("a.vtk", replaced(vtk_header(s, "ASCII"), "DIMENSIONS", text + "DIMENSIONS") + text_of(s.voxels)));
    expect_voxels(read("a.vtk", grid() + "FIELD FieldData 1\ndensity 1 60 short\n" + big));
}

TEST_F(LegacyVtk, ComponentsAreChannels) {
    std::vector<std::int16_t> all;
    for (const auto v : s.voxels)
        for (std::int16_t c = 0; c < 3; ++c) all.push_back(static_cast<std::int16_t>(v + c));
    for (const char* kind : {"SCALARS d short 3\nLOOKUP_TABLE default", "VECTORS d short", "NORMALS d short", "FIELD f 1\nd 3 60 short",
                             "TEXTURE_COORDINATES d 3 short"}) {
        SCOPED_TRACE(kind);
        const Voxels first = read("a.vtk", grid() + kind + "\n" + bytes_of(all, true));
        expect_voxels(first);
        EXPECT_THAT(first.notes, Contains(HasSubstr("3 channels")));
        expect_voxels(read("a.vtk", grid() + kind + "\n" + bytes_of(all, true), channel(2)), 2);
        expect_voxels(read("a.vtk", grid("ASCII") + kind + "\n" + text_of(all), channel(1)), 1);
    }
}

TEST_F(LegacyVtk, CellsLieBetweenPoints) {
    const std::string cells = replaced(grid("BINARY", "CELL_DATA 60"), "DIMENSIONS 5 4 3", "DIMENSIONS 6 5 4");
    const Voxels v = read("a.vtk", cells + "SCALARS density short 1\nLOOKUP_TABLE default\n" + big);
    expect_voxels(v);
    expect_near(v.geometry.origin, {-10.25, 20.625, 32});
    EXPECT_THAT(v.decisions, Contains(HasSubstr("cells")));
    const std::string flat = replaced(replaced(cells, "DIMENSIONS 6 5 4", "DIMENSIONS 6 13 1"), "ORIGIN", "ORIGIN");
    expect_near(read("a.vtk", flat + "SCALARS density short 1\nLOOKUP_TABLE default\n" + big).geometry.origin, {-10.25, 20.625, 31});
    // Points before cells.
    const std::string both = cells + "SCALARS c short 1\nLOOKUP_TABLE default\n" + big +
                             "\nPOINT_DATA 120\nSCALARS p unsigned_char 1\nLOOKUP_TABLE default\n" + std::string(120, 'p');
    EXPECT_EQ(read("a.vtk", both).dims, (Int3{6, 5, 4}));
    expect_voxels(read("a.vtk", both, array("c")));
}

TEST_F(LegacyVtk, RectilinearGridsThatAreEven) {
    const auto axis = [](const char* name, const std::vector<float>& at) {
        return fmt::format("{} {} float\n", name, at.size()) + bytes_of(at, true) + "\n";
    };
    const std::string head = "# vtk DataFile Version 3.0\n\nBINARY\nDATASET RECTILINEAR_GRID\nDIMENSIONS 5 4 3\n",
                      data = "POINT_DATA 60\nSCALARS density short 1\nLOOKUP_TABLE default\n" + big;
    const std::string yz = axis("Y_COORDINATES", {3, 2, 1, 0}) + axis("Z_COORDINATES", {0, 5, 10});
    const Voxels v = read("a.vtk", head + axis("X_COORDINATES", {10, 10.5, 11, 11.5, 12}) + yz + data);
    expect_voxels(v);
    expect_near(v.geometry.spacing, {0.5, 1, 5});
    expect_near(v.geometry.origin, {10, 3, 0});
    expect_direction(v, {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}});
    EXPECT_THAT(v.notes, IsEmpty());
    refused("a.vtk", head + axis("X_COORDINATES", {10, 10.5, 11, 11.6f, 12}) + yz + data, {"uneven along axis 0"});
    refused("a.vtk", head + axis("X_COORDINATES", {10, 10.5, 11, 12}) + yz + data, {"axis 0", "4 coordinates"});
}

TEST_F(LegacyVtk, ExtentMovesTheFirstPoint) {
    const Voxels v = read("a.vtk", replaced(vtk, "DIMENSIONS 5 4 3", "EXTENT 2 6 -1 2 0 2"));
    expect_voxels(v);
    expect_near(v.geometry.origin, {-9.5, 19.5, 31});
}

TEST_F(LegacyVtk, Refuses) {
    for (const char* bad : {"0 1 1", "nan 1 1", "1 inf 1"})
        refused("a.vtk", replaced(vtk, "SPACING 0.5 0.75 2", std::string("SPACING ") + bad), {"SPACING"});
    refused("a.vtk", replaced(vtk, "DIMENSIONS 5 4 3", "DIMENSIONS 5 4 4"), {"POINT_DATA 60"});
    refused("a.vtk", replaced(replaced(vtk, "DIMENSIONS 5 4 3", "DIMENSIONS 5000 4000 3000"), "POINT_DATA 60", "POINT_DATA 60000000000"),
            {"120000000000 bytes"});
    refused("a.vtk", replaced(vtk, "STRUCTURED_POINTS", "UNSTRUCTURED_GRID"), {"UNSTRUCTURED_GRID"});
    refused("a.vtk", replaced(vtk, "density short 1", "density short 3"), {"expected 360 bytes"});
    refused("a.vtk", replaced(vtk, "POINT_DATA", "CELL_DATA"), {"CELL_DATA 60"});
    refused("a.vtk", replaced(vtk, "density short", "density quad"), {"quad"});
    refused("a.vtk", replaced(vtk, "density short", "density bit"), {"bit"});
    refused("a.vtk", replaced(vtk, "LOOKUP_TABLE", "LOOKDOWN_TABLE"), {"LOOKUP_TABLE"});
    refused("a.vtk", grid(), {"no data array"});
    refused("a.vtk", vtk_header(s, "ASCII") + "1 2 three" + std::string(200, ' '), {"three"});
    refused("a.vtk", vtk_header(s, "ASCII") + "1 2 3" + std::string(200, ' '), {"expected 60 voxels as text, found 3"});
    EXPECT_THAT(read("a.vtk", vtk + "\nand more").notes, Contains(HasSubstr("8 bytes after the voxels")));
}

} // namespace
} // namespace clvr::test

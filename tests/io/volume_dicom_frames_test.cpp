// DICOM files that hold many slices: functional groups, mosaics, dose, nuclear medicine.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/dicom_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class DicomFrames : public ::testing::Test {
protected:
    Folder folder;
    Sample s{Int3{5, 4, 8}};
    VolumeReadOptions options;

    std::string put(const std::string& name, const std::string& bytes) { return write(folder / ("series/" + name), bytes); }
    Voxels read() { return read_volume(folder / "series", options); }
    void expect_sample(const Voxels& v) {
        ASSERT_EQ(v.dims, s.dims);
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(v.geometry.origin[i], s.geometry.origin[i], 1e-5);
            EXPECT_NEAR(v.geometry.spacing[i], s.geometry.spacing[i], 1e-9);
            for (int j = 0; j < 3; ++j) EXPECT_NEAR(v.geometry.direction.row[i][j], s.geometry.direction.row[i][j], 1e-5);
        }
    }
    /// The voxels of the read volume, shifted by so much from the sample.
    void expect_shifted(const Voxels& v, int shift) {
        ASSERT_EQ(v.dims, s.dims);
        for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], s.voxels[i] + shift);
    }
    /// Two frames a slice, the second 1000 more, each with groups of its own.
    DicomSet twice(const std::function<DicomSet(int)>& groups, bool slices_first) {
        std::vector<EnhancedFrame> frames;
        std::string pixels;
        for (int f = 0; f < 2 * s.dims[2]; ++f) {
            const int k = slices_first ? f % s.dims[2] : f / 2, time = slices_first ? f / s.dims[2] : f % 2;
            frames.push_back({k, groups(time)});
            Sample shifted = s;
            for (auto& x : shifted.voxels) x = static_cast<std::int16_t>(x + 1000 * time);
            pixels += slice_bytes(shifted, k);
        }
        return enhanced_set(s, frames).raw(0x7fe00010, "OW", pixels);
    }
};

TEST_F(DicomFrames, AnEnhancedImageInEverySyntax) {
    for (const bool undefined : {false, true})
        for (const DicomSyntax& syntax : {DicomSyntax{}, DicomSyntax{true}, DicomSyntax{false, true}, DicomSyntax{false, false, true}}) {
            put("m.dcm", dicom_file(enhanced_set(s, all_frames(s)), syntax, undefined));
            const Voxels v = read();
            expect_sample(v);
            EXPECT_THAT(v.decisions, Contains(HasSubstr("functional groups")));
            EXPECT_TRUE(v.notes.empty()) << v.notes.front();
        }
}

TEST_F(DicomFrames, AnEnhancedImageWithOneFrameAFile) {
    for (int k = 0; k < s.dims[2]; ++k)
        put(fmt::format("{}", (5 * k) % 8), dicom_file(enhanced_set(s, {{k}}).text(0x00080018, "UI", fmt::format("1.2.3.{}", k))));
    expect_sample(read());
}

TEST_F(DicomFrames, RescalePerFrameBecomesPhysicalFloats) {
    auto frames = all_frames(s);
    for (auto& f : frames) f.slope = std::to_string(f.slice + 1);
    put("m.dcm", dicom_file(enhanced_set(s, frames)));
    const Voxels v = read();
    ASSERT_EQ(v.type, VoxelType::f32);
    EXPECT_EQ(v.slope, 1);
    for (std::size_t i = 0; i < s.voxels.size(); ++i)
        ASSERT_EQ(v.data<float>()[i], static_cast<float>(s.voxels[i] * static_cast<int>(i / 20 + 1)));
    frames[3].slope = "1,5";
    put("m.dcm", dicom_file(enhanced_set(s, frames)));
    expect_error([&] { read(); }, {"RescaleSlope", "1,5"});
}

TEST_F(DicomFrames, TimesEchoesAndDiffusionAtOnePlaceAreFrames) {
    const auto time = [](int t) {
        return DicomSet().sequence(0x00209111, {DicomSet().raw(0x00209128, "UL", number(static_cast<std::uint32_t>(t + 1)))});
    };
    const auto echo = [](int t) { return DicomSet().sequence(0x00189114, {DicomSet().real(0x00189082, 4.5 * (t + 1))}); };
    const auto diffusion = [](int t) { return DicomSet().sequence(0x00189117, {DicomSet().real(0x00189087, 1000.0 * t)}); };
    const auto stack = [](int t) { return DicomSet().sequence(0x00209111, {DicomSet().text(0x00209056, "SH", std::to_string(t))}); };
    struct Case {
        std::function<DicomSet(int)> groups;
        const char* said;
    };
    for (const auto& [groups, said] :
         {Case{time, "time"}, Case{echo, "EchoTime 4.5, 9"}, Case{diffusion, "DiffusionBValue 0, 1000"}, Case{stack, "StackID 0, 1"}})
        for (const bool slices_first : {false, true}) {
            put("m.dcm", dicom_file(twice(groups, slices_first)));
            options.frame = 0;
            expect_shifted(read(), 0);
            options.frame = 1;
            const Voxels v = read();
            expect_shifted(v, 1000);
            EXPECT_THAT(v.notes, Contains(::testing::AllOf(HasSubstr("2 times"), HasSubstr(said), HasSubstr("--frame"))));
        }
    options.frame = 2;
    expect_error([&] { read(); }, {"frame 2", "2 frames"});
}

TEST_F(DicomFrames, StacksAtOtherPlacesStandApart) {
    std::vector<EnhancedFrame> frames;
    const auto stack = [](const char* id) { return DicomSet().sequence(0x00209111, {DicomSet().text(0x00209056, "SH", id)}); };
    for (int k = 0; k < 3; ++k) frames.push_back({k + 20, stack("A")});
    for (int k = 0; k < s.dims[2]; ++k) frames.push_back({k, stack("B")});
    Sample far = s;
    far.voxels.resize(20 * 24);
    put("m.dcm", dicom_file(enhanced_set(far, frames)));
    const Voxels v = read();
    expect_sample(v);
    EXPECT_THAT(v.notes, Contains(HasSubstr("3 of 11 slices")));
}

TEST_F(DicomFrames, CompressedFramesByPiecesAndOffsetTables) {
    const auto frames = all_frames(s);
    std::vector<std::string> whole{""}, halves{""};
    std::string basic, extended;
    std::uint32_t at = 0;
    for (const auto& f : frames) {
        const std::string packed = rle_frame(slice_bytes(s, f.slice));
        whole.push_back(packed);
        halves.push_back(packed.substr(0, 70));
        halves.push_back(packed.substr(70));
        basic += number(at);
        extended += number(std::uint64_t{at});
        at += static_cast<std::uint32_t>(packed.size() + 16);
    }
    const DicomSet set = enhanced_set(s, frames);
    const auto with = [&](const std::vector<std::string>& items, const std::string& extended_table = {}) {
        DicomSet d = set;
        if (!extended_table.empty()) d.raw(0x7fe00001, "OV", extended_table);
        return dicom_file(d.raw(0x7fe00010, DicomSet::compressed, dicom_items(items)), {}, false, "1.2.840.10008.1.2.5");
    };
    put("m.dcm", with(whole));
    expect_sample(read());
    put("m.dcm", with(halves));
    expect_error([&] { read(); }, {"8 frames in 16 pieces"});
    put("m.dcm", with(halves, extended));
    expect_sample(read());
    halves[0] = basic;
    put("m.dcm", with(halves));
    expect_sample(read());
    halves[0] = basic.substr(0, 4) + number(std::uint32_t{9}) + basic.substr(8);
    put("m.dcm", with(halves));
    expect_error([&] { read(); }, {"offset table"});
    whole.pop_back();
    put("m.dcm", with(whole));
    expect_error([&] { read(); }, {"expected 8 compressed frames, found 7"});
}

TEST_F(DicomFrames, GroupsThatDoNotFitAreRefused) {
    const DicomSet good = enhanced_set(s, all_frames(s));
    const auto refused = [&](const DicomSet& set, const std::vector<std::string>& words) {
        expect_error([&] { read_volume(put("m.dcm", dicom_file(set))); }, words);
    };
    refused(DicomSet(good).text(0x00280008, "IS", "7"), {"8 items for 7 frames"});
    refused(DicomSet(good).text(0x00280008, "IS", "9"), {"expected 360 bytes of pixels, found 320"});
    refused(DicomSet(good).text(0x00280008, "IS", "4000000000"), {"NumberOfFrames"});
    refused(DicomSet(good).erase(0x52009230), {"0 items for 8 frames"});
    refused(DicomSet(good).erase(0x52009229), {"ImageOrientationPatient"});
    refused(DicomSet(good).text(0x00080060, "CS", "SEG"), {"label map"});
}

TEST_F(DicomFrames, ParametricMapsOfFloatsKeepTheirScale) {
    std::vector<float> values;
    for (int k = s.dims[2] - 1; k >= 0; --k)
        for (std::size_t i = 0; i < 20; ++i) values.push_back(0.5f * s.voxels[static_cast<std::size_t>(k) * 20 + i]);
    DicomSet d = enhanced_set(s, all_frames(s));
    d.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.30").erase(0x7fe00010).word(0x00280100, 32);
    d.raw(0x7fe00008, "OF", bytes_of(values));
    DicomSet shared;
    shared.sequence(0x00209116, {DicomSet().text(0x00200037, "DS", orientation_text(s.geometry))});
    shared.sequence(0x00289110, {DicomSet().text(0x00280030, "DS", "0.75\\0.5")});
    shared.sequence(0x00409096, {DicomSet().real(0x00409224, 3).real(0x00409225, 2)});
    put("m.dcm", dicom_file(d.sequence(0x52009229, {shared})));
    const Voxels v = read();
    ASSERT_EQ(v.type, VoxelType::f32);
    EXPECT_EQ(v.slope, 2);
    EXPECT_EQ(v.intercept, 3);
    for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<float>()[i], 0.5f * s.voxels[i]);
}

TEST_F(DicomFrames, MosaicsAreCutIntoSlicesWhereTheyLie) {
    for (const bool second_form : {true, false}) {
        put("m.dcm", dicom_file(mosaic_set(s, second_form)));
        const Voxels v = read();
        expect_sample(v);
        EXPECT_THAT(v.decisions, Contains(HasSubstr("mosaic of 8 slices")));
    }
    // Slices that follow each other against row x column.
    s.geometry.direction.row[2][2] = -1;
    put("m.dcm", dicom_file(mosaic_set(s)));
    const Voxels v = read();
    EXPECT_NEAR(v.geometry.origin[2], slice_position(s, 7)[2], 1e-9);
    EXPECT_TRUE(std::equal(s.voxels.end() - 20, s.voxels.end(), v.data<std::int16_t>()));
}

TEST_F(DicomFrames, MosaicsOfSeveralTimesAreFrames) {
    for (int t = 0; t < 3; ++t) {
        Sample later = s;
        for (auto& x : later.voxels) x = static_cast<std::int16_t>(x + 1000 * t);
        put(fmt::format("{}.ima", t),
            dicom_file(mosaic_set(later).text(0x00200012, "IS", std::to_string(t + 1)).text(0x00080018, "UI", fmt::format("1.2.3.{}", t))));
    }
    options.frame = 2;
    expect_shifted(read(), 2000);
}

TEST_F(DicomFrames, MosaicsThatDoNotSayEnoughAreNeverAFlatSlice) {
    const auto refused = [&](const DicomSet& set, const std::vector<std::string>& words) {
        expect_error([&] { read_volume(put("m.dcm", dicom_file(set))); }, words);
        expect_error([&] { read(); }, words);
    };
    refused(mosaic_set(s).erase(0x00291010), {"mosaic", "how many slices"});
    refused(mosaic_set(s).erase(0x00180088), {"mosaic", "SpacingBetweenSlices"});
    refused(mosaic_set(s).raw(0x00291010, "OB", csa_header({{"NumberOfImagesInMosaic", {"17"}}})), {"17 slices"});
    // A header cut anywhere gives no volume, or the whole one.
    const std::string csa = csa_header({{"NumberOfImagesInMosaic", {"8"}}});
    for (std::size_t n = 0; n < csa.size(); n += 2) {
        put("m.dcm", dicom_file(mosaic_set(s).raw(0x00291010, "OB", csa.substr(0, n))));
        try {
            EXPECT_EQ(read().dims, s.dims);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
        }
    }
    // Without the private header, Siemens' own element says how many; the direction is said to be taken for granted.
    put("m.dcm", dicom_file(mosaic_set(s).erase(0x00291010).word(0x0019100a, 8)));
    const Voxels v = read();
    expect_sample(v);
    EXPECT_THAT(v.notes, Contains(HasSubstr("row x column")));
}

TEST_F(DicomFrames, DoseLiesAtItsOffsetsWithItsScale) {
    DicomSet d = dicom_slice_set(s, 0);
    std::string pixels, offsets;
    for (int k = 0; k < s.dims[2]; ++k) {
        pixels += slice_bytes(s, k);
        offsets += (k == 0 ? "" : "\\") + std::to_string(2 * k);
    }
    d.text(0x00080060, "CS", "RTDOSE").text(0x00280008, "IS", "8").raw(0x7fe00010, "OW", pixels);
    d.text(0x3004000c, "DS", offsets).text(0x3004000e, "DS", "0.001");
    put("d.dcm", dicom_file(d));
    Voxels v = read();
    expect_sample(v);
    EXPECT_EQ(v.slope, 0.001);
    put("d.dcm", dicom_file(DicomSet(d).text(0x3004000c, "DS", "31\\33\\35\\37\\39\\41\\43\\45"))); // coordinates of the patient
    expect_sample(read());
    put("d.dcm", dicom_file(DicomSet(d).text(0x3004000c, "DS", "5\\7\\9\\11\\13\\15\\17\\19")));
    expect_error([&] { read(); }, {"GridFrameOffsetVector begins with 5"});
    put("d.dcm", dicom_file(DicomSet(d).text(0x3004000c, "DS", "0\\2")));
    expect_error([&] { read(); }, {"2 values for 8 frames"});
    put("d.dcm", dicom_file(DicomSet(d).erase(0x3004000c)));
    expect_error([&] { read(); }, {"8 frames", "does not say where"});
}

TEST_F(DicomFrames, NuclearMedicineByItsSignedSliceDistance) {
    DicomSet d = dicom_slice_set(s, 0);
    std::string pixels, numbers;
    for (int k = s.dims[2] - 1; k >= 0; --k) {
        pixels += slice_bytes(s, k);
        numbers += number(static_cast<std::uint16_t>(s.dims[2] - k));
    }
    const DicomSet detector =
        DicomSet().text(0x00200032, "DS", position_text(slice_position(s, 7))).text(0x00200037, "DS", orientation_text(s.geometry));
    d.text(0x00080008, "CS", "ORIGINAL\\PRIMARY\\RECON TOMO\\EMISSION").text(0x00080060, "CS", "NM").text(0x00280008, "IS", "8");
    d.erase(0x00200032).erase(0x00200037).sequence(0x00540022, {detector}).raw(0x00540080, "US", numbers);
    d.text(0x00180088, "DS", "-2").raw(0x7fe00010, "OW", pixels);
    put("n.dcm", dicom_file(d));
    expect_sample(read());
    put("n.dcm", dicom_file(DicomSet(d).text(0x00080008, "CS", "ORIGINAL\\PRIMARY\\TOMO\\EMISSION"))); // projections
    expect_error([&] { read(); }, {"8 frames", "does not say where"});
    put("n.dcm", dicom_file(DicomSet(d).erase(0x00180088)));
    expect_error([&] { read(); }, {"SpacingBetweenSlices"});
}

} // namespace
} // namespace clvr::test

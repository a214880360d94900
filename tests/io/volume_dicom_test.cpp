// DICOM: which slices make a volume, in which order, and what is refused.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/dicom_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class VolumeDicom : public ::testing::Test {
protected:
    Folder folder;
    Sample s{Int3{5, 4, 8}};
    VolumeReadOptions options;

    std::string put(const std::string& name, const DicomFields& f) { return write(folder / ("series/" + name), dicom(f)); }
    void put_all() {
        for (int k = 0; k < s.dims[2]; ++k) put(fmt::format("{}.dcm", k), dicom_slice(s, k));
    }
    Voxels read() { return read_volume(folder / "series", options); }
    bool is_sample(const Voxels& v) const {
        return v.dims == s.dims && std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>());
    }
};

TEST_F(VolumeDicom, OrderIsByPositionWhateverTheNames) {
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.instance = 100 - k;                   // numbered from the other end
        put(fmt::format("{}", (k * 5) % 8), f); // neither names nor endings tell
    }
    const Voxels v = read();
    EXPECT_TRUE(is_sample(v));
    EXPECT_NEAR(v.geometry.spacing[2], 2, 1e-9);
    EXPECT_NEAR(v.geometry.origin[2], 31, 1e-9);
    EXPECT_TRUE(v.notes.empty()) << v.notes.front();
    EXPECT_EQ(v.modality, "CT");
    EXPECT_EQ(v.format, "DICOM series");
}

TEST_F(VolumeDicom, AnyFileStandsForItsSeries) {
    put_all();
    DicomFields other = dicom_slice(s, 0);
    other.series = "9.9";
    other.instance_uid = "9.9.1";
    const std::string other_path = put("other.dcm", other);
    EXPECT_TRUE(is_sample(read_volume(folder / "series/3.dcm")));
    EXPECT_EQ(read_volume(other_path).dims[2], 1);
}

TEST_F(VolumeDicom, SeveralSeriesAreListedAndOneIsChosen) {
    put_all();
    for (int k = 0; k < 3; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.series = "7.7";
        f.instance_uid = fmt::format("7.7.{}", k);
        put(fmt::format("b{}.dcm", k), f);
    }
    EXPECT_TRUE(is_sample(read()));
    EXPECT_THAT(read().notes, Contains(::testing::AllOf(HasSubstr("2 series"), HasSubstr("7.7"), HasSubstr("5 x 4 x 3"))));
    options.series = "7.7";
    EXPECT_EQ(read().dims[2], 3);
    options.series = "8.8";
    expect_error([&] { read(); }, {"no series 8.8", "1.2.3", "7.7"});
}

TEST_F(VolumeDicom, ScaleSignAndStoredBits) {
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.slope = "2", f.intercept = "-1024";
        put(fmt::format("{}.dcm", k), f);
    }
    Voxels v = read();
    EXPECT_TRUE(is_sample(v));
    EXPECT_EQ(v.slope, 2);
    EXPECT_EQ(v.intercept, -1024);
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.bits_stored = 12; // the upper bits are none of the value
        put(fmt::format("{}.dcm", k), f);
    }
    v = read();
    for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::int16_t>()[i], ((s.voxels[i] & 0xfff) ^ 0x800) - 0x800);
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.bits_stored = 12, f.is_signed = false;
        put(fmt::format("{}.dcm", k), f);
    }
    v = read();
    EXPECT_EQ(v.type, VoxelType::u16);
    for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::uint16_t>()[i], s.voxels[i] & 0xfff);
}

TEST_F(VolumeDicom, SlicesScaledDifferentlyBecomePhysicalFloats) {
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.slope = std::to_string(k + 1);
        put(fmt::format("{}.dcm", k), f);
    }
    const Voxels v = read();
    EXPECT_EQ(v.type, VoxelType::f32);
    EXPECT_EQ(v.slope, 1);
    EXPECT_EQ(v.data<float>()[20], static_cast<float>(2 * s.voxels[20]));
    EXPECT_THAT(v.notes, Contains(HasSubstr("scaled differently")));
}

TEST_F(VolumeDicom, DuplicatesAreReported) {
    put_all();
    put("copy.dcm", dicom_slice(s, 2));
    DicomFields again = dicom_slice(s, 5);
    again.instance_uid = "1.2.3.99", again.instance = 99;
    put("again.dcm", again);
    const Voxels v = read();
    EXPECT_TRUE(is_sample(v));
    EXPECT_THAT(v.notes, Contains(HasSubstr("1 duplicate file was")));
    EXPECT_THAT(v.notes, Contains(HasSubstr("1 duplicate slice at the place of another")));
}

TEST_F(VolumeDicom, ManyTimesAtEveryPlaceAreFrames) {
    put_all();
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.instance_uid = fmt::format("1.2.3.5.{}", k);
        f.acquisition = 2;
        std::fill(f.pixels.begin(), f.pixels.end(), static_cast<char>(k));
        put(fmt::format("t{}.dcm", k), f);
    }
    EXPECT_TRUE(is_sample(read()));
    EXPECT_THAT(read().notes, Contains(HasSubstr("2 times")));
    options.frame = 1;
    EXPECT_EQ(read().data<std::int16_t>()[20], 0x0101);
    options.frame = 2;
    expect_error([&] { read(); }, {"2 frames"});
}

TEST_F(VolumeDicom, EchoesAndTypesAreNeverMixed) {
    const auto put_typed = [&](const std::string& name, int k, int number, const char* type, std::int16_t value) {
        DicomSet d = dicom_slice_set(s, k);
        d.text(0x00080008, "CS", type).text(0x00200013, "IS", std::to_string(number)).text(0x00080018, "UI", "1.2.3." + name);
        if (value != 0) d.raw(0x7fe00010, "OW", bytes_of(std::vector<std::int16_t>(20, value)));
        write(folder / ("series/" + name), dicom_file(d));
    };
    for (int k = 0; k < s.dims[2]; ++k) { // numbers alternate: by number alone, the types would mix
        put_typed(fmt::format("w{}", k), k, 2 * k + k % 2, "ORIGINAL\\PRIMARY\\WATER", 0);
        put_typed(fmt::format("f{}", k), k, 2 * k + 1 - k % 2, "ORIGINAL\\PRIMARY\\FAT", 7);
    }
    EXPECT_TRUE(is_sample(read()));
    EXPECT_THAT(read().notes, Contains(::testing::AllOf(HasSubstr("2 times"), HasSubstr("WATER, ORIGINAL\\PRIMARY\\FAT"))));
    options.frame = 1;
    EXPECT_EQ(read().data<std::int16_t>()[37], 7);
    options.frame = 0;
    for (const int k : {3, 4, 5, 6, 7}) std::filesystem::remove(folder / fmt::format("series/f{}", k)); // of the one at a few places only
    EXPECT_TRUE(is_sample(read()));
    EXPECT_THAT(read().notes, Contains(HasSubstr("3 slices of another acquisition, echo or type")));
    std::filesystem::remove(folder / "series/w0"); // and where the other is not
    const Voxels v = read();
    EXPECT_EQ(v.dims[2], 7);
    EXPECT_TRUE(std::equal(s.voxels.begin() + 20, s.voxels.end(), v.data<std::int16_t>()));
}

TEST_F(VolumeDicom, GapsAreRefusedOrInterpolated) {
    put_all();
    std::filesystem::remove(folder / "series/3.dcm");
    std::filesystem::remove(folder / "series/4.dcm");
    expect_error([&] { read(); }, {"2 of 8 slices are missing", "6.00 mm", "--allow-gaps"});
    options.allow_gaps = true;
    const Voxels v = read();
    ASSERT_EQ(v.dims, s.dims);
    EXPECT_NEAR(v.geometry.spacing[2], 2, 1e-9);
    EXPECT_THAT(v.notes, Contains(HasSubstr("2 of 8 slices are missing: interpolated")));
    for (std::size_t i = 0; i < 20; ++i) {
        const double low = s.voxels[40 + i], high = s.voxels[100 + i];
        EXPECT_EQ(v.data<std::int16_t>()[40 + i], low);
        EXPECT_EQ(v.data<std::int16_t>()[60 + i], std::round(low + (high - low) / 3));
        EXPECT_EQ(v.data<std::int16_t>()[80 + i], std::round(low + (high - low) * 2 / 3));
        EXPECT_EQ(v.data<std::int16_t>()[100 + i], high);
    }
}

TEST_F(VolumeDicom, SlicesOutOfStepAreRefused) {
    put_all();
    DicomFields f = dicom_slice(s, 3);
    const Double3 at = s.geometry.to_world({0, 0, 3.4});
    f.position = fmt::format("{}\\{}\\{}", at[0], at[1], at[2]);
    put("3.dcm", f);
    expect_error([&] { read(); }, {"1 of 8 slices", "out of step"});
    options.allow_gaps = true;
    EXPECT_EQ(read().dims, s.dims);
}

TEST_F(VolumeDicom, PositionsRoundedInTextAreNoGaps) {
    struct Case {
        double step;
        int decimals;
    };
    for (const auto& [step, decimals] :
         {Case{0.625, 2}, Case{1.25, 1}, Case{0.25, 1}, Case{0.15, 1}, Case{1.0 / 3, 2}, Case{0.4883, 2}, Case{1.25, 0}}) {
        SCOPED_TRACE(fmt::format("{} mm, {} decimals", step, decimals));
        s = Sample({3, 2, 120});
        std::filesystem::remove_all(folder / "series");
        const auto put_rounded = [&](bool with_gap) {
            for (int k = 0; k < s.dims[2]; ++k) {
                DicomFields f = dicom_slice(s, k);
                f.instance = 1000 - k;
                f.position = fmt::format("-10.5\\20.25\\{:.{}f}", -40 + step * (with_gap && k >= 60 ? k + 1 : k), decimals);
                put(fmt::format("{}.dcm", (k * 7) % 120), f);
            }
        };
        put_rounded(false);
        const Voxels v = read();
        EXPECT_TRUE(is_sample(v));
        EXPECT_NEAR(v.geometry.spacing[2], step, std::pow(10.0, -decimals) / 119);
        EXPECT_TRUE(v.notes.empty()) << v.notes.front();
        EXPECT_THAT(v.decisions, Contains(HasSubstr("from the whole span")));
        put_rounded(true);
        if (std::pow(10.0, -decimals) > 0.5 * step) { // too coarse to count: refused as well
            expect_error([&] { read(); }, {"distance of slices"});
            continue;
        }
        expect_error([&] { read(); }, {"1 of 121 slices are missing", fmt::format("{:.2f} mm from the lowest", 60 * step).substr(0, 2)});
    }
}

TEST_F(VolumeDicom, SlicesThatRoundingPutsAtOnePlaceAreRefused) {
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.position = fmt::format("0\\0\\{:.0f}", 0.6 * k);
        put(fmt::format("{}.dcm", k), f);
    }
    expect_error([&] { read(); }, {"rounded to 1 mm"});
}

TEST_F(VolumeDicom, ASliceBetweenTheOthersIsNotDroppedInSilence) {
    put_all();
    DicomFields f = dicom_slice(s, 3);
    const Double3 at = s.geometry.to_world({0, 0, 3.05});
    f.position = fmt::format("{}\\{}\\{}", at[0], at[1], at[2]);
    f.instance_uid = "1.2.3.99", f.instance = 99;
    put("between.dcm", f);
    expect_error([&] { read(); }, {"1 slice lies between"});
    options.allow_gaps = true;
    EXPECT_EQ(read().dims, s.dims);
}

TEST_F(VolumeDicom, OneSOPInstanceUIDInAllFilesIsNoCopy) {
    for (int k = 0; k < s.dims[2]; ++k) {
        DicomFields f = dicom_slice(s, k);
        f.instance_uid = "1.2.3";
        put(fmt::format("{}.dcm", k), f);
    }
    EXPECT_TRUE(is_sample(read()));
    EXPECT_TRUE(read().notes.empty());
    for (int k = 0; k < s.dims[2]; ++k) { // a second time, with the same UID too
        DicomFields f = dicom_slice(s, k);
        f.instance_uid = "1.2.3", f.acquisition = 2;
        std::fill(f.pixels.begin(), f.pixels.end(), '\1');
        put(fmt::format("t{}.dcm", k), f);
    }
    EXPECT_TRUE(is_sample(read()));
    options.frame = 1;
    EXPECT_EQ(read().data<std::int16_t>()[0], 0x0101);
}

TEST_F(VolumeDicom, ALargeScoutIsNotTheVolume) {
    put_all();
    for (const int slices : {1, 3}) {
        Sample scout({300, 200, slices});
        for (int k = 0; k < slices; ++k) {
            DicomFields f = dicom_slice(scout, k);
            f.series = "0.9", f.instance_uid = fmt::format("0.9.{}", k);
            put(fmt::format("scout{}.dcm", k), f);
        }
        const Voxels v = read();
        EXPECT_TRUE(is_sample(v));
        EXPECT_THAT(v.notes, Contains(::testing::AllOf(HasSubstr("most slices"), HasSubstr("0.9"), HasSubstr("300 x 200"))));
    }
    // A longer series that makes no volume does not win, but is listed with the reason.
    Sample other({5, 4, 12});
    for (const int k : {0, 1, 2, 3, 4, 6, 7, 8, 9, 10, 11}) {
        DicomFields f = dicom_slice(other, k);
        f.series = "0.8", f.instance_uid = fmt::format("0.8.{}", k);
        put(fmt::format("gap{}.dcm", k), f);
    }
    const Voxels v = read();
    EXPECT_TRUE(is_sample(v));
    EXPECT_THAT(v.notes, Contains(HasSubstr("no volume: 1 of 12 slices are missing")));
}

TEST_F(VolumeDicom, AGapBesideAScoutIsStillAGap) {
    put_all();
    std::filesystem::remove(folder / "series/3.dcm");
    Sample scout({300, 200, 1});
    DicomFields f = dicom_slice(scout, 0);
    f.series = "0.9", f.instance_uid = "0.9.1";
    put("scout.dcm", f);
    expect_error([&] { read(); }, {"1 of 8 slices are missing"});
}

TEST_F(VolumeDicom, ATiltedGantryKeepsAShearedVolume) {
    s.geometry.direction.row = {{{1, 0, 0}, {0, 1, std::sin(0.3)}, {0, 0, std::cos(0.3)}}};
    put_all();
    const Voxels v = read();
    EXPECT_TRUE(is_sample(v));
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(v.geometry.direction.row[i][2], s.geometry.direction.row[i][2], 1e-5);
    EXPECT_NEAR(v.geometry.spacing[2], 2, 1e-5);
    EXPECT_THAT(v.notes, Contains(HasSubstr("17.2 degrees")));
}

TEST_F(VolumeDicom, OtherSizesAndOrientationsAreLeftOut) {
    put_all();
    Sample scout({9, 9, 1});
    scout.geometry.direction.row = {{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
    DicomFields f = dicom_slice(scout, 0);
    f.instance_uid = "1.2.3.77";
    put("scout.dcm", f);
    EXPECT_TRUE(is_sample(read()));
    EXPECT_THAT(read().notes, Contains(HasSubstr("1 of 9 slices have another size or orientation")));
}

TEST_F(VolumeDicom, WhatIsNoSliceIsNotedAndAloneRefused) {
    const auto alone = [&](const std::function<void(DicomFields&)>& change, const std::vector<std::string>& words) {
        DicomFields f = dicom_slice(s, 0);
        f.instance_uid = "1.2.3.55";
        change(f);
        const std::string bytes = dicom(f);
        expect_error([&] { read_volume(write(folder / "alone/x.dcm", bytes)); }, words);
        expect_error([&] { read_volume(folder / "alone"); }, words);
        put_all();
        write(folder / "series/x.dcm", bytes);
        const Voxels v = read();
        EXPECT_TRUE(is_sample(v));
        EXPECT_THAT(v.notes, Contains(HasSubstr("1 DICOM file was left out")));
    };
    alone([](DicomFields& f) { f.photometric = "RGB", f.samples = 3; }, {"colours", "RGB"});
    alone([](DicomFields& f) { f.photometric = "PALETTE COLOR"; }, {"PALETTE"});
    alone([](DicomFields& f) { f.modality = "SEG"; }, {"label map"});
    alone(
        [](DicomFields& f) {
            f.frames = "2";
            f.pixels += f.pixels;
        },
        {"2 frames", "where each of them lies"});
    alone([](DicomFields& f) { f.position.clear(); }, {"ImagePositionPatient"});
    alone([](DicomFields& f) { f.orientation = "1\\0\\0\\1\\0\\0"; }, {"ImageOrientationPatient"});
    alone([](DicomFields& f) { f.orientation = "1\\0\\0\\0\\nan\\0"; }, {"ImageOrientationPatient"});
    alone([](DicomFields& f) { f.spacing = "0\\1"; }, {"PixelSpacing"});
    alone([](DicomFields& f) { f.spacing = "nan\\1"; }, {"PixelSpacing"});
    alone([](DicomFields& f) { f.bits_stored = 17; }, {"17 bits"});
}

TEST_F(VolumeDicom, ADamagedFileIsRefusedOrWithGapsLeftOut) {
    put_all();
    const std::string whole = test::read(folder / "series/3.dcm");
    write(folder / "series/3.dcm", whole.substr(0, 300));
    expect_error([&] { read(); }, {"3.dcm", "not sound as DICOM", "--allow-gaps"});
    options.allow_gaps = true;
    EXPECT_EQ(read().dims, s.dims);
    write(folder / "series/3.dcm", whole.substr(0, whole.size() - 1));
    expect_error([&] { read(); }, {"3.dcm", "expected 40 bytes of pixels, found 39"});
}

TEST_F(VolumeDicom, DamagedCompressedPixelsAreAnErrorNeverACrash) {
    DicomFields f = dicom_slice(s, 0);
    f.rle = true;
    const std::string whole = dicom(f);
    for (std::size_t i = whole.size() - rle_frame(f.pixels).size() - 8; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(~damaged[i]);
        try {
            read_volume(write(folder / "x.dcm", damaged));
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::input);
        }
    }
}

} // namespace
} // namespace clvr::test

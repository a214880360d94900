// DICOM: texts that are no numbers, padding, modality tables, stored bits.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/dicom_writers.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class DicomValues : public ::testing::Test {
protected:
    Folder folder;
    Sample s{Int3{5, 4, 6}};
    VolumeReadOptions options;

    void put(const std::function<void(DicomSet&, int)>& change, const DicomSyntax& syntax = {}) {
        for (int k = 0; k < s.dims[2]; ++k) {
            DicomSet d = dicom_slice_set(s, k);
            change(d, k);
            write(folder / fmt::format("series/{}.dcm", k), dicom_file(d, syntax));
        }
    }
    Voxels read() { return read_volume(folder / "series", options); }
    void refused(const std::function<void(DicomSet&, int)>& change, const std::vector<std::string>& words) {
        put(change);
        expect_error([&] { read(); }, words);
        expect_error([&] { read_volume(folder / "series/0.dcm"); }, words);
    }
};

TEST_F(DicomValues, TextsThatAreNoNumbersAreRefused) {
    for (const char* text : {"1,5", "abc", "1.5.2", "0x10", "1 5", "1.5\\2", "--2"}) {
        refused([&](DicomSet& d, int) { d.text(0x00281053, "DS", text); }, {"RescaleSlope", text});
        refused([&](DicomSet& d, int) { d.text(0x00281052, "DS", text); }, {"RescaleIntercept", text});
    }
    refused([](DicomSet& d, int) { d.text(0x00281053, "DS", "1,5"); }, {"decimal point"});
    refused([](DicomSet& d, int) { d.text(0x00281053, "DS", "0"); }, {"RescaleSlope is 0"});
    refused([](DicomSet& d, int) { d.text(0x00281053, "DS", "inf"); }, {"RescaleSlope", "finite"});
    refused([](DicomSet& d, int) { d.text(0x00280030, "DS", "0,5\\0,5"); }, {"PixelSpacing", "0,5"});
    refused([](DicomSet& d, int k) { d.text(0x00200032, "DS", fmt::format("0\\0\\{},5", k)); }, {"ImagePositionPatient", ",5"});
    refused([](DicomSet& d, int) { d.text(0x00200037, "DS", "1,0\\0\\0\\0\\1\\0"); }, {"ImageOrientationPatient", "1,0"});
}

TEST_F(DicomValues, OneUnreadableSliceIsNotLeftOutInSilence) {
    const auto last = [](DicomSet& d, int k) {
        if (k == 5) d.text(0x00281053, "DS", "1,5");
    };
    put(last);
    expect_error([&] { read(); }, {"5.dcm", "RescaleSlope", "--allow-gaps"});
    options.allow_gaps = true;
    const Voxels v = read();
    EXPECT_EQ(v.dims[2], 5);
    EXPECT_THAT(v.notes, Contains(HasSubstr("1 DICOM file was left out")));
}

TEST_F(DicomValues, NumbersInAllTheirWritingsAreRead) {
    for (const char* text : {"1.5", " 1.5 ", "+1.5", "1.5E0", "15e-1", "1.50"}) {
        put([&](DicomSet& d, int) { d.text(0x00281053, "DS", text); });
        EXPECT_EQ(read().slope, 1.5) << text;
    }
    put([](DicomSet& d, int) { d.text(0x00281053, "DS", "").text(0x00281052, "DS", ""); }); // empty is absent
    EXPECT_EQ(read().slope, 1);
    EXPECT_EQ(read().intercept, 0);
}

TEST_F(DicomValues, AThicknessMattersForOneSliceAlone) {
    const auto comma = [](DicomSet& d, int) { d.text(0x00180050, "DS", "1,5"); };
    put(comma);
    EXPECT_NEAR(read().geometry.spacing[2], 2, 1e-9);
    s = Sample(Int3{5, 4, 1});
    std::filesystem::remove_all(folder / "series");
    put(comma);
    expect_error([&] { read(); }, {"SliceThickness", "no number"});
    put([](DicomSet& d, int) { d.text(0x00180050, "DS", "-3"); });
    EXPECT_EQ(read().geometry.spacing[2], 1);
    EXPECT_THAT(read().notes, Contains(HasSubstr("without a thickness")));
}

TEST_F(DicomValues, SomeSlicesWithSlopeZeroAreSaid) {
    put([](DicomSet& d, int k) { d.text(0x00281053, "DS", k == 2 ? "0" : "2"); });
    const Voxels v = read();
    EXPECT_EQ(v.type, VoxelType::f32);
    EXPECT_EQ(v.data<float>()[45], 0);
    EXPECT_EQ(v.data<float>()[65], 2.0f * s.voxels[65]);
    EXPECT_THAT(v.notes, Contains(HasSubstr("RescaleSlope 0")));
}

TEST_F(DicomValues, PaddingTakesTheMinimumOfTheOthers) {
    for (auto& x : s.voxels) x = static_cast<std::int16_t>(std::max<int>(x, -900));
    for (const int i : {0, 7, 64, 119}) s.voxels[static_cast<std::size_t>(i)] = -2000;
    const auto expect_filled = [&](const Voxels& v, std::int16_t fill, const std::string& said) {
        for (std::size_t i = 0; i < s.voxels.size(); ++i) {
            const bool padding = i == 0 || i == 7 || i == 64 || i == 119;
            ASSERT_EQ(v.data<std::int16_t>()[i], padding ? fill : s.voxels[i]) << i;
        }
        EXPECT_THAT(v.decisions, Contains(HasSubstr(said)));
        EXPECT_TRUE(v.notes.empty()) << v.notes.front();
    };
    const std::int16_t least =
        *std::min_element(s.voxels.begin(), s.voxels.end(), [](int a, int b) { return (a == -2000 ? 9999 : a) < (b == -2000 ? 9999 : b); });
    for (const bool big : {false, true}) {
        put([](DicomSet& d, int) { d.word(0x00280120, -2000, "SS"); }, DicomSyntax{false, big});
        expect_filled(read(), least, "padding -2000: 4 voxels take the minimum");
    }
    put([](DicomSet& d, int) { d.word(0x00280120, -2000, "US"); }); // the pixels' sign counts, not the type
    expect_filled(read(), least, "padding -2000: 4 voxels");
    for (const bool swapped : {false, true}) {
        put([&](DicomSet& d, int) { d.word(0x00280120, swapped ? -1500 : -2500, "SS").word(0x00280121, swapped ? -2500 : -1500, "SS"); });
        expect_filled(read(), least, "padding -2500 to -1500: 4 voxels");
    }
    const std::int16_t greatest = *std::max_element(s.voxels.begin(), s.voxels.end());
    put([](DicomSet& d, int) { d.word(0x00280120, -2000, "SS").text(0x00281053, "DS", "-1"); }); // least as a physical value
    expect_filled(read(), greatest, "padding -2000: 4 voxels take the minimum, " + std::to_string(-greatest));
    put([](DicomSet& d, int k) { d.word(0x00280120, k == 3 ? -2000 : -3000, "SS"); }); // each slice has its own
    EXPECT_EQ(read().data<std::int16_t>()[0], -2000);
    EXPECT_EQ(read().data<std::int16_t>()[64], -2000); // the minimum of the others
}

TEST_F(DicomValues, PaddingAboveTheValuesOfUnsignedPixels) {
    for (auto& x : s.voxels) x = static_cast<std::int16_t>(x + 1024);
    s.voxels[20] = -1; // 65535
    const auto is_unsigned = [](DicomSet& d) { return d.word(0x00280103, 0).word(0x00280120, 65535); };
    put([&](DicomSet& d, int) { d = is_unsigned(d); });
    Voxels v = read();
    const auto least = static_cast<std::uint16_t>(*std::min_element(s.voxels.begin() + 21, s.voxels.end()));
    EXPECT_EQ(v.data<std::uint16_t>()[20],
              std::min(least, static_cast<std::uint16_t>(*std::min_element(s.voxels.begin(), s.voxels.begin() + 20))));
    EXPECT_THAT(v.decisions, Contains(HasSubstr("padding 65535: 1 voxel takes the minimum")));
    // A padding value beyond the 12 stored bits is one of all 16.
    put([&](DicomSet& d, int) { d = is_unsigned(d).word(0x00280101, 12).word(0x00280102, 11); });
    v = read();
    EXPECT_NE(v.data<std::uint16_t>()[20], 4095);
    EXPECT_THAT(v.decisions, Contains(HasSubstr("padding 65535: 1 voxel")));
}

TEST_F(DicomValues, PaddingAmongTheMeasuredValuesWarns) {
    for (std::size_t i = 0; i < 10; ++i) s.voxels[i] = 0;
    put([](DicomSet& d, int) { d.word(0x00280120, 0); });
    const Voxels v = read();
    EXPECT_EQ(v.data<std::int16_t>()[5], *std::min_element(s.voxels.begin(), s.voxels.end()));
    EXPECT_THAT(v.notes, Contains(HasSubstr("padding 0: 10 voxels take the minimum")));
    std::fill(s.voxels.begin(), s.voxels.end(), std::int16_t{0});
    put([](DicomSet& d, int) { d.word(0x00280120, 0); });
    EXPECT_THAT(read().notes, Contains(HasSubstr("all 120 voxels are padding")));
}

TEST_F(DicomValues, PaddingIsNotBlendedIntoInterpolatedSlices) {
    for (std::size_t i = 40; i < 60; ++i) s.voxels[i] = -2000;
    put([](DicomSet& d, int) { d.word(0x00280120, -2000, "SS"); });
    std::filesystem::remove(folder / "series/3.dcm");
    options.allow_gaps = true;
    const Voxels v = read();
    const std::int16_t fill = v.data<std::int16_t>()[40];
    EXPECT_GT(fill, -2000);
    for (std::size_t i = 60; i < 80; ++i) ASSERT_EQ(v.data<std::int16_t>()[i], fill);
}

/// A table of `entries` from stored value `first` on.
DicomSet table(int first, const std::vector<std::uint16_t>& entries, int bits = 16, bool packed = false) {
    std::string data = bytes_of(entries);
    if (packed) {
        data.clear();
        for (const auto x : entries) data += static_cast<char>(x);
        data.resize((data.size() + 1) / 2 * 2);
    }
    return DicomSet()
        .raw(0x00283002, "US",
             number(static_cast<std::uint16_t>(entries.size())) + number(static_cast<std::uint16_t>(first)) +
                 number(static_cast<std::uint16_t>(bits)))
        .raw(0x00283006, "OW", data);
}

TEST_F(DicomValues, ModalityTablesAreApplied) {
    std::vector<std::uint16_t> entries(1001);
    for (std::size_t i = 0; i < entries.size(); ++i) entries[i] = static_cast<std::uint16_t>(60000 - 7 * i);
    for (const bool big : {false, true}) {
        put([&](DicomSet& d, int) { d.sequence(0x00283000, {table(-500, entries)}); }, DicomSyntax{false, big});
        const Voxels v = read();
        ASSERT_EQ(v.type, VoxelType::u16);
        for (std::size_t i = 0; i < s.voxels.size(); ++i) // held constant outside
            ASSERT_EQ(v.data<std::uint16_t>()[i], entries[static_cast<std::size_t>(std::clamp(s.voxels[i] + 500, 0, 1000))]);
        EXPECT_THAT(v.decisions, Contains(HasSubstr("modality table of 1001 entries")));
    }
    const std::vector<std::uint16_t> few{5, 200, 77};
    for (const bool packed : {true, false}) {
        put([&](DicomSet& d, int) { d.sequence(0x00283000, {table(0, few, 8, packed)}); });
        const Voxels v = read();
        ASSERT_EQ(v.type, VoxelType::u8);
        for (std::size_t i = 0; i < s.voxels.size(); ++i)
            ASSERT_EQ(v.data<std::uint8_t>()[i], few[static_cast<std::size_t>(std::clamp<int>(s.voxels[i], 0, 2))]);
    }
    put([&](DicomSet& d, int k) { // some slices by a table, some by a slope
        k < 3 ? d.sequence(0x00283000, {table(0, few)}) : d.text(0x00281053, "DS", "2");
    });
    const Voxels v = read();
    ASSERT_EQ(v.type, VoxelType::f32);
    EXPECT_EQ(v.data<float>()[100], 2.0f * s.voxels[100]);
    EXPECT_EQ(v.data<float>()[7], few[static_cast<std::size_t>(std::clamp<int>(s.voxels[7], 0, 2))]);
}

TEST_F(DicomValues, ModalityTablesThatCannotBeAreRefused) {
    const std::vector<std::uint16_t> few{5, 200, 77};
    refused([&](DicomSet& d, int) { d.sequence(0x00283000, {table(0, few)}).text(0x00281053, "DS", "2"); }, {"both", "modality table"});
    refused([&](DicomSet& d, int) { d.sequence(0x00283000, {table(0, few, 24)}); }, {"24 bits"});
    refused([&](DicomSet& d, int) { d.sequence(0x00283000, {table(0, few).raw(0x00283006, "OW", "ab")}); }, {"2 bytes", "3 entries"});
    refused([&](DicomSet& d, int) { d.sequence(0x00283000, {DicomSet().text(0x00283004, "LO", "HU")}); }, {"LUTDescriptor"});
}

TEST_F(DicomValues, BitsAnywhereInASample) {
    put([](DicomSet& d, int) { d.word(0x00280101, 12).word(0x00280102, 15).word(0x00280103, 0); }); // in the high bits
    Voxels v = read();
    for (std::size_t i = 0; i < s.voxels.size(); ++i) ASSERT_EQ(v.data<std::uint16_t>()[i], static_cast<std::uint16_t>(s.voxels[i]) >> 4);
    put([](DicomSet& d, int) { d.word(0x00280101, 10).word(0x00280102, 11); });
    v = read();
    for (std::size_t i = 0; i < s.voxels.size(); ++i)
        ASSERT_EQ(v.data<std::int16_t>()[i], static_cast<std::int16_t>(s.voxels[i] << 4) >> 6);
    refused([](DicomSet& d, int) { d.word(0x00280102, 16); }, {"high bit 16"});
    refused([](DicomSet& d, int) { d.word(0x00280101, 12).word(0x00280102, 10); }, {"high bit 10"});
    refused([](DicomSet& d, int) { d.word(0x00280100, 1).word(0x00280101, 1).word(0x00280102, 0); }, {"1 bit each"});
}

TEST_F(DicomValues, FloatPixelsAreRead) {
    const auto halves = [&](int k) {
        std::vector<double> all;
        for (std::size_t i = 0; i < 20; ++i) all.push_back(0.5 * s.voxels[static_cast<std::size_t>(k) * 20 + i]);
        return all;
    };
    put([&](DicomSet& d, int k) {
        const auto all = halves(k);
        d.erase(0x7fe00010).raw(0x7fe00008, "OF", bytes_of(std::vector<float>(all.begin(), all.end())));
    });
    EXPECT_EQ(read().data<float>()[33], 0.5f * s.voxels[33]);
    put([&](DicomSet& d, int k) { d.erase(0x7fe00010).raw(0x7fe00009, "OD", bytes_of(halves(k))); });
    EXPECT_EQ(read().data<float>()[33], 0.5f * s.voxels[33]);
    EXPECT_THAT(read().notes, Contains(HasSubstr("f64")));
}

TEST_F(DicomValues, CodecsThatAreNotThereAreNamed) {
    const auto coded = [&](const std::string& uid) {
        DicomSet d = dicom_slice_set(s, 0);
        d.raw(0x7fe00010, DicomSet::compressed, dicom_items({"", "abcd"}));
        return write(folder / "x.dcm", dicom_file(d, {}, false, uid));
    };
    expect_error([&] { read_volume(coded("1.2.840.10008.1.2.4.201")); },
                 {"high-throughput JPEG 2000", "1.2.840.10008.1.2.4.201", "not supported"});
    expect_error([&] { read_volume(coded("1.2.840.10008.1.2.4.110")); }, {"JPEG XL", "not supported"});
    expect_error([&] { read_volume(coded("1.2.840.10008.1.2.4.100")); }, {"MPEG-2", "not supported"});
    expect_error([&] { read_volume(coded("1.2.3.4.5")); }, {"1.2.3.4.5", "not supported"});
    expect_error([&] { read_volume(coded("1.2.840.10008.1.2.4.90")); }, {"JPEG 2000 lossless", "cannot be decoded"});
}

} // namespace
} // namespace clvr::test

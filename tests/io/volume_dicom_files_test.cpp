// DICOM files as users have them: without preamble or ending, under other names, in folders inside folders, by a DICOMDIR.
#include "host/io/volume/volume_file.hpp"
#include "tests/io/dicom_writers.hpp"

#include <gmock/gmock.h>

namespace clvr::test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class DicomFiles : public ::testing::Test {
protected:
    Folder folder;
    Sample s{Int3{5, 4, 6}};
    VolumeReadOptions options;

    void put_all(const std::string& pattern, const DicomSyntax& syntax = {}) {
        for (int k = 0; k < s.dims[2]; ++k)
            write(folder / fmt::format(fmt::runtime(pattern), k), dicom_file(dicom_slice_set(s, k), syntax));
    }
    Voxels read(const std::string& path) { return read_volume(folder / path, options); }
    void expect_sample(const Voxels& v) {
        ASSERT_EQ(v.dims, s.dims);
        EXPECT_TRUE(std::equal(s.voxels.begin(), s.voxels.end(), v.data<std::int16_t>()));
        EXPECT_EQ(v.format, "DICOM series");
    }
    /// A DICOMDIR of files, each by the names of its path.
    static std::string directory(const std::vector<std::string>& files) {
        std::vector<DicomSet> records;
        for (const auto& f : files) records.push_back(DicomSet().text(0x00041430, "CS", "IMAGE").text(0x00041500, "CS", f));
        records.push_back(DicomSet().text(0x00041430, "CS", "PATIENT"));
        return dicom_file(DicomSet().sequence(0x00041220, records));
    }
};

TEST_F(DicomFiles, BytesTellWhateverSyntaxPreambleOrName) {
    for (const DicomSyntax base : {DicomSyntax{}, DicomSyntax{true}, DicomSyntax{false, true}, DicomSyntax{false, false, true}})
        for (const bool preamble : {true, false})
            for (const bool meta : {true, false}) {
                if (base.deflated && !meta) continue; // only group 2 says so
                DicomSyntax syntax = base;
                syntax.preamble = preamble, syntax.meta = meta;
                SCOPED_TRACE(fmt::format("{} preamble {} meta {}", syntax.uid(), preamble, meta));
                for (const char* name : {"IM{}", "IM{}.dcm", "IM{}.img", "IM{}.bin", "IM{}.tif"}) {
                    std::filesystem::remove_all(folder / "series");
                    put_all(std::string("series/") + name, syntax);
                    expect_sample(read("series"));
                    expect_sample(read("series/" + fmt::format(fmt::runtime(name), 2)));
                }
            }
}

TEST_F(DicomFiles, OtherBytesAreNotTakenForDicom) {
    const auto refused = [&](const std::string& bytes) {
        expect_error([&] { read_volume(write(folder / "x.bin", bytes)); }, {"not a volume"});
    };
    std::string noise;
    for (int i = 0; i < 2000; ++i) noise += static_cast<char>(i * 2654435761u >> 13);
    refused(noise);
    refused(std::string("\x08\0", 2) + noise);
    refused(std::string("\x02\0\0\0UL\4\0\0\0\0\0", 12) + noise);
    refused(bytes_of(std::vector<std::uint16_t>(1000, 8)));
    refused(bytes_of(std::vector<std::uint16_t>(1000, 2)));
    refused(std::string(1000, '\0'));
}

TEST_F(DicomFiles, SystemFilesAreLeftOutAndSaidOnce) {
    put_all("series/{}.dcm");
    for (int k = 0; k < 3; ++k) write(folder / fmt::format("series/._{}.dcm", k), std::string("\0\5\x16\7", 4) + std::string(200, 'x'));
    for (const char* path : {"series", "series/1.dcm"}) {
        const Voxels v = read(path);
        expect_sample(v);
        EXPECT_THAT(v.notes, ::testing::ElementsAre(::testing::AllOf(HasSubstr("3 files"), HasSubstr("left out (._0.dcm)"))));
    }
}

TEST_F(DicomFiles, FoldersInsideAreSearchedWhereNoSliceLiesOnTop) {
    put_all("top/a/b/{}");
    expect_sample(read("top"));
    // A report on top is no slice.
    DicomSet report;
    report.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.88.11").text(0x00080060, "CS", "SR").text(0x0020000e, "UI", "1.2.3");
    write(folder / "top/report.dcm", dicom_file(report));
    expect_sample(read("top"));
    // One slice on top is the volume, unless asked for more.
    Sample one({5, 4, 1});
    write(folder / "top/one.dcm", dicom_file(dicom_slice_set(one, 0).text(0x0020000e, "UI", "9.9")));
    EXPECT_EQ(read("top").dims[2], 1);
    options.recursive = true;
    expect_sample(read("top"));
}

TEST_F(DicomFiles, ObjectsWithoutPixelsArePassedOver) {
    put_all("series/{}.dcm");
    DicomSet report;
    report.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.88.11").text(0x00080060, "CS", "SR").text(0x0020000e, "UI", "1.2.3");
    write(folder / "series/report.dcm", dicom_file(report));
    const Voxels v = read("series");
    expect_sample(v);
    EXPECT_THAT(v.notes, IsEmpty());
    expect_error([&] { read("series/report.dcm"); }, {"holds no image"});
}

TEST_F(DicomFiles, ADirectoryFileNamesTheSlices) {
    for (const char* pattern : {"cd/IMAGES/IM{}", "cd/images/im{}", "cd/Images/Im{}.;1", "cd/IMAGES/IM{};1"}) {
        std::filesystem::remove_all(folder / "cd");
        put_all(pattern);
        std::vector<std::string> names;
        for (int k = 0; k < s.dims[2]; ++k) names.push_back(fmt::format("IMAGES\\IM{}", k));
        write(folder / "cd/DICOMDIR", directory(names));
        for (const char* path : {"cd", "cd/DICOMDIR"}) {
            const Voxels v = read(path);
            expect_sample(v);
            EXPECT_THAT(v.notes, IsEmpty());
            EXPECT_THAT(v.decisions, Contains(HasSubstr("6 files that the DICOMDIR names")));
        }
    }
}

TEST_F(DicomFiles, ADirectoryFileOfAnotherPlaceDoesNoHarm) {
    put_all("cd/{}");
    write(folder / "cd/DICOMDIR", directory({"IMAGES\\IM0", "IMAGES\\IM1"}));
    const Voxels v = read("cd");
    expect_sample(v);
    EXPECT_THAT(v.notes, ::testing::ElementsAre(HasSubstr("none of the 2 files that the DICOMDIR names is there")));
    expect_error([&] { read("cd/DICOMDIR"); }, {"none of the 2 files"});
    // Nothing above the folder is reached.
    put_all("secret/{}");
    std::filesystem::remove_all(folder / "cd");
    write(folder / "cd/DICOMDIR", directory({"..\\secret\\0", "..\\secret\\1", ".\\..\\secret\\2"}));
    expect_error([&] { read("cd/DICOMDIR"); }, {"none of the 3 files"});
    put_all("cd/A{}");
    write(folder / "cd/DICOMDIR", directory({"A0", "A1", "A2", "A3", "A4", "A5", "A6", "A7"}));
    EXPECT_THAT(read("cd/DICOMDIR").notes, Contains(HasSubstr("2 of 8 files that the DICOMDIR names are not there")));
}

TEST_F(DicomFiles, DeflatedDataThatEndsIsAnError) {
    const std::string whole = dicom_file(dicom_slice_set(s, 0), DicomSyntax{false, false, true});
    for (std::size_t n = 0; n < whole.size(); n += 3)
        expect_error([&] { read_volume(write(folder / "x.dcm", whole.substr(0, n))); }, {"x.dcm"});
}

} // namespace
} // namespace clvr::test

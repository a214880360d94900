#include "tests/fuzz/volume_samples.hpp"

#include "host/io/picture/frame_file.hpp"
#include "tests/io/tiff_writers.hpp"
#include "tests/io/volume_formats.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

namespace clvr::test {

namespace {

namespace fs = std::filesystem;
using Samples = std::vector<FuzzSample>;

bool starts(const std::string& s, const std::string& start) { return s.compare(0, start.size(), start) == 0; }
bool ends(const std::string& s, const std::string& end) {
    return s.size() >= end.size() && s.compare(s.size() - end.size(), end.size(), end) == 0;
}

bool is_sample(const FuzzTarget& target, const std::string& format) {
    const std::string& wanted = target.format.empty() ? target.name : target.format;
    return wanted.front() == '*' ? ends(format, wanted.substr(1)) : starts(format, wanted);
}

/// What the writer of a format leaves in a folder, what is read first.
std::vector<std::string> files_of(const VolumeFormat& format, const Sample& sample) {
    const Folder folder;
    const Written written = format.write(folder, sample);
    std::vector<std::string> paths;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path()))
        if (entry.is_regular_file()) paths.push_back(entry.path().string());
    std::sort(paths.begin(), paths.end());
    std::stable_partition(paths.begin(), paths.end(), [&](const std::string& path) { return path == written.path; });
    std::vector<std::string> files;
    for (const std::string& path : paths) files.push_back(read(path));
    return files;
}

std::string joined(const std::vector<std::string>& files) {
    std::string bytes;
    for (std::size_t i = 0; i < files.size(); ++i) bytes += (i ? std::string(file_mark) : "") + files[i];
    return bytes;
}

Samples raw_samples() {
    const Sample s;
    const std::string voxels = bytes_of(s.voxels), mark(file_mark);
    const std::string dims = R"({"dims": [5, 4, 3], "type": "int16")";
    return {{"sidecar", voxels + mark + dims + "}"},
            {"geometry",
             deflated(voxels) + mark + dims +
                 R"(, "endian": "big", "spacing": [0.5, 0.75, 2], "origin": [-10.5, 20, 31], "direction": [0, 1, 0, 1, 0, 0, 0, 0, 1],
                                 "slope": 2, "intercept": -1, "modality": "CT"})"}};
}

std::string with_writer(void (*write)(const std::string& path, const Sample& s)) {
    const Folder folder;
    write(folder / "a", Sample());
    return read(folder / "a");
}

/// What a target's formats may hold beside one plain volume.
const std::map<std::string, Samples (*)()>& further_samples() {
    static const std::map<std::string, Samples (*)()> samples{
        {"raw", raw_samples},
        {"tiff",
         [] {
             const std::string sizes = R"(SizeX="6" SizeY="7" SizeZ="2" SizeC="2" SizeT="1" DimensionOrder="XYZCT" PhysicalSizeX="0.2")";
             return Samples{
                 {"ome", described_tiff(4, ome_xml(sizes))},
                 {"imagej", described_tiff(4, "ImageJ=1.53t\nimages=4\nslices=2\nframes=2\nspacing=0.5\nunit=um\nzunit=mm\n", {5, 1})},
                 {"shaped", described_tiff(3, R"({"shape": [3, 7, 6], "axes": "ZYX"})")},
                 {"scanimage", described_tiff(2, "SI.hStackManager.numSlices = 2\nSI.hChannels.channelSave = 1\n")},
                 {"big_endian", described_tiff(2, "", {1, 1}, true)}};
         }},
        {"png_slice",
         [] {
             return Samples{
                 {"eight", png_file(3, 2, 8, PNG_COLOR_TYPE_GRAY, "abcdef")},
                 {"sixteen", png_file(3, 2, 16, PNG_COLOR_TYPE_GRAY, "abcdefghijkl", {}, true)},
                 {"palette", png_file(3, 2, 8, PNG_COLOR_TYPE_PALETTE, std::string("\0\1\0\1\0\1", 6), std::string("\0\0\0\7\7\7", 6))}};
         }},
        {"jpeg_slice",
         [] {
             Frame grey;
             grey.width = 9, grey.height = 8;
             for (const char* name : {"R", "G", "B"}) grey.channel(name).assign(grey.pixels(), 0.5f);
             const Folder folder;
             write_jpeg(grey, {}, folder / "a.jpg");
             return Samples{{"grey", read(folder / "a.jpg")}};
         }},
        {"hdf5",
         [] {
             return Samples{{"minc", with_writer([](const std::string& path, const Sample& s) { write_minc(path, s); })}};
         }},
    };
    return samples;
}

} // namespace

std::vector<FuzzSample> volume_samples(const FuzzTarget& target) {
    Samples samples;
    if (const auto further = further_samples().find(target.name); further != further_samples().end()) samples = further->second();
    for (const VolumeFormat& format : volume_formats()) {
        if (!is_sample(target, format.name)) continue;
        const std::vector<std::string> files = files_of(format, Sample());
        if (files.size() <= target.files.size()) samples.push_back({format.name, joined(files)});
    }
    return samples;
}

} // namespace clvr::test

#include "host/io/dicom/files.hpp"
#include "host/io/byte_stream.hpp"
#include "host/io/dicom/file.hpp"
#include "host/io/dicom/tags.hpp"
#include "host/io/volume/format.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/samples.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

namespace clvr {

namespace fs = std::filesystem;

namespace {

/// Names in folders without regard to case, to a version (";1") and to a dot at the end, as CDs have them.
class DiscNames {
public:
    /// The path of the entry in `folder` that `name` means; empty where there is none.
    std::string find(const std::string& folder, const std::string& name) {
        auto& names = folders_[folder];
        if (names.empty()) {
            std::error_code error;
            for (const auto& entry : fs::directory_iterator(folder, error))
                names.emplace(plain(entry.path().filename().string()), entry.path().string());
            names.emplace("", ""); // read, if empty
        }
        const auto found = names.find(plain(name));
        return found == names.end() ? "" : found->second;
    }

private:
    static std::string plain(const std::string& name) {
        std::string s = lower_case(name.substr(0, name.find(';')));
        while (!s.empty() && s.back() == '.') s.pop_back();
        return s;
    }
    std::map<std::string, std::map<std::string, std::string>> folders_;
};

/// Whether the file is DICOM by its bytes; by its name only where they are silent.
bool may_be_dicom(const std::string& path) {
    const VolumeFormat by_head = format_of_head(read_head(path, 1024));
    return by_head == VolumeFormat::dicom || (by_head == VolumeFormat::unknown && format_of_name(path) == VolumeFormat::dicom);
}

bool is_directory_name(const std::string& path) {
    const std::string name = lower_case(fs::path(path).filename().string());
    return name.substr(0, name.find(';')) == "dicomdir";
}

} // namespace

DicomFiles dicom_directory_files(const std::string& path) {
    DicomFiles files;
    const DicomFile directory = scan_dicom(path);
    const auto records = directory.data.sequences.find(dicom_tag::directory_records);
    if (records == directory.data.sequences.end()) return files;
    const fs::path parent = fs::path(path).parent_path();
    const std::string root = parent.empty() ? "." : parent.string();
    DiscNames names;
    std::size_t missing = 0, named = 0;
    for (const DicomElements& record : records->second) {
        const auto parts = record.texts(dicom_tag::referenced_file);
        if (parts.empty()) continue;
        ++named;
        std::string at = root;
        for (const std::string& part : parts) at = at.empty() || part.empty() ? "" : names.find(at, part);
        if (!at.empty() && fs::is_regular_file(at))
            files.paths.push_back(at);
        else
            ++missing;
    }
    if (missing == named) {
        files.paths.clear();
        if (named > 0) files.notes.push_back(fmt::format("none of the {} files that the DICOMDIR names is there", named));
    } else if (missing > 0) {
        files.notes.push_back(fmt::format("{} of {} files that the DICOMDIR names are not there", missing, named));
    }
    if (!files.paths.empty()) files.decisions.push_back(fmt::format("{} files that the DICOMDIR names", files.paths.size()));
    std::sort(files.paths.begin(), files.paths.end());
    files.paths.erase(std::unique(files.paths.begin(), files.paths.end()), files.paths.end());
    return files;
}

DicomFiles dicom_files_among(const std::vector<std::string>& paths) {
    DicomFiles files;
    for (const std::string& path : paths) {
        if (!may_be_dicom(path)) continue;
        if (!is_directory_name(path)) {
            files.paths.push_back(path);
            continue;
        }
        const DicomFiles named = dicom_directory_files(path);
        files.paths.insert(files.paths.end(), named.paths.begin(), named.paths.end());
        files.notes.insert(files.notes.end(), named.notes.begin(), named.notes.end());
        files.decisions.insert(files.decisions.end(), named.decisions.begin(), named.decisions.end());
    }
    std::sort(files.paths.begin(), files.paths.end());
    files.paths.erase(std::unique(files.paths.begin(), files.paths.end()), files.paths.end());
    return files;
}

} // namespace clvr

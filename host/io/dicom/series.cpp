// DICOM series: compressed pixels by GDCM; headers, grouping and order by clvr.
#include "host/io/dicom/files.hpp"
#include "host/io/dicom/load.hpp"
#include "host/io/dicom/stacks.hpp"
#include "host/io/dicom/tags.hpp"
#include "host/io/volume/folder.hpp"
#include "host/io/volume/readers.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

namespace clvr {

namespace {

namespace fs = std::filesystem;

struct Series {
    std::vector<DicomFrame> frames;
    std::vector<Error> unreadable; ///< of files of it
};

/// What was found among some files.
struct Scan {
    std::map<std::string, Series> series;
    std::vector<std::string> left_out; ///< why, a file a line
};

/// A damaged file is refused, as it may be a slice. It is left out with `allow_gaps`; so is a sound file that is no slice of grey values.
Scan scan(const std::vector<std::string>& paths, const std::optional<std::string>& wanted, bool allow_gaps) {
    Scan found;
    for (const std::string& path : paths) {
        DicomFile file;
        try {
            file = scan_dicom(path);
        } catch (const Error& e) {
            if (!allow_gaps) throw Error(e.kind(), std::string(e.what()) + " (--allow-gaps leaves it out)", e.where());
            found.left_out.push_back(e.line());
            continue;
        }
        const std::string uid = file.data.text(dicom_tag::series_uid);
        if (wanted && uid != *wanted) continue;
        try {
            auto frames = frames_of(std::move(file), path);
            if (frames.empty()) continue;
            auto& all = found.series[uid].frames;
            std::move(frames.begin(), frames.end(), std::back_inserter(all));
        } catch (const DicomSliceError& e) {
            if (allow_gaps)
                found.left_out.push_back(e.line());
            else
                found.series[uid].unreadable.push_back(e);
        } catch (const Error& e) {
            found.left_out.push_back(e.line());
        }
    }
    return found;
}

/// The stack that would become the volume of a series, and how good that volume would be.
struct Candidate {
    std::string series;
    std::vector<std::size_t> stack;
    std::size_t stacks = 0, places = 0;
    double voxels = 0;
    std::string problem; ///< why it makes no volume; empty where it does

    /// The most slices that make a volume win, then the most voxels. Scouts have fewer than four slices of one direction.
    bool better_than(const Candidate& other) const {
        constexpr std::size_t volume = 4;
        const auto rank = [](const Candidate& c) { return std::make_tuple(c.problem.empty() && c.places >= volume, c.places, c.voxels); };
        return rank(*this) > rank(other);
    }
};

/// The number of different places; 0 where they cannot be told.
std::size_t count_places(const std::vector<DicomFrame>& frames, const std::vector<std::size_t>& stack, const std::string& path,
                         std::string& problem) {
    try {
        return arrange(frames, stack, 0, false, path).places;
    } catch (const Error& e) {
        problem = e.what();
    }
    try {
        return arrange(frames, stack, 0, true, path).places;
    } catch (const Error&) {
        return stack.size();
    }
}

Candidate best_stack(const std::string& uid, const Series& series, bool allow_gaps, const std::string& path) {
    Candidate best;
    best.series = uid;
    const auto stacks = stacks_of(series.frames);
    for (const auto& stack : stacks) {
        Candidate c;
        c.series = uid;
        c.stack = stack;
        c.places = count_places(series.frames, stack, path, c.problem);
        if (allow_gaps) c.problem.clear();
        c.voxels = static_cast<double>(c.places) * static_cast<double>(series.frames[stack.front()].count());
        if (best.stack.empty() || c.better_than(best)) best = c;
    }
    best.stacks = stacks.size();
    if (!series.unreadable.empty()) best.problem = series.unreadable.front().line();
    return best;
}

std::string describe_series(const Candidate& c, const Series& series) {
    if (c.stack.empty()) return fmt::format("{} (not readable: {})", c.series, c.problem);
    const DicomFrame& f = series.frames[c.stack.front()];
    const DicomImage& image = *f.image;
    return fmt::format("{} ({}{}{}, {} x {} x {}{})", c.series, image.modality, image.description.empty() ? "" : ", ", image.description,
                       f.columns, f.rows, c.places, c.problem.empty() ? "" : ", no volume: " + c.problem);
}

Candidate choose_series(const Scan& found, const VolumeReadOptions& options, const std::string& path, std::vector<std::string>& notes) {
    std::string list;
    Candidate best;
    bool any = false;
    for (const auto& [uid, series] : found.series) {
        const Candidate c = best_stack(uid, series, options.allow_gaps, path);
        list += (list.empty() ? "" : "; ") + describe_series(c, series);
        const bool wanted = options.series.empty() || options.series == uid;
        if (wanted && (!any || c.better_than(best))) best = c;
        any = any || wanted;
    }
    if (!any) bad_file(path, "no series {}: there {} {}", options.series, found.series.size() == 1 ? "is" : "are", list);
    if (found.series.size() > 1 && options.series.empty())
        notes.push_back(fmt::format("{} series, the one with the most slices that make a volume is taken ({}; --series chooses): {}",
                                    found.series.size(), best.series, list));
    return best;
}

/// Where the files of a volume are: named by a folder, by a DICOMDIR, or beside a file of the series.
struct Source {
    DicomFiles files;
    std::optional<std::string> wanted; ///< the series of the file that the user named
};

Source files_of(const std::string& path, const VolumeReadOptions& options) {
    Source source;
    if (fs::is_directory(path)) {
        source.files = dicom_files_among(files_in(path, options.recursive).paths); // its notes are read_volume's
        return source;
    }
    source.files = dicom_directory_files(path);
    if (!source.files.paths.empty()) return source;
    if (!source.files.notes.empty()) bad_file(path, "{}", source.files.notes.front());
    DicomFile file = scan_dicom(path);
    source.wanted = file.data.text(dicom_tag::series_uid);
    if (frames_of(std::move(file), path).empty()) bad_file(path, "the DICOM file holds no image");
    const fs::path parent = fs::path(path).parent_path();
    const FolderFiles beside = files_in(parent.empty() ? "." : parent.string(), options.recursive);
    source.files = dicom_files_among(beside.paths);
    source.files.notes.insert(source.files.notes.end(), beside.notes.begin(), beside.notes.end());
    auto& paths = source.files.paths;
    if (std::none_of(paths.begin(), paths.end(), [&](const std::string& f) { return fs::equivalent(f, path); })) paths.push_back(path);
    return source;
}

void add(std::vector<std::string>& to, const std::vector<std::string>& more) {
    for (const std::string& line : more)
        if (std::find(to.begin(), to.end(), line) == to.end()) to.push_back(line);
}

Voxels volume_of(const Scan& found, const std::string& path, const VolumeReadOptions& options) {
    Voxels v;
    v.source = path;
    v.format = "DICOM series";
    const Candidate chosen = choose_series(found, options, path, v.notes);
    const Series& series = found.series.at(chosen.series);
    if (!series.unreadable.empty()) {
        const Error& e = series.unreadable.front();
        throw Error(e.kind(), std::string(e.what()) + (series.frames.empty() ? "" : " (--allow-gaps leaves the file out)"), e.where());
    }
    if (chosen.stacks > 1)
        v.notes.push_back(fmt::format("{} of {} slices have another size or orientation, pixel spacing, type or stack, and were left out",
                                      series.frames.size() - chosen.stack.size(), series.frames.size()));
    const Arrangement a = arrange(series.frames, chosen.stack, options.frame, options.allow_gaps, path);
    add(v.notes, a.notes);
    std::set<const DicomImage*> images;
    for (const SlicePlace& p : a.slices)
        if (const DicomImage* image = series.frames[p.low].image.get(); images.insert(image).second) {
            add(v.notes, image->notes);
            add(v.decisions, image->decisions);
        }
    add(v.decisions, a.decisions);
    v.modality = series.frames[a.slices.front().low].image->modality;
    load_slices(series.frames, a, v, path);
    return v;
}

} // namespace

Voxels read_dicom(const std::string& path, const VolumeReadOptions& options) {
    const Source source = files_of(path, options);
    const Scan found = scan(source.files.paths, source.wanted, options.allow_gaps);
    if (found.series.empty()) {
        if (fs::is_directory(path) && !options.recursive && files_in(path, true).paths.size() > files_in(path, false).paths.size()) {
            VolumeReadOptions deep = options;
            deep.recursive = true;
            return read_dicom(path, deep);
        }
        bad_file(path, "no DICOM slice in it can be used{}", found.left_out.empty() ? "" : ": " + found.left_out.front());
    }
    Voxels v = volume_of(found, path, options);
    add(v.notes, source.files.notes);
    add(v.decisions, source.files.decisions);
    if (const std::size_t n = found.left_out.size(); n > 0)
        v.notes.push_back(fmt::format("{} DICOM file{} left out: {}", n, n == 1 ? " was" : "s were", found.left_out.front()));
    return v;
}

} // namespace clvr

// TIFF files of pages, and folders of TIFF slices, into Voxels.
#include "host/io/volume/readers.hpp"
#include "host/io/volume/reading_options.hpp"
#include "host/io/volume/slice_stack.hpp"
#include "host/io/volume/tiff_layout.hpp"

#include <algorithm>
#include <filesystem>
#include <tiffio.h>

namespace clvr {

namespace {

TiffSource source_of(const TiffFile& file, const std::string& path, const VolumeReadOptions& options) {
    TiffSource source{file, path, file.pages(), "", options};
    file.select(source.pages.front());
    source.description = file.text(TIFFTAG_IMAGEDESCRIPTION);
    return source;
}

void append(std::vector<std::string>& to, const std::vector<std::string>& more) { to.insert(to.end(), more.begin(), more.end()); }

/// Spacing, origin and scale of values.
void set_geometry(Voxels& v, const TiffLayout& layout, const VolumeReadOptions& options) {
    if (options.spacing) {
        v.geometry.spacing = *options.spacing;
        v.decisions.push_back("spacing from --spacing");
    } else {
        const ResolvedSpacing resolved = resolve_spacing(layout.scales, static_cast<std::size_t>(v.dims[2]));
        v.geometry.spacing = resolved.spacing;
        append(v.notes, resolved.notes);
        append(v.decisions, resolved.decisions);
    }
    for (std::size_t i = 0; i < 3; ++i)
        if (layout.origin_pixels[i] != 0) {
            v.geometry.origin[i] = -layout.origin_pixels[i] * v.geometry.spacing[i];
            v.decisions.push_back(fmt::format("origin {} from ImageJ: pixel {:g}", "xyz"[i], layout.origin_pixels[i]));
        }
    v.slope = layout.slope, v.intercept = layout.intercept;
    check_geometry(v.geometry, v.source);
}

/// Which channel is read: a page of its own, or a sample of each pixel.
struct ChosenChannel {
    int plane = 0;
    std::uint16_t sample = 0;
};
ChosenChannel choose_channel(const TiffLayout& layout, const TiffFile& file, const TiffForm& form, const VolumeReadOptions& options,
                             const std::string& path, Voxels& v) {
    std::vector<std::string> names = layout.channel_names;
    if (form.photometric == PHOTOMETRIC_RGB && layout.channels == 1) names = {"red", "green", "blue"};
    const std::int64_t channels = std::int64_t{layout.channels} * form.samples;
    const std::string all = names.empty() ? "" : fmt::format(" ({})", fmt::join(names, ", "));
    const int chosen = options.channel.value_or(0);
    if (chosen < 0 || chosen >= channels)
        bad_file(path, "channel {} is not there: the file has {} channel{}{}, counted from 0", chosen, channels, channels == 1 ? "" : "s",
                 all);
    if (channels > 1) {
        std::uint16_t extra = 0, *kinds = nullptr;
        const bool alpha = channels == 2 && form.samples == 2 && TIFFGetField(file.get(), TIFFTAG_EXTRASAMPLES, &extra, &kinds) &&
                           extra == 1 && kinds[0] != EXTRASAMPLE_UNSPECIFIED;
        if (options.channel)
            v.decisions.push_back(fmt::format("channel {} of {}{}", chosen, channels, all));
        else if (alpha)
            v.notes.push_back("the file's alpha is left out (--channel 1 reads it)");
        else
            v.notes.push_back(fmt::format("the file has {} channels{}: channel 0 is read (--channel N picks)", channels, all));
    }
    return {chosen / form.samples, static_cast<std::uint16_t>(chosen % form.samples)};
}

/// A file with more channels than microscopes have, each of one plane and without a name, is a stack of slices whose writer did not know
/// the z axis; unless the user asks for a channel.
void take_channels_as_slices(TiffLayout& layout, const TiffForm& form, const VolumeReadOptions& options, Voxels& v) {
    constexpr int usual_channels = 4;
    const bool asked = options.channel && form.samples == 1; // of pixels with several samples, --channel means one of those
    if (!layout.channels_may_be_slices || layout.channels <= usual_channels || asked || form.depth > 1 || layout.slices > 1 ||
        layout.times > 1)
        return;
    v.notes.push_back(fmt::format("the file calls its {} pages channels: taken as slices (--channel N reads one)", layout.channels));
    std::swap(layout.slices, layout.channels);
    for (TiffPlane& p : layout.planes) std::swap(p.slice, p.channel);
}

/// Without a z axis, time is the third axis, whether or not --frame is given.
void take_times_as_slices(TiffLayout& layout, const TiffForm& form, Voxels& v) {
    if (layout.slices > 1 || form.depth > 1 || layout.times == 1) return;
    v.notes.push_back(fmt::format("the file has no z axis: its {} times (frames) are taken as slices", layout.times));
    std::swap(layout.slices, layout.times);
    for (TiffPlane& p : layout.planes) std::swap(p.slice, p.time);
}

/// The planes of one channel and time, a slice each.
std::vector<TiffPlane> chosen_planes(const TiffLayout& layout, int channel, int time, const std::string& path) {
    std::vector<TiffPlane> planes(static_cast<std::size_t>(layout.slices));
    std::vector<bool> found(planes.size());
    for (const TiffPlane& p : layout.planes) {
        if (p.channel != channel || p.time != time) continue;
        const auto slice = static_cast<std::size_t>(p.slice);
        if (found[slice]) bad_file(path, "slice {} of channel {} at time {} is there twice", slice, channel, time);
        planes[slice] = p;
        found[slice] = true;
    }
    const auto missing = std::find(found.begin(), found.end(), false);
    if (missing != found.end())
        bad_file(path, "slice {} of {} (channel {}, time {}) is in no page: {} slices are there", missing - found.begin(), found.size(),
                 channel, time, std::count(found.begin(), found.end(), true));
    return planes;
}

/// The files that planes are in, opened one after another.
class OpenFiles {
public:
    explicit OpenFiles(const TiffSource& source) : source_(source) {}
    /// Makes the plane's page the current one and returns its file. Throws Error{input} where it is missing.
    const TiffFile& select(const TiffPlane& plane) {
        if (plane.file.empty()) return select(source_.file, source_.pages, plane);
        if (plane.file != name_) {
            if (!std::filesystem::is_regular_file(plane.file))
                bad_file(source_.path, "its slices are in several files: {} is missing", plane.file);
            other_ = std::make_unique<TiffFile>(plane.file);
            pages_ = other_->pages();
            name_ = plane.file;
        }
        return select(*other_, pages_, plane);
    }

private:
    static const TiffFile& select(const TiffFile& file, const std::vector<TiffPage>& pages, const TiffPlane& plane) {
        if (plane.page >= pages.size())
            bad_file(file.path(), "page {} is expected by its metadata, the file has {}: it is truncated", plane.page, pages.size());
        file.select(pages[plane.page]);
        return file;
    }

    const TiffSource& source_;
    std::string name_;
    std::unique_ptr<TiffFile> other_;
    std::vector<TiffPage> pages_;
};

Voxels read_pages(const std::string& path, const std::string& name, const VolumeReadOptions& options) {
    const TiffFile head(name);
    const TiffSource source = source_of(head, path, options);
    TiffLayout layout = layout_of(source);
    if (layout.planes.empty()) bad_file(path, "the file has no page that is a slice");
    OpenFiles files(source);
    const TiffFile& first = files.select(layout.planes.front());
    const TiffForm form = form_of(first, options.channel.has_value(), layout.indexed);

    Voxels v;
    describe(v, path, "TIFF", form.type);
    append(v.notes, layout.notes);
    append(v.decisions, layout.decisions);
    append(v.notes, form_notes(first, form));
    take_channels_as_slices(layout, form, options, v);
    take_times_as_slices(layout, form, v);
    const ChosenChannel channel = choose_channel(layout, first, form, options, path, v);
    check_frame(options.frame, layout.times, path);
    if (layout.times > 1 && options.frame == 0)
        v.notes.push_back(fmt::format("the file has {} times: the first is read (--frame N picks)", layout.times));
    v.frames = say_frame(options.frame, layout.times, "time", v.decisions);
    const std::vector<TiffPlane> planes = chosen_planes(layout, channel.plane, options.frame, path);
    for (const TiffPlane& p : planes) { // every page is checked before the first is decoded
        const TiffFile& file = files.select(p);
        if (p.plain_at) continue;
        if (const TiffForm own = form_of(file, options.channel.has_value(), layout.indexed); !own.is_alike(form))
            bad_file(file.path(), "page {} is {}, the first is {}: all slices must be alike", p.page, form_text(own), form_text(form));
        check_extents(file, form);
    }
    const std::int64_t slices = static_cast<std::int64_t>(planes.size()) * form.depth;
    v.dims = check_dims({form.width, form.height, slices}, 1, form.type, path).dims;
    set_geometry(v, layout, options);
    allocate(v);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const TiffFile& file = files.select(planes[i]);
        const TiffForm own = planes[i].plain_at ? form : form_of(file, options.channel.has_value(), layout.indexed);
        if (form.depth == 1) {
            store_slice(v, i, form.type, [&](unsigned char* to) {
                planes[i].plain_at ? decode_plain(file, own, *planes[i].plain_at, to) : decode_page(file, own, channel.sample, to);
            });
            continue;
        }
        std::vector<unsigned char> block(form.pixels() * sample_bytes(form.type));
        decode_page(file, own, channel.sample, block.data());
        store_samples(block.data(), form.type, form.pixels(), v, i * form.pixels());
    }
    return v;
}

/// A file that is one slice of a folder.
class TiffSlice : public SliceImage {
public:
    TiffSlice(const std::string& name, const VolumeReadOptions& options) : file(name) {
        const auto pages = file.pages();
        const auto is_main = [](const TiffPage& p) { return !p.is_extra; };
        if (const auto main = std::count_if(pages.begin(), pages.end(), is_main); main != 1)
            bad_file(name, "it has {} pages although it stands in a folder of slices: name this file alone", main);
        file.select(*std::find_if(pages.begin(), pages.end(), is_main));
        description = file.text(TIFFTAG_IMAGEDESCRIPTION);
        tiff_form = form_of(file, options.channel.has_value(), description.compare(0, 7, "ImageJ=") == 0);
        check_extents(file, tiff_form);
        if (tiff_form.depth > 1)
            bad_file(name, "it has {} slices although it stands in a folder of slices: name it alone", tiff_form.depth);
        width = tiff_form.width, height = tiff_form.height, type = tiff_form.type;
        form = form_text(tiff_form);
    }
    void decode(unsigned char* to) override { decode_page(file, tiff_form, sample, to); }

    TiffFile file;
    TiffForm tiff_form;
    std::string description;
    std::uint16_t sample = 0;
};

/// What the metadata of one slice say of spacing and values; its axes are those of the folder.
TiffLayout slice_layout(const TiffSlice& slice, const std::string& path, const VolumeReadOptions& options) {
    const TiffSource source{slice.file, path, {}, slice.description, options};
    TiffLayout layout;
    if (!set_ome_scales(source, layout)) set_imagej_scales(source, layout, false);
    return layout;
}

Voxels read_slices(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options) {
    check_frame(options.frame, 1, path);
    TiffSlice head(files.front(), options);
    TiffLayout layout = slice_layout(head, path, options);
    Voxels v;
    append(v.notes, layout.notes);
    append(v.notes, form_notes(head.file, head.tiff_form));
    head.sample = choose_channel(layout, head.file, head.tiff_form, options, path, v).sample;
    stack_slices(v, path, "TIFF slices", files, [&](const std::string& name) {
        auto slice = std::make_unique<TiffSlice>(name, options);
        slice->sample = head.sample;
        const TiffLayout own = slice_layout(*slice, path, options);
        if (own.slope != layout.slope || own.intercept != layout.intercept)
            bad_file(name, "its calibration is {:g} + {:g} x stored, that of {} is {:g} + {:g} x stored: all slices must be alike",
                     own.intercept, own.slope, std::filesystem::path(files.front()).filename().string(), layout.intercept, layout.slope);
        return slice;
    });
    append(v.decisions, layout.decisions);
    set_geometry(v, layout, options);
    return v;
}

} // namespace

Voxels read_tiff(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options) {
    return files.size() == 1 ? read_pages(path, files.front(), options) : read_slices(path, files, options);
}

} // namespace clvr

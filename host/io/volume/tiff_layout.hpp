// What the pages of a TIFF file mean: which are slices, which are channels and times, and how far apart they are.
#pragma once
#include "host/io/volume/axis_scales.hpp"
#include "host/io/volume/tiff_page.hpp"
#include "host/io/volume/volume_file.hpp"

namespace clvr {

/// Where a plane of pixels is.
struct TiffPlane {
    int channel = 0, slice = 0, time = 0;
    std::string file;                      ///< a file beside; empty: this one
    std::uint64_t page = 0;                ///< index among its pages
    std::optional<std::uint64_t> plain_at; ///< no page, but pixels as they are from this byte on

    /// Of axis C, Z or T.
    int& index_of(char axis) { return axis == 'C' ? channel : axis == 'Z' ? slice : time; }
};

/// The channels of a page's pixels (samples) and its slices (ImageDepth) are not counted here: they stand within each plane.
struct TiffLayout {
    int channels = 1, slices = 1, times = 1;
    std::vector<TiffPlane> planes;
    AxisScales scales;
    double slope = 1, intercept = 0;
    Double3 origin_pixels{0, 0, 0}; ///< the index at which the world's origin lies
    std::vector<std::string> channel_names;
    bool channels_may_be_slices = false; ///< some programs call the pages of any stack channels
    bool indexed = false;                ///< a colour table is for show, the values are data
    std::vector<std::string> notes, decisions;

    /// Of axis C, Z or T.
    int& size_of(char axis) { return axis == 'C' ? channels : axis == 'Z' ? slices : times; }
    /// Pages 0, 1, ... along the axes in `order` ("CZT": channels fastest).
    void add_planes(const std::string& order);
};

/// A TIFF file as layouts see it: its first page is current.
struct TiffSource {
    const TiffFile& file;
    std::string path; ///< what the user named
    std::vector<TiffPage> pages;
    std::string description; ///< of the first page
    const VolumeReadOptions& options;

    /// Indices of pages that are no thumbnails, pyramid levels or masks. Throws Error{input} where none is left.
    std::vector<std::uint64_t> main_pages() const;
};

/// Each gives nothing where the file is not of its kind, and throws Error{input} where it is but contradicts itself.
std::optional<TiffLayout> ome_layout(const TiffSource& source);
std::optional<TiffLayout> imagej_layout(const TiffSource& source);
/// tifffile's {"shape": ...}.
std::optional<TiffLayout> shaped_layout(const TiffSource& source);
/// Zeiss LSM, MetaMorph STK, ScanImage, Olympus FluoView.
std::optional<TiffLayout> microscope_layout(const TiffSource& source);
/// Each page a slice.
TiffLayout plain_layout(const TiffSource& source);

/// What the description alone says of spacing (and, ImageJ, of values and origin). False where it is not of the kind. `is_stack`: ImageJ
/// leaves out a distance of 1 unit between the slices of a stack; of single slices it never writes one.
bool set_ome_scales(const TiffSource& source, TiffLayout& layout);
bool set_imagej_scales(const TiffSource& source, TiffLayout& layout, bool is_stack);

/// The first that knows the file.
TiffLayout layout_of(const TiffSource& source);

/// `count` planes of pixels behind each other from the first page's first byte on, where only that page has a directory. `who` says that
/// there are so many. Throws Error{input} where pages are packed or the file ends before.
std::vector<std::uint64_t> plain_planes(const TiffSource& source, const TiffForm& form, std::uint64_t count, const std::string& who);

} // namespace clvr

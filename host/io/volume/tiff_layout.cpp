#include "host/io/volume/tiff_layout.hpp"

#include <algorithm>
#include <cmath>
#include <tiffio.h>

namespace clvr {

namespace {

/// Whether the pages behind the largest one are smaller copies of it: sizes divided by about a power of two.
bool is_pyramid_level(const TiffPage& page, const TiffPage& whole) {
    for (unsigned shift = 1; shift < 20; ++shift) {
        const double factor = std::ldexp(1, static_cast<int>(shift));
        if (std::abs(whole.width / factor - page.width) <= 1 && std::abs(whole.height / factor - page.height) <= 1)
            return whole.width / factor >= 1 && whole.height / factor >= 1;
    }
    return false;
}

} // namespace

void TiffLayout::add_planes(const std::string& order) {
    for (int k = 0; k < size_of(order[2]); ++k)
        for (int j = 0; j < size_of(order[1]); ++j)
            for (int i = 0; i < size_of(order[0]); ++i) {
                TiffPlane p;
                p.page = planes.size();
                p.index_of(order[0]) = i, p.index_of(order[1]) = j, p.index_of(order[2]) = k;
                planes.push_back(std::move(p));
            }
}

std::vector<std::uint64_t> TiffSource::main_pages() const {
    std::vector<std::uint64_t> main;
    for (std::size_t i = 0; i < pages.size(); ++i)
        if (!pages[i].is_extra) main.push_back(i);
    if (main.empty()) bad_file(path, "the file has no page that is a slice");
    return main;
}

std::vector<std::uint64_t> plain_planes(const TiffSource& source, const TiffForm& form, std::uint64_t count, const std::string& who) {
    const TiffFile& file = source.file;
    file.select(source.pages.front());
    if (!is_plain(file, form))
        bad_file(source.path,
                 "{} but the file has 1 page, and its pixels are packed: save the whole stack again, with a page for each slice", who);
    const std::uint64_t first = TIFFGetStrileOffset(file.get(), 0), plane = form.pixels() * sample_bytes(form.type);
    if (first > file.size() || count > (file.size() - first) / plane)
        bad_file(
            source.path,
            "{} but the file has 1 page and room for {}: it is truncated, or the page was cut out of a stack and keeps its description",
            who, first > file.size() ? 0 : (file.size() - first) / plane);
    std::vector<std::uint64_t> at(count);
    for (std::uint64_t i = 0; i < count; ++i) at[i] = first + i * plane;
    return at;
}

TiffLayout plain_layout(const TiffSource& source) {
    TiffLayout layout;
    std::vector<std::uint64_t> main = source.main_pages();
    const TiffPage& whole = source.pages[main.front()];
    const auto differs = [&](std::uint64_t i) { return source.pages[i].width != whole.width || source.pages[i].height != whole.height; };
    const auto levels = std::stable_partition(main.begin(), main.end(), [&](std::uint64_t i) { return !differs(i); });
    for (auto level = levels; level != main.end(); ++level)
        if (const TiffPage& page = source.pages[*level]; !is_pyramid_level(page, whole))
            bad_file(source.path, "page {} is {} x {}, the first is {} x {}: all slices must be alike", *level, page.width, page.height,
                     whole.width, whole.height);
    if (const auto n = main.end() - levels; n > 0)
        layout.notes.push_back(fmt::format("{} page{} of the first: left out", n, n == 1 ? " is a smaller copy" : "s are smaller copies"));
    main.erase(levels, main.end());
    layout.slices = static_cast<int>(main.size());
    for (std::size_t i = 0; i < main.size(); ++i) {
        TiffPlane p;
        p.slice = static_cast<int>(i), p.page = main[i];
        layout.planes.push_back(p);
    }
    if (const auto extra = source.pages.size() - source.main_pages().size(); extra > 0)
        layout.decisions.push_back(fmt::format("{} reduced page{} or mask left out", extra, extra == 1 ? "" : "s"));
    return layout;
}

TiffLayout layout_of(const TiffSource& source) {
    for (const auto kind : {ome_layout, imagej_layout, shaped_layout, microscope_layout})
        if (auto layout = kind(source)) return std::move(*layout);
    return plain_layout(source);
}

} // namespace clvr

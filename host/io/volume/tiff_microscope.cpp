// Dialects of microscopes: Zeiss LSM, MetaMorph STK, ScanImage, Olympus FluoView.
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/tiff_layout.hpp"

#include <algorithm>
#include <cmath>
#include <tiffio.h>

namespace clvr {

namespace {

/// Sizes must be those of the pages.
void check_pages(const TiffSource& source, const TiffLayout& layout, std::size_t pages, const char* who) {
    const double planes = double{1} * layout.channels * layout.slices * layout.times;
    if (planes != static_cast<double>(pages))
        bad_file(source.path, "{} says {} channels x {} slices x {} times, the file has {} pages: save it as OME-TIFF", who,
                 layout.channels, layout.slices, layout.times, pages);
}
/// Along `order` over the pages that are no thumbnails.
void add_main_pages(const TiffSource& source, TiffLayout& layout, const std::string& order, const char* who) {
    const auto main = source.main_pages();
    check_pages(source, layout, main.size(), who);
    layout.add_planes(order);
    for (TiffPlane& p : layout.planes) p.page = main[p.page];
}

/// CZ_LSMINFO: sizes from byte 8 on, voxel sizes in metres from byte 40 on. The channels of a page are samples of its pixels.
std::optional<TiffLayout> lsm_layout(const TiffSource& source) {
    const auto entry = source.file.entry(34412);
    if (!entry || entry->count < 64) return std::nullopt;
    const std::uint64_t at = entry->value_at;
    const auto size = [&](std::uint64_t offset) {
        const auto n = static_cast<std::int32_t>(source.file.integer(at + offset, 4));
        if (n < 1) bad_file(source.path, "its LSM header gives a size of {}", n);
        return n;
    };
    TiffLayout layout;
    layout.indexed = true;
    layout.slices = size(16), layout.times = size(24);
    for (std::size_t i = 0; i < 3; ++i)
        layout.scales[i] = {source.file.real(at + 40 + 8 * i) * 1e6, "um", fmt::format("LSM VoxelSize{}", "XYZ"[i])};
    add_main_pages(source, layout, "CZT", "its LSM header");
    layout.decisions.push_back(fmt::format("axes from LSM: {} slices x {} times of {} channels", layout.slices, layout.times, size(20)));
    return layout;
}

/// MetaMorph: one directory for all planes, which stand behind each other. UIC2 counts them and gives their distance; UIC1 has the
/// calibration.
std::optional<TiffLayout> stk_layout(const TiffSource& source) {
    const TiffFile& file = source.file;
    const auto planes = file.entry(33629);
    if (!planes) return std::nullopt;
    if (planes->count == 0 || planes->count > 0x7fffffff) bad_file(source.path, "its MetaMorph tags count {} planes", planes->count);
    TiffLayout layout;
    layout.slices = static_cast<int>(planes->count);
    if (source.pages.size() > 1 && planes->count == source.pages.size()) {
        add_main_pages(source, layout, "ZCT", "its MetaMorph tag");
    } else if (planes->count > 1) {
        const TiffForm form = form_of(file, false, true);
        const auto at = plain_planes(source, form, planes->count, fmt::format("its MetaMorph tag says {} planes", planes->count));
        layout.add_planes("ZCT");
        for (TiffPlane& p : layout.planes) p.plain_at = at[p.page], p.page = 0;
    } else {
        return std::nullopt;
    }
    const auto ratio = [&](std::uint64_t at) {
        const auto below = static_cast<double>(file.integer(at + 4, 4));
        return below > 0 ? static_cast<double>(file.integer(at, 4)) / below : 0.0;
    };
    // A plane has six numbers: z distance (a ratio), date and time of its creation and change.
    const double z = ratio(planes->value_at + (planes->count > 1 ? 24 : 0));
    std::string unit;
    double x = 0, y = 0;
    if (const auto ids = file.entry(33628); ids && (ids->type == TIFF_LONG || ids->type == TIFF_RATIONAL))
        for (std::uint64_t i = 0; i < std::min<std::uint64_t>(ids->count, 256); ++i) {
            const std::uint64_t pair = ids->value_at + 8 * i, id = file.integer(pair, 4), value = file.integer(pair + 4, 4);
            if (id == 4) x = ratio(value);
            if (id == 5) y = ratio(value);
            if (id == 6) unit = file.bytes(value + 4, std::min<std::uint64_t>(file.integer(value, 4), 64)).c_str();
        }
    layout.scales = {AxisScale{x, unit, "MetaMorph XCalibration"}, AxisScale{y, unit, "MetaMorph YCalibration"},
                     AxisScale{z, unit, "MetaMorph z distance"}};
    layout.notes.push_back(fmt::format("MetaMorph stack: its {} planes are taken as slices", planes->count));
    return layout;
}

/// The number behind "name = " in a text; the count of numbers for a list "[1;2]".
std::optional<double> setting(const std::string& text, const std::string& name, bool count_list = false) {
    const auto at = text.find(name);
    if (at == std::string::npos) return std::nullopt;
    const auto equals = text.find('=', at + name.size());
    if (equals == std::string::npos) return std::nullopt;
    std::string value(trimmed(std::string_view(text).substr(equals + 1, text.find_first_of("\r\n", equals) - equals - 1)));
    const bool is_list = !value.empty() && value.front() == '[';
    std::replace_if(
        value.begin(), value.end(), [](char c) { return c == '[' || c == ']' || c == ';'; }, ' ');
    const auto numbers = parse_numbers(value);
    if (!numbers || numbers->empty()) return std::nullopt;
    return count_list ? (is_list ? static_cast<double>(numbers->size()) : 1.0) : numbers->front();
}

/// ScanImage: pages are channels, then frames of a slice, then slices, then volumes.
std::optional<TiffLayout> scanimage_layout(const TiffSource& source) {
    std::string text = source.file.text(TIFFTAG_SOFTWARE);
    if (text.compare(0, 3, "SI.") != 0) text = source.description;
    const bool old = text.find("state.software") != std::string::npos || text.find("state.acq.") != std::string::npos,
               modern = text.find("SI.VERSION_MAJOR") != std::string::npos || text.find("scanimage.SI") != std::string::npos;
    if (!old && !modern) return std::nullopt;
    TiffLayout layout;
    const auto at_least_one = [](std::optional<double> x) { return x && *x >= 1 && *x < 1e6 ? static_cast<int>(*x) : 1; };
    if (old) {
        layout.channels = at_least_one(setting(text, "state.acq.numberOfChannelsSave"));
        layout.slices = at_least_one(setting(text, "state.acq.numberOfZSlices"));
    } else {
        layout.channels = at_least_one(setting(text, "hChannels.channelSave", true));
        const auto actual = setting(text, "hStackManager.actualNumSlices");
        layout.slices = at_least_one(actual ? actual : setting(text, "hStackManager.numSlices"));
    }
    const std::size_t pages = source.main_pages().size();
    const double volume = static_cast<double>(layout.channels) * layout.slices, times = static_cast<double>(pages) / volume;
    const double frames_a_slice = at_least_one(setting(text, old ? "state.acq.numberOfFrames" : "hStackManager.framesPerSlice"));
    if (times != std::floor(times) || times < 1 || (layout.slices > 1 && times > 1 && frames_a_slice > 1))
        bad_file(
            source.path,
            "ScanImage says {} channels x {} slices of {:g} frames, the file has {} pages: average the frames of each slice, or save it "
            "as OME-TIFF",
            layout.channels, layout.slices, frames_a_slice, pages);
    layout.times = static_cast<int>(times);
    add_main_pages(source, layout, "CZT", "ScanImage");
    layout.decisions.push_back(
        fmt::format("axes from ScanImage: {} channels x {} slices x {} times", layout.channels, layout.slices, layout.times));
    return layout;
}

/// Olympus FluoView's header: ten dimensions of 100 bytes from byte 284 on: name, size, origin, resolution, unit.
std::optional<TiffLayout> fluoview_layout(const TiffSource& source) {
    const TiffFile& file = source.file;
    const auto entry = file.entry(34361);
    constexpr std::uint64_t first = 284, each = 100;
    if (!entry || entry->count < first + 10 * each) return std::nullopt;
    TiffLayout layout;
    layout.indexed = true;
    std::string order, sizes;
    for (std::uint64_t i = 0; i < 10; ++i) {
        const std::uint64_t at = entry->value_at + first + i * each;
        const std::string name = lower_case(file.bytes(at, 16).c_str());
        const auto size = static_cast<std::int32_t>(file.integer(at + 16, 4));
        const char axis = name.empty() ? ' ' : name == "z" ? 'Z' : name == "t" ? 'T' : name == "ch" || name == "wavelength" ? 'C' : name[0];
        if (size <= 0) continue;
        if (axis == 'x' || axis == 'y' || axis == 'Z')
            layout.scales[axis == 'x'   ? 0
                          : axis == 'y' ? 1
                                        : 2] = {std::abs(file.real(at + 28)), file.bytes(at + 36, 64).c_str(), "FluoView's header"};
        if (axis == 'x' || axis == 'y' || size == 1) continue;
        sizes += fmt::format("{}{} {}", sizes.empty() ? "" : " x ", size, name);
        if (axis == 'Z' || axis == 'T' || axis == 'C') {
            layout.size_of(axis) = size;
            order += axis;
        } else {
            bad_file(source.path, "its FluoView header has axes that clvr does not read ({}): save it as OME-TIFF", sizes);
        }
    }
    for (const char c : {'C', 'Z', 'T'})
        if (order.find(c) == std::string::npos) order += c;
    if (order.size() != 3) bad_file(source.path, "its FluoView header has an axis twice ({})", sizes);
    add_main_pages(source, layout, order, "its FluoView header");
    layout.decisions.push_back(fmt::format("axes from FluoView: {}", sizes));
    return layout;
}

} // namespace

std::optional<TiffLayout> microscope_layout(const TiffSource& source) {
    for (const auto kind : {lsm_layout, stk_layout, scanimage_layout, fluoview_layout})
        if (auto layout = kind(source)) return layout;
    return std::nullopt;
}

} // namespace clvr

// ImageJ's hyperstacks: lines "name=value" in the description of the first page.
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/tiff_layout.hpp"

#include <cmath>
#include <map>
#include <tiffio.h>

namespace clvr {

namespace {

class ImageJFields {
public:
    ImageJFields(const std::string& description, const std::string& path) : path_(path) {
        std::size_t at = 0;
        while (at < description.size()) {
            const std::size_t end = std::min(description.find_first_of("\r\n", at), description.size());
            const std::string line = description.substr(at, end - at);
            if (const auto equals = line.find('='); equals != std::string::npos) fields_[line.substr(0, equals)] = line.substr(equals + 1);
            at = end + 1;
        }
    }
    std::string text(const char* name) const {
        const auto f = fields_.find(name);
        return f == fields_.end() ? "" : std::string(trimmed(f->second));
    }
    std::optional<double> number(const char* name) const {
        const auto values = parse_numbers(text(name));
        return values && values->size() == 1 && std::isfinite(values->front()) ? std::optional(values->front()) : std::nullopt;
    }
    /// A size of at least 1; 1 where there is none.
    int count(const char* name) const {
        return text(name).empty() ? 1 : static_cast<int>(parse_integers(text(name), 1, 1, name, path_).front());
    }

private:
    std::map<std::string, std::string> fields_;
    std::string path_;
};

/// A unit as ImageJ writes it, where \u00B5 is an escaped micro sign.
std::string unescaped(std::string unit) {
    const std::string escape = "\\u00b5";
    if (const auto at = lower_case(unit).find(escape); at != std::string::npos) unit.replace(at, escape.size(), "\xc2\xb5");
    return unit;
}

/// The resolution tags count pixels a unit; the unit stands in the text, or ImageJ takes that of the tags.
void set_scales(const TiffFile& file, const ImageJFields& fields, bool is_stack, TiffLayout& layout) {
    float x = 0, y = 0;
    if (TIFFGetField(file.get(), TIFFTAG_XRESOLUTION, &x) && x > 0) layout.scales[0].value = 1 / double{x};
    if (TIFFGetField(file.get(), TIFFTAG_YRESOLUTION, &y) && y > 0) layout.scales[1].value = 1 / double{y};
    std::string unit = unescaped(fields.text("unit"));
    std::uint16_t tag_unit = RESUNIT_NONE;
    if (unit.empty() && TIFFGetField(file.get(), TIFFTAG_RESOLUTIONUNIT, &tag_unit)) {
        if (tag_unit == RESUNIT_CENTIMETER) unit = "cm";
        if (tag_unit == RESUNIT_INCH && x > 1 && x != 72) unit = "inch"; // 72 and 1 are written by programs that do not know the resolution
    }
    const auto own_unit = [&](const char* name) { return fields.text(name).empty() ? unit : unescaped(fields.text(name)); };
    const auto spacing = fields.number("spacing");
    layout.scales[0].unit = unit, layout.scales[1].unit = own_unit("yunit"), layout.scales[2].unit = own_unit("zunit");
    layout.scales[0].source = layout.scales[1].source = "ImageJ's resolution";
    layout.scales[2].source = spacing ? "ImageJ's spacing=" : "ImageJ's default";
    // ImageJ leaves out a spacing of 1 unit; some programs write negative ones for stacks from the top down.
    layout.scales[2].value = spacing && *spacing != 0 ? std::abs(*spacing) : is_stack ? 1 : 0;
    if (!(layout.scales[0].value > 0) && spacing) layout.scales[0].value = layout.scales[1].value = 1;
    // Coordinates count from the origin in pixels.
    layout.origin_pixels = {fields.number("xorigin").value_or(0), fields.number("yorigin").value_or(0),
                            fields.number("zorigin").value_or(0)};
}

/// Function 0 is c0 + c1 x: ImageJ stores signed 16-bit values so.
void set_calibration(const ImageJFields& fields, TiffLayout& layout) {
    constexpr double straight_line = 0, none = 20;
    const auto function = fields.number("cf");
    if (!function || *function == none) return;
    const auto c0 = fields.number("c0"), c1 = fields.number("c1");
    if (*function == straight_line && c0 && c1 && *c1 != 0) {
        layout.intercept = *c0, layout.slope = *c1;
        layout.decisions.push_back(fmt::format("values from ImageJ's calibration: {:g} + {:g} x stored", *c0, *c1));
        return;
    }
    layout.notes.push_back(fmt::format("ImageJ's calibration function {:g} is not a straight line: values are taken as stored", *function));
}

} // namespace

bool set_imagej_scales(const TiffSource& source, TiffLayout& layout, bool is_stack) {
    if (source.description.compare(0, 7, "ImageJ=") != 0) return false;
    const ImageJFields fields(source.description, source.path);
    set_scales(source.file, fields, is_stack, layout);
    set_calibration(fields, layout);
    return true;
}

std::optional<TiffLayout> imagej_layout(const TiffSource& source) {
    TiffLayout layout;
    if (!set_imagej_scales(source, layout, true)) return std::nullopt;
    const ImageJFields fields(source.description, source.path);
    const std::vector<std::uint64_t> main = source.main_pages();
    layout.indexed = true;

    const std::uint64_t pages = main.size();
    layout.channels = fields.count("channels"), layout.slices = fields.count("slices"), layout.times = fields.count("frames");
    std::uint64_t images = static_cast<std::uint64_t>(fields.count("images"));
    std::uint64_t product = static_cast<std::uint64_t>(layout.channels) * static_cast<std::uint64_t>(layout.slices); // below 2^62
    product = product > (std::uint64_t{1} << 31) ? product : product * static_cast<std::uint64_t>(layout.times);
    if (product == 1) product = images, layout.slices = static_cast<int>(images);
    const std::string sizes = fmt::format("{} channel{} x {} slice{} x {} frame{}", layout.channels, layout.channels == 1 ? "" : "s",
                                          layout.slices, layout.slices == 1 ? "" : "s", layout.times, layout.times == 1 ? "" : "s");

    if (pages == 1 && product > 1) {
        const TiffForm form = form_of(source.file, source.options.channel.has_value(), true);
        if (form.depth == 1 && form.samples == 1) {
            const auto at = plain_planes(source, form, product, fmt::format("ImageJ says {} images", product));
            layout.add_planes("CZT");
            for (TiffPlane& p : layout.planes) p.plain_at = at[p.page], p.page = 0;
            layout.decisions.push_back("ImageJ's form above 4 GB: the slices stand behind the first page");
        } else if (product != form.samples) {
            bad_file(source.path, "ImageJ says {} images, the file has 1 page of {} channels and {} slices", product, form.samples,
                     form.depth);
        } else { // the channels are samples of the pixels
            layout.channels = layout.slices = layout.times = 1;
            layout.add_planes("CZT");
        }
    } else if (product == pages) {
        layout.add_planes("CZT");
        for (TiffPlane& p : layout.planes) p.page = main[p.page];
    } else if (layout.channels == 1 && layout.times == 1 && pages > 1) {
        layout.notes.push_back(fmt::format("ImageJ says {} slices, the file has {} pages: each page is taken as a slice", product, pages));
        layout.slices = static_cast<int>(pages);
        layout.add_planes("CZT");
        for (TiffPlane& p : layout.planes) p.page = main[p.page];
    } else {
        bad_file(source.path, "ImageJ says {}, the file has {} page{}: it is truncated, or its pages were changed without its description",
                 sizes, pages, pages == 1 ? "" : "s");
    }
    layout.channels_may_be_slices = true;
    layout.decisions.push_back("axes from ImageJ: " + sizes);
    return layout;
}

} // namespace clvr

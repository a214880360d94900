// OME-TIFF: OME-XML in the description of the first page says what each page is.
#include "host/io/volume/tiff_ome.hpp"
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/tiff_layout.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <pugixml.hpp>
#include <set>
#include <tiffio.h>

namespace clvr {

namespace {

namespace fs = std::filesystem;

/// The name without its namespace.
std::string local_name(const pugi::xml_node& node) {
    const std::string name = node.name();
    return name.substr(name.find(':') == std::string::npos ? 0 : name.find(':') + 1);
}
std::vector<pugi::xml_node> children(const pugi::xml_node& of, const char* name) {
    std::vector<pugi::xml_node> found;
    for (const auto& node : of.children())
        if (local_name(node) == name) found.push_back(node);
    return found;
}
pugi::xml_node child(const pugi::xml_node& of, const char* name) {
    const auto all = children(of, name);
    return all.empty() ? pugi::xml_node() : all.front();
}

bool is_ome(const std::string& text) {
    const std::string head = text.substr(0, 4096);
    return head.find("<OME") != std::string::npos || head.find("<OME:OME") != std::string::npos ||
           head.find("<ome:OME") != std::string::npos;
}

/// A whole number of at least `least`, or `fallback` where the attribute is absent.
std::int64_t whole(const pugi::xml_node& node, const char* name, std::int64_t least, std::int64_t fallback, const std::string& path) {
    const auto attribute = node.attribute(name);
    if (!attribute) return fallback;
    const std::int64_t value = parse_integers(attribute.value(), 1, least, name, path).front();
    if (value > 0x7fffffff) bad_file(path, "{} is {} in its OME-XML: impossible", name, value);
    return value;
}

pugi::xml_node root_of(pugi::xml_document& document, const std::string& text, const std::string& path) {
    const auto result = document.load_buffer(text.data(), text.size());
    if (!result) bad_file(path, "its OME-XML breaks off or is no XML ({} at byte {})", result.description(), result.offset);
    for (const auto& node : document.children())
        if (local_name(node) == "OME") return node;
    bad_file(path, "its OME-XML has no element OME");
}

/// The files that hold the pages of any image.
std::set<std::string> file_names(const pugi::xml_node& root) {
    std::set<std::string> names;
    for (const auto& image : children(root, "Image"))
        for (const auto& data : children(child(image, "Pixels"), "TiffData"))
            if (const auto name = fs::path(child(data, "UUID").attribute("FileName").value()).filename(); !name.empty())
                names.insert(name.string());
    return names;
}

/// The metadata may be in another file, which this one names.
pugi::xml_node follow_binary_only(pugi::xml_document& document, const pugi::xml_node& root, const std::string& path) {
    const pugi::xml_node only = child(root, "BinaryOnly");
    if (!only) return root;
    const std::string name = fs::path(only.attribute("MetadataFile").value()).filename().string();
    const fs::path file = fs::path(path).parent_path() / name;
    std::error_code error;
    const auto bytes = fs::file_size(file, error);
    if (name.empty() || error) bad_file(path, "its OME-XML stands in another file, \"{}\", which is not beside it", name);
    constexpr std::uint64_t most = std::uint64_t{1} << 28;
    if (bytes > most) bad_file(file.string(), "has {} bytes: expected OME-XML of at most {}", bytes, most);
    std::string text = read_head(file.string(), bytes);
    const std::string tiff_marks[] = {std::string("II*\0", 4), std::string("MM\0*", 4), std::string("II+\0", 4), std::string("MM\0+", 4)};
    if (std::any_of(std::begin(tiff_marks), std::end(tiff_marks), [&](const std::string& m) { return text.compare(0, 4, m) == 0; }))
        text = TiffFile(file.string()).text(TIFFTAG_IMAGEDESCRIPTION);
    return root_of(document, text, file.string());
}

/// Which image of several: --series by its index, name or ID, else the first.
pugi::xml_node choose_image(const TiffSource& source, const pugi::xml_node& root, TiffLayout& layout) {
    std::vector<pugi::xml_node> images;
    for (const auto& image : children(root, "Image"))
        if (child(image, "Pixels")) images.push_back(image);
    if (images.empty()) bad_file(source.path, "its OME-XML has no image");
    const std::string& wanted = source.options.series;
    std::string names;
    for (std::size_t i = 0; i < images.size(); ++i) {
        const std::string name = images[i].attribute("Name").value();
        if (!wanted.empty() && (wanted == name || wanted == images[i].attribute("ID").value() || wanted == std::to_string(i))) {
            layout.decisions.push_back(fmt::format("image {} \"{}\" of {} in the OME-XML", i, name, images.size()));
            return images[i];
        }
        if (i < 8) names += fmt::format("{}{} \"{}\"", i ? ", " : "", i, name);
    }
    if (images.size() > 8) names += ", ...";
    if (!wanted.empty()) bad_file(source.path, "there is no image \"{}\": the file has {}", wanted, names);
    if (images.size() > 1)
        layout.notes.push_back(
            fmt::format("the file has {} images ({}): the first is read (--series NAME or NUMBER picks)", images.size(), names));
    return images.front();
}

void set_scales(const pugi::xml_node& pixels, TiffLayout& layout) {
    for (std::size_t i = 0; i < 3; ++i) {
        const std::string name = fmt::format("PhysicalSize{}", "XYZ"[i]), unit_name = name + "Unit";
        AxisScale& s = layout.scales[i];
        s.source = "OME-XML " + name;
        const auto size = parse_numbers(pixels.attribute(name.c_str()).value());
        if (size && size->size() == 1) s.value = size->front();
        s.unit = pixels.attribute(unit_name.c_str()).as_string("\xc2\xb5m");
    }
}

/// Where the planes of an image are: TiffData elements in order, each a run of pages along DimensionOrder.
class Planes {
public:
    /// `own_uuid`: this file's.
    Planes(const TiffSource& source, const pugi::xml_node& root, TiffLayout& layout, std::string order, std::string own_uuid)
        : source_(source), layout_(layout), order_(std::move(order)), own_uuid_(std::move(own_uuid)) {
        const std::set<std::string> names = file_names(root);
        only_name_ = names.size() == 1 ? *names.begin() : "";
    }

    void add(const pugi::xml_node& data) {
        const std::int64_t total = std::int64_t{layout_.channels} * layout_.slices * layout_.times;
        const std::string file = file_of(data);
        std::array<std::int64_t, 3> at{};
        for (std::size_t i = 0; i < 3; ++i) at[i] = whole(data, fmt::format("First{}", order_[i]).c_str(), 0, 0, source_.path);
        std::int64_t start = at[0] + size(0) * (at[1] + size(1) * at[2]);
        if (at[0] >= size(0) || at[1] >= size(1) || at[2] >= size(2))
            bad_file(source_.path, "its OME-XML places a page at {} {}, {} {}, {} {}, beyond the image's size", order_[0], at[0], order_[1],
                     at[1], order_[2], at[2]);
        const bool has_page = !data.attribute("IFD").empty();
        const std::int64_t page = whole(data, "IFD", 0, 0, source_.path);
        const auto pages = static_cast<std::int64_t>(source_.pages.size());
        const std::int64_t rest = file.empty() ? std::min(total - start, pages - std::min(page, pages)) : total - start;
        const std::int64_t count = whole(data, "PlaneCount", 0, has_page ? 1 : rest, source_.path);
        if (count > total - start) bad_file(source_.path, "its OME-XML counts {} pages where {} are left", count, total - start);
        add_run(start, count, page, file);
    }
    /// Pages in order, where the OME-XML does not say.
    void add_all() {
        add_run(0,
                std::min<std::int64_t>(std::int64_t{layout_.channels} * layout_.slices * layout_.times,
                                       static_cast<std::int64_t>(source_.pages.size())),
                0, "");
    }

private:
    std::int64_t size(std::size_t i) const { return layout_.size_of(order_[i]); }
    void add_run(std::int64_t start, std::int64_t count, std::int64_t page, const std::string& file) {
        constexpr std::size_t most = 1 << 24;
        if (static_cast<std::size_t>(count) > most - std::min(most, layout_.planes.size()))
            bad_file(source_.path, "its OME-XML names more than {} pages", most);
        for (std::int64_t i = 0; i < count; ++i) {
            const std::int64_t k = start + i;
            const std::array<std::int64_t, 3> at{k % size(0), k / size(0) % size(1), k / size(0) / size(1)};
            TiffPlane p;
            for (std::size_t axis = 0; axis < 3; ++axis) p.index_of(order_[axis]) = static_cast<int>(at[axis]);
            p.file = file;
            p.page = static_cast<std::uint64_t>(page + i);
            layout_.planes.push_back(std::move(p));
        }
    }
    /// The file that a TiffData element names; empty for this file, also where it was renamed.
    std::string file_of(const pugi::xml_node& data) {
        const auto uuid = child(data, "UUID");
        const std::string name = fs::path(uuid.attribute("FileName").value()).filename().string(), own = source_.file.path();
        const std::string value = std::string(trimmed(uuid.child_value()));
        if (name.empty() || name == fs::path(own).filename() || (!own_uuid_.empty() && value == own_uuid_)) return "";
        const fs::path beside = fs::path(own).parent_path() / name;
        std::error_code error;
        if (fs::exists(beside, error)) return beside.string();
        if (only_name_.empty()) return beside.string(); // reported as missing when its planes are read
        layout_.decisions.push_back(fmt::format("its OME-XML calls the file \"{}\": it was renamed", name));
        return "";
    }

    const TiffSource& source_;
    TiffLayout& layout_;
    std::string order_; ///< of C, Z and T, the fastest first
    std::string own_uuid_, only_name_;
};

} // namespace

bool set_ome_scales(const TiffSource& source, TiffLayout& layout) {
    if (!is_ome(source.description)) return false;
    pugi::xml_document document;
    const pugi::xml_node root = root_of(document, source.description, source.file.path());
    set_scales(child(child(root, "Image"), "Pixels"), layout);
    return true;
}

std::optional<TiffLayout> ome_layout(const TiffSource& source) {
    if (!is_ome(source.description)) return std::nullopt;
    TiffLayout layout;
    layout.indexed = true;
    pugi::xml_document document, companion;
    const pugi::xml_node own = root_of(document, source.description, source.path);
    const pugi::xml_node root = follow_binary_only(companion, own, source.path);
    const pugi::xml_node pixels = child(choose_image(source, root, layout), "Pixels");

    const std::int64_t width = whole(pixels, "SizeX", 1, 0, source.path), height = whole(pixels, "SizeY", 1, 0, source.path);
    layout.slices = static_cast<int>(whole(pixels, "SizeZ", 1, 1, source.path));
    layout.times = static_cast<int>(whole(pixels, "SizeT", 1, 1, source.path));
    std::int64_t channels = whole(pixels, "SizeC", 1, 1, source.path);
    const auto samples = static_cast<std::int64_t>(source.file.field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL, 1));
    if (samples > 1 && channels % samples == 0) channels /= samples; // SizeC counts the samples of pixels too
    layout.channels = static_cast<int>(channels);
    const double planes = static_cast<double>(channels) * layout.slices * layout.times;
    if (planes > 1 << 24) bad_file(source.path, "its OME-XML says {:g} planes: more than clvr reads", planes);

    const std::string order = pixels.attribute("DimensionOrder").as_string("XYCZT");
    std::string sorted = order;
    std::sort(sorted.begin(), sorted.end());
    if (sorted != "CTXYZ" || order.compare(0, 2, "XY") != 0)
        bad_file(source.path, "DimensionOrder is \"{:.20}\" in its OME-XML: expected XY, then C, Z and T", order);
    Planes places(source, root, layout, order.substr(2), own.attribute("UUID").value());
    const auto data = children(pixels, "TiffData");
    for (const auto& d : data) places.add(d);
    if (data.empty()) places.add_all();
    for (const TiffPlane& p : layout.planes)
        if (p.file.empty() && p.page < source.pages.size() &&
            (source.pages[p.page].width != width || source.pages[p.page].height != height))
            bad_file(source.path, "its OME-XML says {} x {} pixels, page {} has {} x {}", width, height, p.page, source.pages[p.page].width,
                     source.pages[p.page].height);

    set_scales(pixels, layout);
    for (const auto& channel : children(pixels, "Channel"))
        if (layout.channel_names.size() < 64) layout.channel_names.emplace_back(channel.attribute("Name").value());
    const bool named = std::any_of(layout.channel_names.begin(), layout.channel_names.end(), [](const auto& n) { return !n.empty(); });
    if (!named || layout.channel_names.size() != static_cast<std::size_t>(layout.channels)) layout.channel_names.clear();
    layout.channels_may_be_slices = !named;
    std::string sizes;
    for (const char axis : order.substr(2)) sizes += fmt::format(" x {}", layout.size_of(axis));
    layout.decisions.push_back(fmt::format("axes from OME-XML: {} {} x {}{}", order, width, height, sizes));
    return layout;
}

bool is_ome_set(const std::string& folder, const std::vector<std::string>& files) {
    const TiffFile file(files.front());
    const std::string text = file.text(TIFFTAG_IMAGEDESCRIPTION);
    if (!is_ome(text)) return false;
    pugi::xml_document document, companion;
    const pugi::xml_node root = follow_binary_only(companion, root_of(document, text, file.path()), file.path());
    const std::set<std::string> names = file_names(root);
    if (names.size() < 2) return false;
    for (const std::string& f : files)
        if (const std::string name = fs::path(f).filename().string(); names.count(name) == 0)
            bad_file(folder, "the OME-XML of {} names {} files, but {} is not among them: move it elsewhere, or name a file",
                     fs::path(files.front()).filename().string(), names.size(), name);
    return true;
}

} // namespace clvr

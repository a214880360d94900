// tifffile's description: {"shape": [2, 8, 7, 6], "axes": "CZYX"}, the slowest axis first.
#include "host/io/volume/tiff_layout.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace clvr {

namespace {

struct Axis {
    std::uint64_t size = 1;
    char letter = 'Q'; ///< Q: of unknown meaning
};

std::optional<std::vector<Axis>> axes_of(const std::string& description) {
    if (description.empty() || description.front() != '{') return std::nullopt;
    const nlohmann::json json = nlohmann::json::parse(description, nullptr, false);
    if (!json.is_object() || !json.contains("shape") || !json["shape"].is_array()) return std::nullopt;
    std::vector<Axis> axes;
    for (const auto& n : json["shape"]) {
        if (!n.is_number_unsigned() || n.get<std::uint64_t>() == 0 || n.get<std::uint64_t>() > 0x7fffffff) return std::nullopt;
        axes.push_back({n.get<std::uint64_t>()});
    }
    if (const auto letters = json.find("axes"); letters != json.end() && letters->is_string()) {
        const auto text = letters->get<std::string>();
        if (text.size() == axes.size())
            for (std::size_t i = 0; i < axes.size(); ++i)
                axes[i].letter = static_cast<char>(std::toupper(static_cast<unsigned char>(text[i])));
    }
    return axes;
}

/// Takes from the end of `axes` what stands within a page: Y and X, the samples of pixels, the slices of ImageDepth. False where they do
/// not fit the page. Throws Error{input} where they have other names.
bool take_page_axes(std::vector<Axis>& axes, const TiffForm& form, const std::string& path) {
    const auto take = [&](std::uint64_t size) {
        if (axes.empty() || axes.back().size != size) return size == 1;
        axes.pop_back();
        return true;
    };
    if (form.samples > 1 && !form.separate && !take(form.samples)) return false;
    for (const char letter : {'X', 'Y'}) {
        if (axes.empty() || axes.back().size != (letter == 'X' ? form.width : form.height)) return false;
        if (axes.back().letter != 'Q' && axes.back().letter != letter)
            bad_file(path, "its description calls the {} of its pages {}: clvr reads pages of y and x", letter == 'X' ? "columns" : "rows",
                     axes.back().letter);
        axes.pop_back();
    }
    if (form.depth > 1 && !take(form.depth)) return false;
    return !(form.separate && form.samples > 1) || take(form.samples);
}

std::uint64_t product_of(const std::vector<Axis>& axes) {
    std::uint64_t n = 1;
    for (const Axis& a : axes) n = n > (std::uint64_t{1} << 31) ? n : n * a.size;
    return n;
}

/// Which of z, c, t each axis of more than one entry is: by its letter where that is known; one unknown axis is z where z is missing.
std::string roles_of(const TiffSource& source, const std::vector<Axis>& axes, bool page_has_depth, TiffLayout& layout) {
    std::string roles, unknown, text;
    for (const Axis& a : axes) {
        const char role = a.letter == 'S' ? 'C' : a.letter;
        const bool known = (role == 'C' || role == 'Z' || role == 'T') && roles.find(role) == std::string::npos;
        roles += known ? role : 'Q';
        if (!known) unknown += a.letter;
        text += fmt::format("{}{} {}", text.empty() ? "" : " x ", a.size, a.letter == 'Q' ? "(unnamed)" : std::string(1, a.letter));
    }
    const bool has_z = page_has_depth || roles.find('Z') != std::string::npos;
    if (unknown.size() > 1 || (unknown.size() == 1 && has_z))
        bad_file(source.path,
                 "its axes before y and x are {}: clvr reads z, c and t. Write it with metadata={{'axes': 'TCZYX'}} or the like, "
                 "or save one volume",
                 text);
    if (unknown.size() == 1) {
        roles[roles.find('Q')] = 'Z';
        if (unknown != "Q") layout.notes.push_back(fmt::format("the file's axis {} is of unknown meaning: taken as slices", unknown));
    }
    layout.decisions.push_back(fmt::format("axes from tifffile's shape: {}", text.empty() ? "one page" : text));
    return roles;
}

} // namespace

std::optional<TiffLayout> shaped_layout(const TiffSource& source) {
    auto axes = axes_of(source.description);
    if (!axes) return std::nullopt;
    const TiffForm form = form_of(source.file, source.options.channel.has_value(), false);
    const std::vector<std::uint64_t> main = source.main_pages();
    if (!take_page_axes(*axes, form, source.path)) {
        TiffLayout layout = plain_layout(source);
        layout.notes.push_back("its description's shape is not that of its pages: each page is taken as a slice");
        return layout;
    }
    axes->erase(std::remove_if(axes->begin(), axes->end(), [](const Axis& a) { return a.size == 1; }), axes->end());
    const std::uint64_t count = product_of(*axes);
    if (axes->empty() && main.size() > 1) return plain_layout(source); // pages written one by one

    TiffLayout layout;
    const std::string roles = roles_of(source, *axes, form.depth > 1, layout);
    std::string order; // fastest first
    for (std::size_t i = axes->size(); i-- > 0;) {
        layout.size_of(roles[i]) = static_cast<int>((*axes)[i].size);
        order += roles[i];
    }
    for (const char c : {'C', 'Z', 'T'})
        if (order.find(c) == std::string::npos) order += c;

    if (main.size() == 1 && count > 1) {
        const auto at = plain_planes(source, form, count, fmt::format("its description says {} pages", count));
        layout.add_planes(order);
        for (TiffPlane& p : layout.planes) p.plain_at = at[p.page], p.page = 0;
        return layout;
    }
    if (count > main.size()) {
        if (axes->size() > 1 || main.size() == 1)
            bad_file(source.path, "its description says {} pages, the file has {}: it is truncated, or its pages were changed without it",
                     count, main.size());
        layout = plain_layout(source);
        layout.notes.push_back(fmt::format("its description says {} pages, the file has {}: each is taken as a slice", count, main.size()));
        return layout;
    }
    if (count < main.size())
        layout.notes.push_back(fmt::format("the file holds more than one series: the first {} of {} pages are read", count, main.size()));
    layout.add_planes(order);
    for (TiffPlane& p : layout.planes) p.page = main[p.page];
    return layout;
}

} // namespace clvr

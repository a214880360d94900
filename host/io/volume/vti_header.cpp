#include "host/io/volume/vti_header.hpp"
#include "host/io/volume/axes.hpp"
#include "host/io/volume/header_text.hpp"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <pugixml.hpp>

namespace clvr {

struct VtiHeader::Xml {
    std::string text; ///< the document lives in it
    pugi::xml_document document;
    pugi::xml_node file, image;
    std::vector<pugi::xml_node> pieces;
    std::optional<std::uint64_t> appended; ///< where the appended data start in the file: behind their "_"
    bool appended_base64 = false;
};

namespace {

constexpr const char* appended_tag = "<AppendedData";

/// The file up to its appended data, which are no XML; `behind` becomes the tag that starts them and what stands up to their "_".
std::string xml_part(const std::string& path, std::string& behind) {
    FileBytes file(path, ByteStream::Coding::plain);
    std::string text;
    const auto grow = [&] {
        constexpr std::size_t piece = std::size_t{1} << 16;
        const std::size_t before = text.size();
        text.resize(before + piece);
        text.resize(before + file.read(text.data() + before, piece));
        return text.size() > before;
    };
    std::size_t at = std::string::npos, searched = 0;
    while (at == std::string::npos && grow()) {
        at = text.find(appended_tag, searched);
        searched = text.size() - std::min(text.size(), std::strlen(appended_tag));
    }
    if (at == std::string::npos) return text;
    std::size_t mark = std::string::npos;
    while (mark == std::string::npos && text.size() - at < 100000) {
        const auto end = text.find('>', at);
        mark = end == std::string::npos ? end : text.find('_', end);
        if (mark == std::string::npos && !grow()) break;
    }
    if (mark == std::string::npos) bad_file(path, "its AppendedData have no start (\"_\"): the file is truncated");
    behind = text.substr(at, mark + 1 - at);
    text.resize(at);
    return text;
}

} // namespace

VtiHeader::VtiHeader(const std::string& path, std::vector<std::string>& decisions)
    : path_(path), file_size_(std::filesystem::file_size(path)), xml_(std::make_unique<Xml>()) {
    std::string behind;
    xml_->text = xml_part(path, behind);
    if (!behind.empty()) {
        xml_->appended = xml_->text.size() + behind.size();
        const std::string tag = behind.substr(0, behind.find('>'));
        xml_->appended_base64 = tag.find("base64") != std::string::npos;
        if (!xml_->appended_base64 && tag.find("raw") == std::string::npos)
            bad_file(path_, "its AppendedData have no encoding that clvr knows: expected raw or base64");
        xml_->text += "</VTKFile>";
    }
    const pugi::xml_parse_result parsed = xml_->document.load_buffer_inplace(xml_->text.data(), xml_->text.size());
    if (!parsed)
        bad_file(path_, "its XML breaks off at byte {} ({}): the file is truncated or damaged", parsed.offset, parsed.description());
    xml_->file = xml_->document.child("VTKFile");
    const std::string type = xml_->file.attribute("type").value();
    if (type == "PImageData")
        bad_file(path_, "a .pvti file holds no voxels, only the names of other files: save them in ParaView as one .vti");
    if (type != "ImageData")
        bad_file(path_, "the VTK file holds \"{:.40}\": clvr reads ImageData (.vti), resample it in ParaView (Resample To Image)", type);
    xml_->image = xml_->file.child("ImageData");
    if (!xml_->image) bad_file(path_, "the VTK file has no ImageData: it is damaged");
    take_coding(decisions);
    take_grid();
    take_pieces();
    take_arrays();
}

VtiHeader::~VtiHeader() = default;

void VtiHeader::take_coding(std::vector<std::string>& decisions) {
    const std::string order = xml_->file.attribute("byte_order").value(), header = xml_->file.attribute("header_type").value(),
                      compressor = xml_->file.attribute("compressor").value();
    if (order.empty()) decisions.push_back("the file names no byte order: little-endian is taken");
    if (!order.empty() && order != "LittleEndian" && order != "BigEndian")
        bad_file(path_, "its byte order is \"{:.40}\": expected LittleEndian or BigEndian", order);
    coding_.big_endian = order == "BigEndian";
    if (!header.empty() && header != "UInt32" && header != "UInt64")
        bad_file(path_, "its header_type is \"{:.40}\": expected UInt32 or UInt64", header);
    coding_.header_bytes = header == "UInt64" ? 8 : 4;
    if (compressor == "vtkZLibDataCompressor")
        coding_.compressor = VtiCompressor::zlib;
    else if (compressor == "vtkLZ4DataCompressor")
        coding_.compressor = VtiCompressor::lz4;
    else if (!compressor.empty())
        bad_file(path_, "compression {:.60} is not supported: save the file with zlib or LZ4 (vtkZLibDataCompressor, vtkLZ4DataCompressor)",
                 compressor);
}

std::array<std::int64_t, 6> VtiHeader::extent_of(const char* text, const char* name) const {
    const auto values = parse_integers(text, 6, -(std::int64_t{1} << 31), name, path_);
    std::array<std::int64_t, 6> e{};
    for (std::size_t i = 0; i < 6; ++i) {
        e[i] = values[i];
        if (e[i] > std::int64_t{1} << 31 || (i % 2 == 1 && e[i] < e[i - 1]))
            bad_file(path_, "{} is \"{:.60}\": expected the first and the last point of each axis", name, text);
    }
    return e;
}

void VtiHeader::take_grid() {
    const pugi::xml_node image = xml_->image;
    whole_ = extent_of(image.attribute("WholeExtent").value(), "WholeExtent");
    Geometry& g = grid_.geometry;
    if (const auto a = image.attribute("Spacing")) {
        const auto spacing = parse_spacing(a.value(), 3, "Spacing", path_);
        std::copy_n(spacing.begin(), 3, g.spacing.begin());
        spaced_ = true;
    }
    if (const auto a = image.attribute("Origin")) {
        const auto origin = parse_finite(a.value(), 3, "Origin", path_);
        std::copy_n(origin.begin(), 3, g.origin.begin());
    }
    if (const auto a = image.attribute("Direction")) {
        const auto m = parse_finite(a.value(), 9, "Direction", path_);
        for (std::size_t i = 0; i < 9; ++i) g.direction.row[i / 3][i % 3] = m[i];
    }
    settle_axes(g);
    Double3 first;
    for (std::size_t i = 0; i < 3; ++i) {
        grid_.points[i] = whole_[2 * i + 1] - whole_[2 * i] + 1;
        first[i] = static_cast<double>(whole_[2 * i]);
    }
    g.origin = g.to_world(first);
}

void VtiHeader::take_pieces() {
    for (const pugi::xml_node piece : xml_->image.children("Piece")) {
        auto e = extent_of(piece.attribute("Extent").value(), "the Extent of a Piece");
        for (std::size_t i = 0; i < 6; ++i) {
            if (e[i] < whole_[i - i % 2] || e[i] > whole_[i - i % 2 + 1])
                bad_file(path_, "the piece \"{:.60}\" lies outside of WholeExtent \"{:.60}\"", piece.attribute("Extent").value(),
                         xml_->image.attribute("WholeExtent").value());
        }
        for (std::size_t i = 0; i < 6; ++i) e[i] -= whole_[i - i % 2];
        xml_->pieces.push_back(piece);
        extents_.push_back(e);
    }
    if (extents_.empty()) bad_file(path_, "its ImageData has no Piece: there are no voxels");
}

void VtiHeader::take_arrays() {
    for (const bool cells : {false, true}) {
        const pugi::xml_node data = xml_->pieces.front().child(cells ? "CellData" : "PointData");
        const std::string active = data.attribute("Scalars").value();
        for (const pugi::xml_node node : data.children()) {
            if (std::strcmp(node.name(), "DataArray") != 0 && std::strcmp(node.name(), "Array") != 0) continue;
            VtkArray a;
            a.name = node.attribute("Name").value();
            a.type_name = node.attribute("type").value();
            a.type = parse_sample_type(lower_case(a.type_name));
            a.of_cells = cells;
            a.active = !active.empty() && a.name == active;
            const auto count = node.attribute("NumberOfComponents");
            a.components = parse_integers(count ? count.value() : "1", 1, 1, "NumberOfComponents", path_).front();
            if (a.components > std::int64_t{1} << 31) bad_file(path_, "the array \"{:.60}\" has {} components", a.name, a.components);
            const bool known = std::any_of(arrays_.begin(), arrays_.end(),
                                           [&](const VtkArray& b) { return b.of_cells == cells && b.name == a.name; }); // another time step
            if (!known) arrays_.push_back(a);
        }
    }
}

namespace {

/// The elements of an array in a piece, one for each time step.
std::vector<pugi::xml_node> elements(const pugi::xml_node& piece, const VtkArray& array) {
    std::vector<pugi::xml_node> found;
    for (const pugi::xml_node node : piece.child(array.of_cells ? "CellData" : "PointData").children("DataArray"))
        if (array.name == node.attribute("Name").value()) found.push_back(node);
    return found;
}

} // namespace

std::int64_t VtiHeader::time_steps(const VtkArray& array) const {
    return std::max<std::int64_t>(1, static_cast<std::int64_t>(elements(xml_->pieces.front(), array).size()));
}

VtiValues VtiHeader::values(std::size_t piece, const VtkArray& array, int time_step) const {
    const auto found = elements(xml_->pieces[piece], array);
    const auto step = static_cast<std::size_t>(time_step);
    const pugi::xml_node node = step < found.size() ? found[step] : pugi::xml_node();
    const auto count = node.attribute("NumberOfComponents");
    if (!node || array.type_name != node.attribute("type").value() ||
        parse_integers(count ? count.value() : "1", 1, 1, "NumberOfComponents", path_).front() != array.components)
        bad_file(path_, "piece {} does not have the array \"{:.60}\" as piece 0 has it", piece, array.name);
    const std::string format = node.attribute("format").value();
    VtiValues v;
    if (format == "appended") {
        if (!xml_->appended)
            bad_file(path_, "the file has no AppendedData, where the array \"{:.60}\" should be: it is truncated", array.name);
        v.format = VtiValues::Format::appended;
        v.appended_base64 = xml_->appended_base64;
        v.offset =
            *xml_->appended + static_cast<std::uint64_t>(parse_integers(node.attribute("offset").value(), 1, 0, "offset", path_).front());
        return v;
    }
    if (!format.empty() && format != "ascii" && format != "binary")
        bad_file(path_, "the array \"{:.60}\" has the format \"{:.40}\": expected ascii, binary or appended", array.name, format);
    v.format = format == "binary" ? VtiValues::Format::base64 : VtiValues::Format::text;
    v.inline_text = node.text().get();
    return v;
}

} // namespace clvr

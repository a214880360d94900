#include "host/io/picture/exr_lines.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/parallel.hpp"

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfOpaqueAttribute.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fmt/format.h>
#include <memory>
#include <vector>

namespace clvr {

namespace {

Imath::Box2i box_of(const Region& r) { return {{r.x, r.y}, {r.x + r.width - 1, r.y + r.height - 1}}; }

void insert(Imf::Header& header, const std::string& name, const Frame::Attribute& attribute) {
    const bool known = Imf::Attribute::knownType(attribute.type.c_str());
    const std::unique_ptr<Imf::Attribute> value(known ? Imf::Attribute::newAttribute(attribute.type.c_str())
                                                      : new Imf::OpaqueAttribute(attribute.type.c_str()));
    Imf::StdISStream bytes;
    bytes.str(attribute.bytes);
    value->readValueFrom(bytes, static_cast<int>(attribute.bytes.size()), Imf::EXR_VERSION);
    header.insert(name, *value);
}

/// Whether a name is longer than the 31 characters that every version of the format takes.
bool has_long_names(const Imf::Header& header) {
    const auto is_long = [](const char* name) { return std::strlen(name) > 31; };
    for (auto a = header.begin(); a != header.end(); ++a)
        if (is_long(a.name()) || is_long(a.attribute().typeName())) return true;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (is_long(c.name())) return true;
    return false;
}

void add_number(std::string& to, std::uint64_t number, int bytes) {
    for (int k = 0; k < bytes; ++k) to += static_cast<char>(number >> 8 * k & 255);
}

/// The block of lines from `line` on, packed, behind its first line's place and its size.
std::string block_of(const Frame& frame, int line) {
    const int count = std::min(exr_block_lines, frame.height - line);
    const std::size_t row_bytes = static_cast<std::size_t>(frame.width) * sizeof(float);
    std::string lines(static_cast<std::size_t>(count) * frame.channels.size() * row_bytes, '\0');
    char* to = lines.data();
    for (int y = line; y < line + count; ++y)
        for (const auto& [name, values] : frame.channels) { // in the order of their names, as the header has them
            std::memcpy(to, values.data() + static_cast<std::size_t>(y) * frame.width, row_bytes);
            to += row_bytes;
        }
    const std::string packed = pack_lines(lines);
    std::string block;
    block.reserve(8 + packed.size());
    add_number(block, static_cast<std::uint32_t>(frame.y + line), 4);
    add_number(block, packed.size(), 4);
    return block += packed;
}

Imf::Header header_of(const Frame& frame) {
    Imf::Header header(box_of(frame.shown()), box_of(frame.window()), frame.pixel_aspect);
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const auto& [name, values] : frame.channels) {
        if (values.size() != frame.pixels())
            throw Error(ErrorKind::internal,
                        fmt::format("channel {} has {} values for {} x {} pixels", name, values.size(), frame.width, frame.height));
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    for (const auto& [name, value] : frame.further) insert(header, name, value);
    for (const auto& [name, value] : frame.attributes) header.insert(name, Imf::StringAttribute(value));
    header.sanityCheck();
    return header;
}

/// The file: OpenEXR writes the header, clvr the blocks, on all cores.
std::string encode(const Frame& frame) {
    static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "an EXR holds floats as this machine does");
    const Imf::Header header = header_of(frame);
    std::vector<std::string> blocks(static_cast<std::size_t>((frame.height + exr_block_lines - 1) / exr_block_lines));
    for_each_index(blocks.size(), [&](std::size_t b) { blocks[b] = block_of(frame, static_cast<int>(b) * exr_block_lines); });

    constexpr int with_long_names = 0x400;
    Imf::StdOSStream head;
    for (const int number : {Imf::MAGIC, Imf::EXR_VERSION | (has_long_names(header) ? with_long_names : 0)}) {
        std::string bytes;
        add_number(bytes, static_cast<std::uint32_t>(number), 4);
        head.write(bytes.data(), 4);
    }
    header.writeTo(head);
    std::string file = head.str();
    std::uint64_t at = file.size() + 8 * blocks.size();
    for (const std::string& block : blocks) {
        add_number(file, at, 8);
        at += block.size();
    }
    file.reserve(at);
    for (std::string& block : blocks) {
        file += block;
        std::string().swap(block);
    }
    return file;
}

} // namespace

void write_exr(const Frame& frame, const std::string& path) {
    if (frame.width < 1 || frame.height < 1 || frame.channels.empty())
        throw Error(ErrorKind::internal,
                    fmt::format("a frame of {} x {} pixels and {} channels", frame.width, frame.height, frame.channels.size()), path);
    std::string bytes;
    try {
        bytes = encode(frame);
    } catch (const Iex::BaseExc& e) {
        throw Error(ErrorKind::internal, fmt::format("OpenEXR cannot encode the frame: {}", e.what()), path);
    }
    write_atomically(path, bytes.data(), bytes.size());
}

} // namespace clvr

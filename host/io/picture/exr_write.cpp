#include "host/io/picture/exr_library.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOpaqueAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>
#include <fmt/format.h>
#include <memory>

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

std::string encode(const Frame& frame) {
    use_all_cores();
    Imf::Header header(box_of(frame.shown()), box_of(frame.window()), frame.pixel_aspect);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    for (const auto& [name, values] : frame.channels) {
        if (values.size() != frame.pixels())
            throw Error(ErrorKind::internal,
                        fmt::format("channel {} has {} values for {} x {} pixels", name, values.size(), frame.width, frame.height));
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), header.dataWindow()));
    }
    for (const auto& [name, value] : frame.further) insert(header, name, value);
    for (const auto& [name, value] : frame.attributes) header.insert(name, Imf::StringAttribute(value));
    Imf::StdOSStream bytes;
    {
        Imf::OutputFile file(bytes, header);
        file.setFrameBuffer(buffer);
        file.writePixels(frame.height);
    }
    return bytes.str();
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

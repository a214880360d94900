#include "host/io/atomic_file.hpp"
#include "host/io/file_roles.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <algorithm>
#include <fmt/format.h>
#include <thread>

namespace clvr {

namespace {

constexpr int largest_exr_side = 65536;
constexpr std::size_t largest_pixels = std::size_t{1} << 28; // 16384 x 16384, the largest picture that clvr renders

/// Points OpenEXR at planar float32 storage of `rows` lines from line `first_row` of the data window.
Imf::Slice plane(float* values, const Imath::Box2i& window, int first_row, int rows) {
    const int width = window.max.x - window.min.x + 1;
    return Imf::Slice::Make(Imf::FLOAT, values, Imath::V2i(window.min.x, first_row), width, rows, sizeof(float), sizeof(float) * width);
}

void check_header(const Imf::Header& header) {
    const Imath::Box2i window = header.dataWindow();
    const long long width = static_cast<long long>(window.max.x) - window.min.x + 1,
                    height = static_cast<long long>(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > largest_exr_side || height > largest_exr_side ||
        static_cast<std::size_t>(width * height) > largest_pixels)
        throw Error(ErrorKind::input, fmt::format("has a data window of {} x {} pixels; expected 1 x 1 to 16384 x 16384", width, height));
    if (header.hasType() && Imf::isDeepData(header.type())) throw Error(ErrorKind::input, "is a deep image; flatten it to scanlines first");
    if (header.channels().begin() == header.channels().end()) throw Error(ErrorKind::input, "has no channels");
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            throw Error(ErrorKind::input, fmt::format("channel {} is subsampled; store every channel at full size", c.name()));
}

/// Reads the last line alone, so that a header that promises more pixels than the file holds fails before they are allocated.
void probe_last_line(Imf::InputFile& file, const Imath::Box2i& window) {
    const auto& channels = file.header().channels();
    std::vector<float> line(static_cast<std::size_t>(window.max.x - window.min.x + 1));
    Imf::FrameBuffer buffer;
    for (auto c = channels.begin(); c != channels.end(); ++c) buffer.insert(c.name(), plane(line.data(), window, window.max.y, 1));
    file.setFrameBuffer(buffer);
    file.readPixels(window.max.y);
}

/// OpenEXR packs and unpacks lines on all cores; by itself it takes one.
void use_all_cores() {
    [[maybe_unused]] static const bool once = [] {
        Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency()));
        return true;
    }();
}

Frame read_all(const std::string& path) {
    use_all_cores();
    Imf::InputFile file(path.c_str());
    const Imf::Header& header = file.header();
    check_header(header);
    const Imath::Box2i window = header.dataWindow();
    probe_last_line(file, window);
    Frame frame;
    frame.width = window.max.x - window.min.x + 1;
    frame.height = window.max.y - window.min.y + 1;
    Imf::FrameBuffer buffer;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        buffer.insert(c.name(), plane(frame.channel(c.name()).data(), window, window.min.y, frame.height));
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    for (auto a = header.begin(); a != header.end(); ++a)
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()); text && std::string(a.name()) != "type")
            frame.attributes[a.name()] = text->value();
    return frame;
}

std::string encode(const Frame& frame) {
    use_all_cores();
    Imf::Header header(frame.width, frame.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer buffer;
    for (const auto& [name, values] : frame.channels) {
        if (values.size() != frame.pixels())
            throw Error(ErrorKind::internal,
                        fmt::format("channel {} has {} values for {} x {} pixels", name, values.size(), frame.width, frame.height));
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
        buffer.insert(name, plane(const_cast<float*>(values.data()), header.dataWindow(), 0, frame.height)); // only read from
    }
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

Frame read_exr(const std::string& path) {
    will_read(path);
    check_readable(path);
    try {
        return read_all(path);
    } catch (const Error& e) {
        throw Error(e.kind(), e.what(), path);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::memory, "its pixels do not fit into the memory of this machine", path);
    } catch (const std::exception& e) {
        std::string why = e.what();
        std::replace(why.begin(), why.end(), '\n', ' ');
        throw Error(ErrorKind::input, fmt::format("is no complete OpenEXR image: {}", why), path);
    }
}

} // namespace clvr

#include "host/io/file_roles.hpp"
#include "host/io/picture/exr_library.hpp"
#include "host/io/picture/exr_lines.hpp"
#include "host/io/picture/exr_names.hpp"
#include "host/io/picture/frame_file.hpp"
#include "runtime/error.hpp"
#include "runtime/system/atomic_file.hpp"
#include "runtime/system/parallel.hpp"

#include <ImfChannelList.h>
#include <ImfChromaticities.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfVersion.h>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace clvr {

namespace {

constexpr int largest_exr_side = 65536;
constexpr std::size_t largest_pixels = std::size_t{1} << 28; // 16384 x 16384, the largest picture that clvr renders

[[noreturn]] void refuse_exr(const std::string& what) { throw Error(ErrorKind::input, what); }

Region region_of(const Imath::Box2i& w) { return {w.min.x, w.min.y, w.max.x - w.min.x + 1, w.max.y - w.min.y + 1}; }

void check_size(const char* what, const Imath::Box2i& window) {
    const long long width = static_cast<long long>(window.max.x) - window.min.x + 1,
                    height = static_cast<long long>(window.max.y) - window.min.y + 1;
    if (width < 1 || height < 1 || width > largest_exr_side || height > largest_exr_side ||
        static_cast<std::size_t>(width * height) > largest_pixels)
        refuse_exr(fmt::format("has a {} of {} x {} pixels; expected 1 x 1 to 16384 x 16384", what, width, height));
}

bool is_deep(const Imf::Header& header) { return header.hasType() && Imf::isDeepData(header.type()); }

/// A part's channels that become the frame's, as (theirs, the frame's) ...
using ChannelNames = std::vector<std::pair<std::string, std::string>>;

bool is_chroma(const Imf::ChannelList& channels) {
    return channels.findChannel("Y") && channels.findChannel("RY") && channels.findChannel("BY");
}

/// ... and whether they are luminance and chroma, which are read by themselves.
struct Part {
    int number = 0;
    ChannelNames names;
    bool chroma = false;
};

void check_header(const Imf::Header& header, const ChannelNames& names) {
    for (const auto& [theirs, ours] : names) {
        const Imf::Channel& channel = header.channels()[theirs.c_str()];
        if (channel.xSampling != 1 || channel.ySampling != 1)
            refuse_exr(fmt::format("channel {} is subsampled; store every channel at full size", theirs));
    }
}

/// Points OpenEXR at planar float32 storage of `rows` lines from line `first_row` of a window.
Imf::Slice plane(float* values, const Imath::Box2i& window, int first_row, int rows) {
    const int width = window.max.x - window.min.x + 1;
    return Imf::Slice::Make(Imf::FLOAT, values, Imath::V2i(window.min.x, first_row), width, rows, sizeof(float), sizeof(float) * width);
}

/// Reads the last line alone, so that a header that promises more pixels than the file holds fails before they are allocated.
void probe_last_line(Imf::InputPart& part, const ChannelNames& names) {
    const Imath::Box2i window = part.header().dataWindow();
    std::vector<float> line(static_cast<std::size_t>(window.max.x - window.min.x + 1));
    Imf::FrameBuffer buffer;
    for (const auto& [theirs, ours] : names) buffer.insert(theirs, plane(line.data(), window, window.max.y, 1));
    part.setFrameBuffer(buffer);
    part.readPixels(window.max.y);
}

/// R G B A of a file of luminance and chroma (subsampled or not), as half floats, which such files hold.
void read_chroma(const std::string& path, Frame& frame) {
    Imf::RgbaInputFile file(path.c_str());
    const Imath::Box2i window = file.dataWindow();
    std::vector<Imf::Rgba> line(static_cast<std::size_t>(frame.width));
    file.setFrameBuffer(line.data() - window.min.x, 1, 0); // every line into the same one
    file.readPixels(window.max.y);                         // before the frame is allocated
    std::vector<float>*r = &frame.channel("R"), *g = &frame.channel("G"), *b = &frame.channel("B");
    std::vector<float>* a = file.channels() & Imf::WRITE_A ? &frame.channel("A") : nullptr;
    for (int y = 0; y < frame.height; ++y) {
        file.readPixels(window.min.y + y);
        for (int x = 0; x < frame.width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * frame.width + x;
            const Imf::Rgba& p = line[static_cast<std::size_t>(x)];
            (*r)[i] = p.r, (*g)[i] = p.g, (*b)[i] = p.b;
            if (a) (*a)[i] = p.a;
        }
    }
}

/// Attributes that describe the file's own storage, and those that no longer hold for a frame of one part and view.
bool is_storage(const std::string& name) {
    static const std::set<std::string> names{"channels",
                                             "compression",
                                             "dataWindow",
                                             "displayWindow",
                                             "lineOrder",
                                             "pixelAspectRatio",
                                             "type",
                                             "name",
                                             "chunkCount",
                                             "tiles",
                                             "version",
                                             "preview",
                                             "view",
                                             "multiView",
                                             "maxSamplesPerPixel",
                                             "deepImageState",
                                             "dwaCompressionLevel"};
    return names.count(name) != 0;
}

void add_attributes(const Imf::Header& header, Frame& frame) {
    for (auto a = header.begin(); a != header.end(); ++a) {
        const std::string name = a.name();
        if (is_storage(name)) continue;
        if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute())) {
            frame.attributes.insert({name, text->value()});
        } else {
            Imf::StdOSStream bytes;
            a.attribute().writeValueTo(bytes, Imf::EXR_VERSION);
            frame.further.insert({name, {a.attribute().typeName(), bytes.str()}});
        }
    }
}

/// Notes that colours of other primaries are not converted.
void note_primaries(const Imf::Header& header, Frame& frame) {
    if (!Imf::hasChromaticities(header)) return;
    const Imf::Chromaticities theirs = Imf::chromaticities(header), srgb;
    const auto apart = [](const Imath::V2f& a, const Imath::V2f& b) { return !((a - b).length() < 2e-3f); };
    if (apart(theirs.red, srgb.red) || apart(theirs.green, srgb.green) || apart(theirs.blue, srgb.blue) || apart(theirs.white, srgb.white))
        frame.notes.push_back(
            fmt::format("its colours have other primaries than sRGB (chromaticities, red {:.3f} {:.3f}): taken as they are", theirs.red.x,
                        theirs.red.y));
}

/// Y alone is a grey picture.
void spread_luminance(Frame& frame) {
    if (!frame.has("Y") || frame.has("R") || frame.has("G") || frame.has("B") || frame.has("X") || frame.has("Z")) return;
    for (const char* c : {"R", "G", "B"}) frame.channels[c] = frame.at("Y");
    frame.channels.erase("Y");
    frame.notes.push_back("is grey: its channel Y is taken as R, G and B");
}

/// The parts from which the frame takes channels.
std::vector<Part> chosen_parts(const Imf::MultiPartInputFile& file, Frame& frame) {
    std::vector<ExrPart> parts;
    std::vector<std::string> views;
    for (int p = 0; p < file.parts(); ++p) {
        const Imf::Header& header = file.header(p);
        ExrPart part;
        if (header.hasName()) part.name = header.name();
        if (header.hasView()) part.view = header.view();
        part.deep = is_deep(header);
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c) part.channels.emplace_back(c.name());
        if (file.parts() == 1 && Imf::hasMultiView(header)) views = Imf::multiView(header);
        parts.push_back(part);
    }
    if (std::all_of(parts.begin(), parts.end(), [](const ExrPart& p) { return p.deep; }))
        refuse_exr("is a deep image; flatten it to scanlines first");
    ExrNames names = frame_names(parts, views);
    frame.notes = std::move(names.notes);
    std::vector<Part> chosen;
    for (int p = 0; p < file.parts(); ++p) {
        Part part{p, {}, is_chroma(file.header(p).channels())};
        for (std::size_t c = 0; c < parts[static_cast<std::size_t>(p)].channels.size(); ++c) {
            const std::string &theirs = parts[static_cast<std::size_t>(p)].channels[c], &ours = names.parts[static_cast<std::size_t>(p)][c];
            const bool of_chroma = part.chroma && (theirs == "Y" || theirs == "RY" || theirs == "BY" || theirs == "A");
            if (!ours.empty() && !of_chroma) part.names.emplace_back(theirs, ours);
        }
        if (part.chroma && file.parts() > 1) refuse_exr("has a part of luminance and chroma (Y RY BY); store R G B, or that part alone");
        if (part.chroma) frame.notes.push_back("is luminance and chroma (Y RY BY): read as R G B of half precision");
        if (!part.names.empty() || part.chroma) chosen.push_back(part);
    }
    if (chosen.empty()) refuse_exr("has no channels");
    return chosen;
}

/// Size and place of the frame: the box around the data windows of its parts.
void set_windows(const Imf::MultiPartInputFile& file, const std::vector<Part>& parts, Frame& frame) {
    Imath::Box2i all;
    std::size_t pixels = 0;
    bool differ = false;
    for (const Part& part : parts) {
        const Imath::Box2i window = file.header(part.number).dataWindow();
        check_size("data window", window);
        pixels += region_of(window).pixels();
        differ = differ || (!all.isEmpty() && window != all);
        all.extendBy(window);
    }
    check_size("data window of all parts together", all);
    const Region reached = region_of(all);
    if (reached.pixels() / 64 > pixels) refuse_exr("has parts that lie far from one another: their windows together are mostly empty");
    if (differ) frame.notes.push_back("has parts with different data windows: joined, with 0 where a part has no pixels");
    frame.x = reached.x, frame.y = reached.y, frame.width = reached.width, frame.height = reached.height;
    const Imf::Header& first = file.header(parts.front().number);
    if (const Region shown = region_of(first.displayWindow()); shown != reached) frame.display = shown;
    frame.pixel_aspect = first.pixelAspectRatio();
}

/// How many lines a block has of a part that read_lines() takes: lines at full size, not compressed or by ZIP or ZIPS; else 0.
int block_lines(const Imf::Header& header) {
    if (header.hasType() && header.type() != Imf::SCANLINEIMAGE) return 0;
    if (header.hasTileDescription()) return 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1) return 0;
    const Imf::Compression compression = header.compression();
    if (compression == Imf::ZIP_COMPRESSION) return exr_block_lines;
    return compression == Imf::ZIPS_COMPRESSION || compression == Imf::NO_COMPRESSION ? 1 : 0;
}

/// Reads the channels of a part into the frame, whose window is `all`.
void read_part(Imf::InputPart& part, const ChannelNames& names, const Imath::Box2i& all, Frame& frame) {
    const Imf::Header& header = part.header();
    const Imath::Box2i window = header.dataWindow();
    std::map<std::string, float*> planes; // by their names, from the first pixel of the frame
    for (const auto& [theirs, ours] : names) frame.channels[ours];
    for_each_index(names.size(), [&](std::size_t c) { frame.channels.at(names[c].second).resize(frame.pixels()); });
    for (const auto& [theirs, ours] : names) planes[theirs] = frame.channel(ours).data();
    if (const int lines = block_lines(header)) {
        StoredLines stored{
            window.max.x - window.min.x + 1, window.max.y - window.min.y + 1, lines, static_cast<std::size_t>(frame.width), {}};
        const std::ptrdiff_t first = static_cast<std::ptrdiff_t>(window.min.y - frame.y) * frame.width + window.min.x - frame.x;
        for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
            const Imf::PixelType type = c.channel().type;
            const auto plane = planes.find(c.name());
            stored.channels.push_back({type == Imf::HALF    ? StoredChannel::Type::half
                                       : type == Imf::FLOAT ? StoredChannel::Type::float32
                                                            : StoredChannel::Type::uint32,
                                       plane == planes.end() ? nullptr : plane->second + first});
        }
        read_lines(stored, [&](int line) {
            const char* bytes = nullptr;
            int size = 0;
            part.rawPixelData(window.min.y + line, bytes, size);
            return std::string(bytes, static_cast<std::size_t>(size));
        });
        return;
    }
    Imf::FrameBuffer buffer;
    for (const auto& [name, values] : planes) buffer.insert(name, plane(values, all, frame.y, frame.height));
    part.setFrameBuffer(buffer);
    part.readPixels(window.min.y, window.max.y);
}

/// `values`: or leave the channels empty.
Frame read_all(const std::string& path, bool values) {
    use_all_cores();
    check_attribute_sizes(path);
    Imf::MultiPartInputFile file(path.c_str());
    Frame frame;
    const std::vector<Part> parts = chosen_parts(file, frame);
    set_windows(file, parts, frame);
    const Imath::Box2i all({frame.x, frame.y}, {frame.x + frame.width - 1, frame.y + frame.height - 1});
    for (const Part& chosen : parts) {
        Imf::InputPart part(file, chosen.number);
        const Imf::Header& header = part.header();
        check_header(header, chosen.names);
        if (!chosen.names.empty() && values) {
            probe_last_line(part, chosen.names);
            read_part(part, chosen.names, all, frame);
        }
        for (const auto& [theirs, ours] : chosen.names) frame.channels[ours];
        add_attributes(header, frame);
    }
    if (parts.front().chroma && values) read_chroma(path, frame);
    note_primaries(file.header(parts.front().number), frame);
    spread_luminance(frame);
    return frame;
}

Frame read_named(const std::string& path, bool values) {
    will_read(path);
    check_readable(path);
    try {
        return read_all(path, values);
    } catch (const Error& e) {
        throw Error(e.kind(), e.what(), path);
    } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::host_memory, "its pixels do not fit into the memory of this machine", path);
    } catch (const std::exception& e) {
        std::string why = e.what();
        std::replace(why.begin(), why.end(), '\n', ' ');
        if (const std::size_t prefix = why.find("\". "); prefix != why.npos) why.erase(0, prefix + 3); // Cannot read image file "PATH".
        throw Error(ErrorKind::input, fmt::format("is no complete OpenEXR image: {}", why), path);
    }
}

} // namespace

Frame read_exr(const std::string& path) { return read_named(path, true); }

Frame exr_outline(const std::string& path) { return read_named(path, false); }

} // namespace clvr

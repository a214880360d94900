// OpenEXR files as other programs write them: parts, windows, views.
#pragma once
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>

#include <string>
#include <vector>

namespace clvr::test {

/// A part with float channels; channel c has value(c, x, y) = 100 c + 10 (y - min.y) + (x - min.x) in its data window.
struct FloatPart {
    std::string name, view;
    std::vector<std::string> channels;
    Imath::Box2i data{{0, 0}, {3, 2}};
    float first = 0; ///< added to all values
};

inline float part_value(const FloatPart& part, std::size_t channel, int x, int y) {
    return part.first + static_cast<float>(100 * static_cast<int>(channel) + 10 * y + x);
}

/// Writes parts of scanlines. `display`: of all.
inline void write_parts(const std::string& path, const std::vector<FloatPart>& parts, const Imath::Box2i& display) {
    std::vector<Imf::Header> headers;
    for (const FloatPart& part : parts) {
        Imf::Header header(display, part.data);
        header.setName(part.name);
        header.setType(Imf::SCANLINEIMAGE);
        if (!part.view.empty()) header.setView(part.view);
        for (const auto& channel : part.channels) header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
        headers.push_back(header);
    }
    Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const Imath::Box2i& data = parts[p].data;
        const int width = data.max.x - data.min.x + 1, height = data.max.y - data.min.y + 1;
        std::vector<std::vector<float>> planes;
        for (std::size_t c = 0; c < parts[p].channels.size(); ++c) {
            planes.emplace_back();
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) planes.back().push_back(part_value(parts[p], c, x, y));
        }
        Imf::FrameBuffer buffer;
        for (std::size_t c = 0; c < planes.size(); ++c)
            buffer.insert(parts[p].channels[c], Imf::Slice::Make(Imf::FLOAT, planes[c].data(), data));
        Imf::OutputPart out(file, static_cast<int>(p));
        out.setFrameBuffer(buffer);
        out.writePixels(height);
    }
}

} // namespace clvr::test

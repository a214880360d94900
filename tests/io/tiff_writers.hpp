// Small TIFF and PNG files of every kind, tag by tag.
#pragma once
#include "tests/io/volume_writers.hpp"

#include <map>
#include <png.h>

namespace clvr::test {

/// An entry of a TIFF directory: its values as bytes in the file's order.
struct TiffTag {
    std::uint16_t type = 3;
    std::uint32_t count = 1;
    std::string bytes;
};

/// TIFF files in either byte order, from tags and blocks of pixels.
class TiffWriter {
public:
    explicit TiffWriter(bool big = false) : big_(big), file_(big ? std::string("MM\0*\0\0\0\0", 8) : std::string("II*\0\0\0\0\0", 8)) {}

    TiffTag words(const std::vector<std::uint16_t>& v) const { return {3, static_cast<std::uint32_t>(v.size()), bytes_of(v, big_)}; }
    TiffTag longs(const std::vector<std::uint32_t>& v) const { return {4, static_cast<std::uint32_t>(v.size()), bytes_of(v, big_)}; }
    TiffTag ratio(std::uint32_t above, std::uint32_t below) const {
        return {5, 1, bytes_of(std::vector<std::uint32_t>{above, below}, big_)};
    }
    TiffTag text(const std::string& s) const { return {2, static_cast<std::uint32_t>(s.size() + 1), s + '\0'}; }
    TiffTag bytes(const std::string& s) const { return {1, static_cast<std::uint32_t>(s.size()), s}; }
    template <class T>
    std::string pixels(const std::vector<T>& v) const {
        return bytes_of(v, big_);
    }

    /// The tags of a grey page; others go on top.
    std::map<std::uint16_t, TiffTag> grey(std::uint32_t width, std::uint32_t height, std::uint16_t bits = 16,
                                          std::uint16_t format = 1) const {
        return {{256, longs({width})}, {257, longs({height})}, {258, words({bits})},   {259, words({1})},
                {262, words({1})},     {277, words({1})},      {278, longs({height})}, {339, words({format})}};
    }
    /// Where the next byte comes to lie.
    std::uint32_t end() const { return static_cast<std::uint32_t>(file_.size()); }
    /// Appends bytes that no directory needs to know.
    std::uint32_t append(const std::string& bytes) {
        const std::uint32_t at = end();
        file_ += bytes;
        return at;
    }
    /// A page of the given tags and blocks (strips, or tiles where there is a tile width).
    void page(std::map<std::uint16_t, TiffTag> tags, const std::vector<std::string>& blocks) {
        std::vector<std::uint32_t> offsets, counts;
        for (const std::string& b : blocks) {
            counts.push_back(static_cast<std::uint32_t>(b.size()));
            offsets.push_back(append(b));
        }
        const bool tiled = tags.count(322) > 0;
        if (tiled) tags.erase(278);
        tags[tiled ? 324 : 273] = longs(offsets);
        tags[tiled ? 325 : 279] = longs(counts);
        for (auto& [tag, entry] : tags)
            if (entry.bytes.size() > 4)
                entry.bytes = number(append(entry.bytes), big_);
            else
                entry.bytes.resize(4);
        file_.resize((file_.size() + 1) / 2 * 2);
        file_.replace(link_, 4, number(end(), big_));
        file_ += number(static_cast<std::uint16_t>(tags.size()), big_);
        for (const auto& [tag, entry] : tags)
            file_ += number(tag, big_) + number(entry.type, big_) + number(entry.count, big_) + entry.bytes;
        link_ = file_.size();
        file_ += number(std::uint32_t{0}, big_);
    }
    const std::string& file() const { return file_; }

private:
    bool big_;
    std::string file_;
    std::size_t link_ = 4;
};

/// Values 3 i - 100 as 16 bits: what most of these files hold.
inline std::vector<std::int16_t> ramp(std::size_t n) {
    std::vector<std::int16_t> v(n);
    for (std::size_t i = 0; i < n; ++i) v[i] = static_cast<std::int16_t>(3 * static_cast<int>(i) - 100);
    return v;
}

/// `pages` pages of 6 x 7 signed 16-bit values, on from the ramp; `description` on the first, `resolution` (pixels a unit) on all.
inline std::string described_tiff(std::size_t pages, const std::string& description, std::array<std::uint32_t, 2> resolution = {1, 1},
                                  bool big = false) {
    TiffWriter w(big);
    const auto all = ramp(42 * pages);
    for (std::size_t i = 0; i < pages; ++i) {
        auto tags = w.grey(6, 7, 16, 2);
        if (i == 0 && !description.empty()) tags[270] = w.text(description);
        tags[282] = tags[283] = w.ratio(resolution[0], resolution[1]);
        tags[296] = w.words({1});
        w.page(tags, {w.pixels(std::vector<std::int16_t>(all.begin() + 42 * i, all.begin() + 42 * (i + 1)))});
    }
    return w.file();
}

/// One page with a directory, and the pixels of all slices behind it.
inline std::string one_directory(const Int3& dims, const std::vector<std::int16_t>& voxels, const std::string& description, bool big) {
    TiffWriter w(big);
    auto tags = w.grey(static_cast<std::uint32_t>(dims[0]), static_cast<std::uint32_t>(dims[1]), 16, 2);
    tags[270] = w.text(description);
    const std::string all = w.pixels(voxels);
    w.page(tags, {all.substr(0, all.size() / static_cast<std::size_t>(dims[2]))});
    std::string file = w.file();
    const std::string entry = number(std::uint16_t{273}, big) + number(std::uint16_t{4}, big) + number(std::uint32_t{1}, big);
    file.replace(file.rfind(entry) + entry.size(), 4, number(static_cast<std::uint32_t>(file.size()), big)); // not before it
    return file + all;
}

/// One page of ImageDepth slices in tiles of 16 x 16 x 2, as they are or deflated.
inline std::string deep_tiff(const Int3& dims, const std::vector<std::int16_t>& voxels, bool packed = false, bool big = false) {
    TiffWriter w(big);
    constexpr int edge = 16, deep = 2;
    std::vector<std::string> tiles;
    for (int z = 0; z < dims[2]; z += deep)
        for (int y = 0; y < dims[1]; y += edge)
            for (int x = 0; x < dims[0]; x += edge) {
                std::vector<std::int16_t> tile(edge * edge * deep);
                for (int k = 0; k < deep && z + k < dims[2]; ++k)
                    for (int j = 0; j < edge && y + j < dims[1]; ++j)
                        for (int i = 0; i < edge && x + i < dims[0]; ++i)
                            tile[static_cast<std::size_t>((k * edge + j) * edge + i)] =
                                voxels[(static_cast<std::size_t>(z + k) * static_cast<std::size_t>(dims[1]) +
                                        static_cast<std::size_t>(y + j)) *
                                           static_cast<std::size_t>(dims[0]) +
                                       static_cast<std::size_t>(x + i)];
                tiles.push_back(packed ? deflated(w.pixels(tile), false) : w.pixels(tile));
            }
    auto tags = w.grey(static_cast<std::uint32_t>(dims[0]), static_cast<std::uint32_t>(dims[1]), 16, 2);
    tags[259] = w.words({static_cast<std::uint16_t>(packed ? 8 : 1)});
    tags[322] = tags[323] = w.words({edge});
    tags[32997] = w.longs({static_cast<std::uint32_t>(dims[2])});
    tags[32998] = w.longs({deep});
    w.page(tags, tiles);
    return w.file();
}

/// OME-XML around one `Pixels` element's attributes and children.
inline std::string ome_xml(const std::string& pixels, const std::string& inside = "<TiffData/>", const std::string& more = "") {
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\" "
        "UUID=\"urn:uuid:1\"><Image ID=\"Image:0\" Name=\"first\"><Pixels ID=\"Pixels:0\" Type=\"int16\" {}>{}</Pixels></Image>"
        "{}</OME>",
        pixels, inside, more);
}

/// A PNG with rows of whole bytes; `colour` is libpng's colour type. A palette is three bytes a colour.
inline std::string png_file(std::uint32_t width, std::uint32_t height, int bits, int colour, const std::string& rows,
                            const std::string& palette = {}, bool interlaced = false) {
    std::string file;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_set_write_fn(
        png, &file,
        [](png_structp p, png_bytep data, png_size_t n) {
            static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(data), n);
        },
        nullptr);
    png_set_IHDR(png, info, width, height, bits, colour, interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!palette.empty()) png_set_PLTE(png, info, reinterpret_cast<png_const_colorp>(palette.data()), static_cast<int>(palette.size() / 3));
    png_set_pHYs(png, info, 3937, 3937, PNG_RESOLUTION_METER); // 100 dpi: print, not specimens
    png_write_info(png, info);
    const std::size_t row_bytes = rows.size() / height;
    std::vector<png_bytep> pointers(height);
    for (std::size_t y = 0; y < height; ++y) pointers[y] = reinterpret_cast<png_bytep>(const_cast<char*>(rows.data())) + y * row_bytes;
    png_write_image(png, pointers.data());
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return file;
}

} // namespace clvr::test

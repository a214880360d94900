// JPEG pictures of grey values: one slice, or a folder of them.
#include "host/io/volume/readers.hpp"
#include "host/io/volume/slice_stack.hpp"

#include <filesystem>
#include <turbojpeg.h>

namespace clvr {

namespace {

class JpegSlice : public SliceImage {
public:
    explicit JpegSlice(const std::string& path) : path_(path), handle_(tjInitDecompress(), &tjDestroy) {
        if (!handle_) throw std::bad_alloc();
        const auto bytes = std::filesystem::file_size(path);
        constexpr std::uint64_t most = std::uint64_t{1} << 31, greatest_ratio = 1032;
        if (bytes > most) bad_file(path, "has {} bytes: expected a JPEG of at most {}", bytes, most);
        packed_ = read_head(path, bytes);
        int w = 0, h = 0, subsampling = 0, colours = 0;
        if (tjDecompressHeader3(handle_.get(), data(), packed_.size(), &w, &h, &subsampling, &colours) != 0) fail();
        if (colours != TJCS_GRAY && colours != TJCS_YCbCr && colours != TJCS_RGB)
            bad_file(path, "its pixels have four colours: clvr renders scalar volumes, save it as greyscale");
        if (w < 1 || h < 1) bad_file(path, "has no size");
        check_capacity(static_cast<std::uint64_t>(w) * static_cast<std::uint64_t>(h), bytes * greatest_ratio, path);
        grey_of_colour = colours != TJCS_GRAY;
        width = static_cast<std::uint32_t>(w), height = static_cast<std::uint32_t>(h);
        form = fmt::format("{} x {} 8 bits", width, height);
    }

    void decode(unsigned char* to) override {
        if (!grey_of_colour) return decode_as(TJPF_GRAY, to);
        std::vector<unsigned char> rgb(std::size_t{3} * width * height);
        decode_as(TJPF_RGB, rgb.data());
        for (std::size_t i = 0, n = std::size_t{width} * height; i < n; ++i) {
            if (rgb[3 * i] != rgb[3 * i + 1] || rgb[3 * i] != rgb[3 * i + 2])
                bad_file(path_, "pixel {}, {} is coloured: clvr renders scalar volumes, save it as greyscale", i % width, i / width);
            to[i] = rgb[3 * i];
        }
    }

private:
    const unsigned char* data() const { return reinterpret_cast<const unsigned char*>(packed_.data()); }
    void decode_as(int format, unsigned char* to) {
        constexpr int flags = TJFLAG_ACCURATEDCT | TJFLAG_LIMITSCANS;
        if (tjDecompress2(handle_.get(), data(), packed_.size(), to, static_cast<int>(width), 0, static_cast<int>(height), format, flags) !=
            0)
            fail();
    }
    [[noreturn]] void fail() { bad_file(path_, "does not decode ({}): the file is truncated or damaged", tjGetErrorStr2(handle_.get())); }

    std::string path_, packed_;
    std::unique_ptr<void, int (*)(tjhandle)> handle_;
};

} // namespace

Voxels read_jpeg_slices(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options) {
    Voxels v = read_pictures(path, files, options, "JPEG", [](const std::string& name) { return std::make_unique<JpegSlice>(name); });
    v.decisions.push_back("JPEG is lossy: values are near those that were saved");
    return v;
}

} // namespace clvr

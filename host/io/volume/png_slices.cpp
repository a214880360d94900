// PNG pictures of grey values: one slice, or a folder of them. Values are taken as stored: no gamma, no colour management.
#include "host/io/volume/readers.hpp"
#include "host/io/volume/slice_stack.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <png.h>

namespace clvr {

namespace {

void complain(png_structp png, png_const_charp text) {
    *static_cast<std::string*>(png_get_error_ptr(png)) = text;
    png_longjmp(png, 1);
}
void ignore(png_structp, png_const_charp) {}

/// The two steps that libpng may leave by longjmp: nothing in them has a destructor.
bool read_header(png_structp png, png_infop info, std::FILE* file) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_init_io(png, file);
    png_read_info(png, info);
    return true;
}
bool read_rows(png_structp png, png_infop info, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows);
    png_read_end(png, info);
    return true;
}

class PngSlice : public SliceImage {
public:
    explicit PngSlice(const std::string& path)
        : path_(path), file_(std::fopen(path.c_str(), "rb"), &std::fclose),
          png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint_, complain, ignore)),
          info_(png_ ? png_create_info_struct(png_) : nullptr) {
        if (!file_) fail_and_free("cannot be opened");
        if (!png_ || !info_) throw std::bad_alloc();
        png_set_user_limits(png_, 0x7fffffff, 0x7fffffff);
        if (!read_header(png_, info_, file_.get())) fail_and_free("is no sound PNG (" + complaint_ + ")");
        width = png_get_image_width(png_, info_), height = png_get_image_height(png_, info_);
        bits_ = png_get_bit_depth(png_, info_), colour_ = png_get_color_type(png_, info_);
        constexpr std::uint64_t greatest_ratio = 1032; // of deflate
        if ((std::uint64_t{width} * png_get_channels(png_, info_) * bits_ + 7) / 8 * height >
            std::filesystem::file_size(path) * greatest_ratio)
            fail_and_free(fmt::format("is too short for {} x {} pixels: it is truncated or damaged", width, height));
        has_alpha = (colour_ & PNG_COLOR_MASK_ALPHA) != 0;
        grey_of_colour = colour_ == PNG_COLOR_TYPE_RGB || colour_ == PNG_COLOR_TYPE_RGB_ALPHA; // decode refuses others
        type = bits_ == 16 ? SampleType::u16 : SampleType::u8;
        form = fmt::format("{} x {} {} bits", width, height, bits_);
        if (colour_ == PNG_COLOR_TYPE_PALETTE) {
            form = fmt::format("{} x {} 8 bits", width, height);
            if (!take_grey_palette()) fail_and_free("the pixels are numbers of colours in a table: save it as greyscale");
        }
    }
    ~PngSlice() override { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngSlice(const PngSlice&) = delete;
    PngSlice& operator=(const PngSlice&) = delete;

    void decode(unsigned char* to) override {
        const std::size_t channels = png_get_channels(png_, info_), size = bits_ == 16 ? 2 : 1;
        if (bits_ < 8) png_set_packing(png_);
        if (bits_ == 16 && must_swap(true)) png_set_swap(png_);
        png_set_interlace_handling(png_);
        const std::size_t row_bytes = std::size_t{width} * channels * size;
        std::vector<unsigned char> scratch(channels == 1 ? 0 : row_bytes * height);
        std::vector<png_bytep> rows(height);
        for (std::size_t y = 0; y < height; ++y) rows[y] = (channels == 1 ? to : scratch.data()) + y * row_bytes;
        if (!read_rows(png_, info_, rows.data())) bad_file(path_, "does not decode ({}): the file is truncated or damaged", complaint_);
        if (channels > 1) take_first(scratch.data(), channels, size, to);
        if (colour_ == PNG_COLOR_TYPE_PALETTE)
            std::transform(to, to + std::size_t{width} * height, to, [this](unsigned char i) { return grey_[i]; });
    }

private:
    /// The constructor's: no destructor runs behind it.
    [[noreturn]] void fail_and_free(const std::string& text) {
        png_destroy_read_struct(&png_, &info_, nullptr);
        bad_file(path_, "{}", text);
    }
    bool take_grey_palette() {
        png_colorp palette = nullptr;
        int n = 0;
        if (!png_get_PLTE(png_, info_, &palette, &n)) return false;
        for (int i = 0; i < n; ++i) {
            if (palette[i].red != palette[i].green || palette[i].red != palette[i].blue) return false;
            grey_[static_cast<std::size_t>(i)] = palette[i].red;
        }
        return true;
    }
    /// Grey of pixels with alpha or with three equal colours.
    void take_first(const unsigned char* from, std::size_t channels, std::size_t size, unsigned char* to) {
        for (std::size_t i = 0, n = std::size_t{width} * height; i < n; ++i) {
            const unsigned char* const pixel = from + i * channels * size;
            if (grey_of_colour && !(std::equal(pixel, pixel + size, pixel + size) && std::equal(pixel, pixel + size, pixel + 2 * size)))
                bad_file(path_, "pixel {}, {} is coloured: clvr renders scalar volumes, save it as greyscale", i % width, i / width);
            std::copy(pixel, pixel + size, to + i * size);
        }
    }

    std::string path_, complaint_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::uint32_t bits_ = 8, colour_ = 0;
    std::array<unsigned char, 256> grey_{}; ///< of the palette
};

} // namespace

Voxels read_png_slices(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options) {
    return read_pictures(path, files, options, "PNG", [](const std::string& name) { return std::make_unique<PngSlice>(name); });
}

} // namespace clvr

// The pixels of one TIFF page: what form they have, and how they decode.
#pragma once
#include "host/io/volume/tiff_file.hpp"

namespace clvr {

/// How a page stores its pixels.
struct TiffForm {
    std::uint32_t width = 0, height = 0;
    std::uint32_t depth = 1;         ///< slices within the page (ImageDepth)
    std::uint16_t bits = 8;          ///< of a sample as stored, 1 to 64
    std::uint16_t sample_format = 1; ///< TIFF's SampleFormat
    std::uint16_t samples = 1;       ///< per pixel
    bool separate = false;           ///< the samples of a pixel stand in planes of their own
    std::uint16_t photometric = 1;
    SampleType type = SampleType::u8; ///< what a sample decodes to

    bool is_alike(const TiffForm& other) const;
    std::uint64_t pixels() const { return std::uint64_t{width} * height * depth; }
    /// Stored bytes of the row of one piece (strip or page), of all samples that stand together.
    std::uint64_t row_bytes(std::uint64_t columns) const { return (columns * (separate ? 1 : samples) * bits + 7) / 8; }
};
/// "6 x 7 u16".
std::string form_text(const TiffForm& form);

/// Of the current page. `one_of_colour`: red, green and blue are channels to choose from; `indexed`: the values of a page with a colour
/// table are data. Throws Error{input} for pixels that are no grey values or have a codec or type that clvr does not read.
TiffForm form_of(const TiffFile& file, bool one_of_colour, bool indexed);

/// Throws Error{input} unless the file holds the strips or tiles of the current page, and enough of them for its pixels.
void check_extents(const TiffFile& file, const TiffForm& form);
/// Decodes sample `sample` of the current page to `to`: width x height x depth of form.type in host byte order.
void decode_page(const TiffFile& file, const TiffForm& form, std::uint16_t sample, unsigned char* to);
/// A plane of stored pixels (one sample, no compression, whole bytes) at `offset`, where no directory stands for it. Throws Error{input}
/// where the file ends.
void decode_plain(const TiffFile& file, const TiffForm& form, std::uint64_t offset, unsigned char* to);
/// Whether the current page could be followed by such planes: one uncompressed piece after another, whole bytes, one sample.
bool is_plain(const TiffFile& file, const TiffForm& form);

/// What the user should know of the pixels' form: orientation, white is zero, alpha left out; a line each.
std::vector<std::string> form_notes(const TiffFile& file, const TiffForm& form);

} // namespace clvr

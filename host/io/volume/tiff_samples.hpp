// Samples of any number of bits out of the rows of TIFF strips and tiles.
#pragma once
#include "host/io/volume/tiff_page.hpp"

namespace clvr {

/// What a sample of so many bits in TIFF's SampleFormat decodes to: the next larger type; nothing where clvr does not read it.
std::optional<SampleType> decoded_type(std::uint16_t bits, std::uint16_t sample_format);
/// Whether rows are already samples of form.type, one a pixel.
bool is_stored_as(const TiffForm& form);
/// `columns` samples of number `sample` from one stored row (as libtiff hands it out: whole bytes in host order, other bits from the
/// highest on) to `to`, samples of form.type.
void unpack_samples(const unsigned char* row, const TiffForm& form, std::uint16_t sample, std::size_t columns, unsigned char* to);

} // namespace clvr

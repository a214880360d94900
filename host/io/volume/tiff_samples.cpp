#include "host/io/volume/tiff_samples.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <tiffio.h>

namespace clvr {

namespace {

/// `n` bits from bit `at` on, the highest first.
std::uint64_t bits_at(const unsigned char* row, std::uint64_t at, unsigned n) {
    std::uint64_t value = 0;
    while (n > 0) {
        const unsigned skipped = at % 8, taken = std::min(8 - skipped, n);
        value = value << taken | ((row[at / 8] >> (8 - skipped - taken)) & ((1u << taken) - 1));
        at += taken;
        n -= taken;
    }
    return value;
}

/// An IEEE float of 1 + `exponent` + `mantissa` bits; f32 holds each of its values.
float small_float(std::uint64_t bits, int exponent, int mantissa) {
    const int most = (1 << exponent) - 1, bias = most / 2;
    const auto e = static_cast<int>(bits >> mantissa) & most;
    const auto m = static_cast<double>(bits & ((std::uint64_t{1} << mantissa) - 1)) / static_cast<double>(std::uint64_t{1} << mantissa);
    double value = e == 0 ? std::ldexp(m, 1 - bias) : std::ldexp(1 + m, e - bias);
    if (e == most) value = m == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    return static_cast<float>(bits >> (exponent + mantissa) & 1 ? -value : value);
}

template <class T>
void put(unsigned char* to, T value) {
    std::memcpy(to, &value, sizeof value);
}

/// Stores an integer of `bits` bits as the type of `size` bytes.
void put_integer(unsigned char* to, std::size_t size, std::uint64_t value, unsigned bits, bool is_signed) {
    if (is_signed && bits < 64 && value >> (bits - 1) & 1) value |= ~std::uint64_t{0} << bits;
    if (size == 1) return put(to, static_cast<std::uint8_t>(value));
    if (size == 2) return put(to, static_cast<std::uint16_t>(value));
    put(to, static_cast<std::uint32_t>(value));
}

} // namespace

std::optional<SampleType> decoded_type(std::uint16_t bits, std::uint16_t sample_format) {
    if (sample_format == SAMPLEFORMAT_IEEEFP) {
        if (bits == 16 || bits == 24 || bits == 32) return SampleType::f32;
        return bits == 64 ? std::optional(SampleType::f64) : std::nullopt;
    }
    const bool is_signed = sample_format == SAMPLEFORMAT_INT;
    if ((!is_signed && sample_format != SAMPLEFORMAT_UINT && sample_format != SAMPLEFORMAT_VOID) || bits == 0) return std::nullopt;
    if (bits <= 8) return is_signed ? SampleType::i8 : SampleType::u8;
    if (bits <= 16) return is_signed ? SampleType::i16 : SampleType::u16;
    if (bits <= 32) return is_signed ? SampleType::i32 : SampleType::u32;
    if (bits == 64) return is_signed ? SampleType::i64 : SampleType::u64;
    return std::nullopt;
}

bool is_stored_as(const TiffForm& form) { return (form.samples == 1 || form.separate) && form.bits == 8 * sample_bytes(form.type); }

void unpack_samples(const unsigned char* row, const TiffForm& form, std::uint16_t sample, std::size_t columns, unsigned char* to) {
    const std::size_t size = sample_bytes(form.type), step = form.separate ? 1 : form.samples, first = form.separate ? 0 : sample;
    if (is_stored_as(form)) {
        std::memcpy(to, row, columns * size);
        return;
    }
    const bool is_float = form.sample_format == SAMPLEFORMAT_IEEEFP, is_signed = form.sample_format == SAMPLEFORMAT_INT;
    for (std::size_t i = 0; i < columns; ++i, to += size) {
        const std::size_t at = i * step + first;
        if (form.bits == 8 * size) {
            std::memcpy(to, row + at * size, size);
            continue;
        }
        std::uint64_t value = 0;
        if (form.bits % 8 == 0) { // 16 and 24 bits stand in host byte order
            const std::size_t bytes = form.bits / 8;
            for (std::size_t b = 0; b < bytes; ++b)
                value |= std::uint64_t{row[at * bytes + b]} << 8 * (must_swap(false) ? bytes - 1 - b : b);
        } else {
            value = bits_at(row, at * form.bits, form.bits);
        }
        if (is_float)
            put(to, form.bits == 16 ? small_float(value, 5, 10) : small_float(value, 7, 16));
        else
            put_integer(to, size, value, form.bits, is_signed);
    }
}

} // namespace clvr

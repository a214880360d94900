// The values of one DICOM data set, and of the sequences inside it.
#pragma once
#include "runtime/error.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// A file that belongs to its series but cannot be used, because a value for its place or its voxels is no number, or because pixels are
/// missing. It must not be left out in silence.
class DicomSliceError : public Error {
public:
    using Error::Error;
};

/// group << 16 | element
using DicomTag = std::uint32_t;

/// What the walker kept of a data set or of one item of a sequence.
struct DicomElements {
    std::map<DicomTag, std::string> values; ///< bytes as in the file
    std::map<DicomTag, std::vector<DicomElements>> sequences;
    bool big_endian = false;

    /// The value's bytes; null where the element is absent.
    const std::string* bytes(DicomTag tag) const;
    /// Text without padding; empty where the element is absent.
    std::string text(DicomTag tag) const;
    /// Texts that a backslash separates, each without padding; empty where the element is absent or empty.
    std::vector<std::string> texts(DicomTag tag) const;
    /// Whole numbers of 2 or 4 bytes (US, UL), all of the element; empty where it is absent.
    std::vector<std::uint32_t> words(DicomTag tag, std::size_t bytes_each) const;
    std::optional<int> unsigned_short(DicomTag tag) const;
    /// A binary number of 4 or 8 bytes (FL, FD).
    std::optional<double> real(DicomTag tag) const;
    /// Decimal strings (DS, IS); empty where the element is absent or empty. Throws DicomSliceError naming `name` where one is no number.
    std::vector<double> decimals(DicomTag tag, const char* name, const std::string& path) const;
    /// One of them; throws where there are several, too.
    std::optional<double> decimal(DicomTag tag, const char* name, const std::string& path) const;
    /// The first whole number of a text (IS) that decides nothing but an order; `fallback` where there is none.
    double count(DicomTag tag, double fallback) const;
    /// The first item of a sequence; null where there is none.
    const DicomElements* item(DicomTag sequence) const;
};

} // namespace clvr

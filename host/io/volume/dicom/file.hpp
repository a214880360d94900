// The structure of one DICOM file, walked with every length checked.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clvr {

/// GDCM aborts the process on truncated files (Debian builds it with assertions), so clvr reads the structure itself (DICOM PS3.5) and GDCM
/// decodes nothing but compressed pixels (dicom_pixels.hpp).
struct DicomFile {
    std::map<std::uint32_t, std::string> values; ///< group << 16 | element -> bytes: short values outside sequences, of groups up to 0028
    std::string transfer_syntax;                 ///< UID
    bool big_endian = false;
    bool has_pixels = false, encapsulated = false;
    std::uint64_t pixel_offset = 0, pixel_bytes = 0;                ///< plain pixels; encapsulated ones: see fragments
    std::vector<std::pair<std::uint64_t, std::uint64_t>> fragments; ///< offset, bytes; without the offset table

    /// Text without padding; empty where the element is absent.
    std::string text(std::uint32_t tag) const;
    std::optional<int> unsigned_short(std::uint32_t tag) const;
    /// Decimal strings; empty where the element is absent or holds anything else.
    std::vector<double> numbers(std::uint32_t tag) const;
    double number(std::uint32_t tag, double fallback) const;
};

/// Reads the structure up to the pixels, and that of the pixels. Throws Error{input} where a length leads out of the file or the file is no
/// DICOM.
DicomFile scan_dicom(const std::string& path);

} // namespace clvr

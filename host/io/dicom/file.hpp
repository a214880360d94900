// The structure of one DICOM file, walked with every length checked.
#pragma once
#include "host/io/dicom/elements.hpp"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace clvr {

/// GDCM aborts the process on truncated files (Debian builds it with assertions), so clvr reads the structure itself (DICOM PS3.5) and GDCM
/// decodes nothing but compressed pixels (pixels.hpp).
struct DicomFile {
    /// Short values of groups up to 0028, few long ones, and the sequences that place frames and give them their values.
    DicomElements data;
    std::string transfer_syntax; ///< UID
    bool has_pixels = false, encapsulated = false;
    int float_bits = 0;                                             ///< of float pixels: 32 or 64; 0: whole numbers
    std::uint64_t pixel_offset = 0, pixel_bytes = 0;                ///< plain pixels; encapsulated ones: see fragments
    std::vector<std::pair<std::uint64_t, std::uint64_t>> fragments; ///< offset, bytes; without the offset table
    std::vector<std::uint64_t> frame_offsets; ///< of the offset table: each frame's distance from the first fragment's item; may be empty
    std::uint64_t deflated_from = 0;          ///< offsets count in the inflated data set, which begins here in the file; 0: in the file
};

/// Reads the structure up to the pixels, and that of the pixels. Throws Error{input} where a length leads out of the file or the file is no
/// DICOM.
DicomFile scan_dicom(const std::string& path);

/// The data set of a deflated file (transfer syntax 1.2.840.10008.1.2.1.99) from byte `from` on. Throws Error{input}.
std::string inflated_data_set(const std::string& path, std::uint64_t from);

} // namespace clvr

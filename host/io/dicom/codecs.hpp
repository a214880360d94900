// How DICOM pixels are compressed.
#pragma once
#include "host/io/dicom/file.hpp"

#include <cstdint>
#include <string>

namespace clvr {

/// "JPEG 2000 (transfer syntax 1.2.840.10008.1.2.4.91)".
std::string transfer_syntax_name(const std::string& uid);
/// Throws Error{input} that names the transfer syntax where clvr cannot decode the file's pixels.
void check_transfer_syntax(const DicomFile& file, const std::string& path);
/// The most bytes of pixels that one byte of such compressed data can hold.
std::uint64_t greatest_ratio(const std::string& uid);

} // namespace clvr

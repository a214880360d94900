// The values of a DataArray of VTK's XML files: text, base64 or appended bytes, compressed in blocks or not.
#pragma once
#include "host/io/volume/byte_source.hpp"

#include <memory>
#include <string>

namespace clvr {

enum class VtiCompressor { none, zlib, lz4 };

/// How the values of a file are written.
struct VtiCoding {
    bool big_endian = false;
    std::size_t header_bytes = 4; ///< of each number before the values: 4 or 8
    VtiCompressor compressor = VtiCompressor::none;
};

/// Decodes what `from` holds: numbers of bytes, then blocks or plain bytes. `expected` bytes of values in all; `capacity` bytes are what
/// the file has for them. Throws Error{input} when they can't be there, before anything of that size is allocated, and for damage.
std::unique_ptr<ByteSource> open_vti_values(ByteSource& from, const VtiCoding& coding, std::uint64_t expected, std::uint64_t capacity,
                                            const std::string& path);

} // namespace clvr

#include "host/io/byte_stream.hpp"
#include "host/io/dicom/file.hpp"
#include "host/io/volume/samples.hpp"

#include <array>
#include <zlib.h>

namespace clvr {

std::string inflated_data_set(const std::string& path, std::uint64_t from) {
    constexpr std::size_t most = std::size_t{1} << 31;
    ByteStream stream(path, ByteStream::Coding::plain, from);
    z_stream z{};
    if (inflateInit2(&z, -MAX_WBITS) != Z_OK) throw Error(ErrorKind::internal, "zlib offers no inflate", path);
    std::string all;
    std::array<char, 1 << 16> packed, plain;
    int state = Z_OK;
    while (state == Z_OK) {
        if (z.avail_in == 0) {
            z.avail_in = static_cast<unsigned>(stream.read(packed.data(), packed.size()));
            z.next_in = reinterpret_cast<unsigned char*>(packed.data());
            if (z.avail_in == 0) break;
        }
        z.next_out = reinterpret_cast<unsigned char*>(plain.data());
        z.avail_out = static_cast<unsigned>(plain.size());
        state = inflate(&z, Z_NO_FLUSH);
        all.append(plain.data(), plain.size() - z.avail_out);
        if (all.size() > most) break;
    }
    inflateEnd(&z);
    if (all.size() > most) bad_file(path, "its deflated data set holds more than 2 GiB: save it without compression");
    if (state != Z_STREAM_END) bad_file(path, "its deflated data set ends after {} bytes: the file is truncated or damaged", all.size());
    return all;
}

} // namespace clvr

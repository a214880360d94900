#include "host/io/dicom/codecs.hpp"
#include "host/io/volume/samples.hpp"

#include <map>

namespace clvr {

namespace {

struct Codec {
    const char* name;
    bool decoded;
    std::uint64_t ratio; ///< of a picture of one value
};

const std::map<std::string, Codec> codecs{{"1.2.840.10008.1.2.4.50", {"JPEG baseline", true, 1 << 10}},
                                          {"1.2.840.10008.1.2.4.51", {"JPEG extended", true, 1 << 10}},
                                          {"1.2.840.10008.1.2.4.57", {"JPEG lossless", true, 64}},
                                          {"1.2.840.10008.1.2.4.70", {"JPEG lossless", true, 64}},
                                          {"1.2.840.10008.1.2.4.80", {"JPEG-LS lossless", true, 1 << 18}},
                                          {"1.2.840.10008.1.2.4.81", {"JPEG-LS near-lossless", true, 1 << 18}},
                                          {"1.2.840.10008.1.2.4.90", {"JPEG 2000 lossless", true, 1 << 18}},
                                          {"1.2.840.10008.1.2.4.91", {"JPEG 2000", true, 1 << 18}},
                                          {"1.2.840.10008.1.2.5", {"RLE", true, 128}},
                                          {"1.2.840.10008.1.2.4.92", {"JPEG 2000 of several components, lossless", false, 0}},
                                          {"1.2.840.10008.1.2.4.93", {"JPEG 2000 of several components", false, 0}},
                                          {"1.2.840.10008.1.2.4.94", {"JPIP, pixels on a server", false, 0}},
                                          {"1.2.840.10008.1.2.4.95", {"JPIP, pixels on a server", false, 0}},
                                          {"1.2.840.10008.1.2.4.100", {"MPEG-2 video", false, 0}},
                                          {"1.2.840.10008.1.2.4.101", {"MPEG-2 video", false, 0}},
                                          {"1.2.840.10008.1.2.4.102", {"H.264 video", false, 0}},
                                          {"1.2.840.10008.1.2.4.103", {"H.264 video", false, 0}},
                                          {"1.2.840.10008.1.2.4.104", {"H.264 video", false, 0}},
                                          {"1.2.840.10008.1.2.4.105", {"H.264 video", false, 0}},
                                          {"1.2.840.10008.1.2.4.106", {"H.264 video", false, 0}},
                                          {"1.2.840.10008.1.2.4.107", {"HEVC video", false, 0}},
                                          {"1.2.840.10008.1.2.4.108", {"HEVC video", false, 0}},
                                          {"1.2.840.10008.1.2.4.110", {"JPEG XL lossless", false, 0}},
                                          {"1.2.840.10008.1.2.4.111", {"JPEG XL", false, 0}},
                                          {"1.2.840.10008.1.2.4.112", {"JPEG XL", false, 0}},
                                          {"1.2.840.10008.1.2.4.201", {"high-throughput JPEG 2000 lossless", false, 0}},
                                          {"1.2.840.10008.1.2.4.202", {"high-throughput JPEG 2000 lossless", false, 0}},
                                          {"1.2.840.10008.1.2.4.203", {"high-throughput JPEG 2000", false, 0}},
                                          {"1.2.840.10008.1.2.4.204", {"high-throughput JPEG 2000, pixels on a server", false, 0}},
                                          {"1.2.840.10008.1.2.4.205", {"high-throughput JPEG 2000, pixels on a server", false, 0}},
                                          {"1.2.840.10008.1.2.6.1", {"a file inside a mail", false, 0}},
                                          {"1.2.840.10008.1.2.6.2", {"XML", false, 0}},
                                          {"1.2.840.10008.1.2.8.1", {"deflated frames", false, 0}}};

bool is_plain(const std::string& uid) {
    return uid == "1.2.840.10008.1.2" || uid == "1.2.840.10008.1.2.1" || uid == "1.2.840.10008.1.2.2" || uid == "1.2.840.10008.1.2.1.99";
}

} // namespace

std::string transfer_syntax_name(const std::string& uid) {
    const auto codec = codecs.find(uid);
    return codec == codecs.end() ? fmt::format("transfer syntax {}", uid) : fmt::format("{}, transfer syntax {}", codec->second.name, uid);
}

void check_transfer_syntax(const DicomFile& file, const std::string& path) {
    const auto codec = codecs.find(file.transfer_syntax);
    const bool known =
        file.encapsulated ? codec != codecs.end() && codec->second.decoded : codec != codecs.end() || is_plain(file.transfer_syntax);
    if (!known)
        bad_file(path,
                 "its pixels are stored in a way that is not supported ({}): convert it with another program to explicit little-endian",
                 transfer_syntax_name(file.transfer_syntax));
}

std::uint64_t greatest_ratio(const std::string& uid) {
    const auto codec = codecs.find(uid);
    return codec == codecs.end() ? 1 : codec->second.ratio;
}

} // namespace clvr

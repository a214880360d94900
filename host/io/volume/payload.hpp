// The voxels of formats with a text header: in which files they stand, from where, and how they are encoded.
#pragma once
#include "host/io/volume/samples.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace clvr {

struct Payload {
    enum class Encoding { raw, deflated, bzip2, hex, text };
    std::vector<std::string> files; ///< one after the other; each holds the same share of the samples, encoded by itself
    std::uint64_t offset = 0;       ///< in each file, where the skipping starts
    std::int64_t line_skip = 0;     ///< so many lines are passed over,
    /// then so many bytes (of deflated and bzip2 data: decoded ones). -1 - n, for raw data alone: the voxels end n bytes before the end.
    std::int64_t byte_skip = 0;
    Encoding encoding = Encoding::raw;
    bool big_endian = false;
};

/// An axis beside the three of space (time, channels), of which one index is read.
struct OtherAxis {
    std::int64_t size = 1, index = 0;
    std::int64_t faster = 1; ///< samples of all axes of space that vary faster than this one
};

/// Checks that the voxels are there (byte counts of plain data, checksums of compressed data, numbers counted in text), then reads them:
/// v.dims x other axes (the fastest first) samples of `type` into v, which `describe` has set up. Throws Error{input}.
void read_payload(const Payload& p, SampleType type, const std::vector<OtherAxis>& others, Voxels& v);

} // namespace clvr

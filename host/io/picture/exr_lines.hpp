// Blocks of scan lines as OpenEXR holds them without compression, or with ZIP or ZIPS: packed and unpacked by libdeflate, on all cores.
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace clvr {

/// Lines in a block of ZIP compression.
constexpr int exr_block_lines = 16;

/// Packs a block. Where packing gains nothing its lines are kept as they are, as the format asks. `lines` holds an even number of bytes.
std::string pack_lines(const std::string& lines);

/// A channel as a file holds it, and the plane that takes it.
struct StoredChannel {
    enum class Type { half, float32, uint32 } type = Type::float32;
    float* to = nullptr; ///< of the value at the left of line 0; null: passed over
};
/// Where and how lines are held. Line 0 is the file's first one.
struct StoredLines {
    int width = 0, height = 0, block_lines = 1;
    std::size_t row = 0;                 ///< from one line of a plane to the next [floats]
    std::vector<StoredChannel> channels; ///< in the file's order
};
/// Reads all lines into their planes. `fetch` gives the stored bytes of the block that begins at a line; it is called by one thread at a
/// time, in any order. Throws Error{input} for a damaged block; what `fetch` throws goes through.
void read_lines(const StoredLines& stored, const std::function<std::string(int line)>& fetch);

} // namespace clvr

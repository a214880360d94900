// One volume from files that hold a slice each.
#pragma once
#include "host/io/volume/samples.hpp"
#include "host/io/volume/volume_file.hpp"

#include <functional>
#include <memory>

namespace clvr {

/// An opened file of one slice.
class SliceImage {
public:
    virtual ~SliceImage() = default;
    std::uint32_t width = 0, height = 0;
    SampleType type = SampleType::u8;
    std::string form;            ///< "6 x 7 u16": all slices of a stack have the same
    bool has_alpha = false;      ///< it is left out
    bool grey_of_colour = false; ///< red, green and blue are equal
    /// To width x height samples in host byte order.
    virtual void decode(unsigned char* to) = 0;
};
using OpenSlice = std::function<std::unique_ptr<SliceImage>(const std::string& file)>;

/// dims, type and bytes of v from `files` in order; `format` and `path` describe it. Throws Error{input} for slices that are not alike.
void stack_slices(Voxels& v, const std::string& path, const std::string& format, const std::vector<std::string>& files,
                  const OpenSlice& open);
/// The whole volume from pictures that say nothing of space. `kind` is "PNG" or the like.
Voxels read_pictures(const std::string& path, const std::vector<std::string>& files, const VolumeReadOptions& options,
                     const std::string& kind, const OpenSlice& open);
/// Stores a slice's samples as slice `slice` of v, whose dims, type and bytes are set.
void store_slice(Voxels& v, std::size_t slice, SampleType type, const std::function<void(unsigned char*)>& decode);

} // namespace clvr

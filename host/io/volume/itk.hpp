// Formats with a text header: clvr checks what the header promises against the file, then ITK decodes.
#pragma once
#include "host/io/volume/header_text.hpp"
#include "host/io/volume/samples.hpp"

#include <string>
#include <vector>

namespace clvr {

/// What a text header promises, as clvr read it.
struct Container {
    FileDims dims{1, 1, 1};
    std::int64_t frames = 1;
    bool frames_interleaved = false; ///< the frame is the fastest axis once ITK has decoded (NRRD "list")
    SampleType type = SampleType::u8;
    std::string data_path;    ///< where the voxels are: the file itself or beside it
    std::uint64_t offset = 0; ///< of the voxels in data_path
    enum class Coding { plain, deflated, text } coding = Coding::plain;
    bool text_may_be_nan = false; ///< ITK can read "nan" in text voxels
    double unit_mm = 1;           ///< the header's unit of length
    double slope = 1, intercept = 0;
    std::string modality;
    std::vector<std::string> notes;
};

/// Throws Error{input} unless the voxels that `c` promises are there: byte counts of plain data, compressed data decoded to its checksum,
/// numbers counted in text.
void check_payload(const Container& c, const std::string& path);

enum class ItkReader { nrrd, metaimage, vtk };
/// Decodes with ITK's ImageIO (straight into the voxels where the type is kept) after check_payload. Throws Error{input}, too, where ITK
/// understands the header otherwise than clvr.
Voxels decode_with_itk(ItkReader reader, const Container& c, const std::string& path, const std::string& format, int frame);

} // namespace clvr

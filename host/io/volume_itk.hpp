// Formats with a text header: clvr checks what the header promises against the file, then ITK decodes.
#pragma once
#include "host/io/volume_samples.hpp"

#include <string>
#include <string_view>
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

/// The numbers of a text, separated by blanks, commas or parentheses; nothing when a word is no number.
std::optional<std::vector<double>> parse_numbers(std::string_view text);
/// `count` whole numbers of at least `least`. Throws Error{input} naming the field.
std::vector<std::int64_t> parse_integers(std::string_view text, std::size_t count, std::int64_t least, const char* field,
                                         const std::string& path);
/// `count` voxel sizes: throws Error{input} unless all are finite and not 0.
void check_spacing(std::string_view text, std::size_t count, const char* field, const std::string& path);
/// "True" and "False" in MetaImage, blanks around words, capital letters.
std::string_view trimmed(std::string_view s);
std::string lower_case(std::string_view s);
/// The file that a header names, relative to the header's folder. Throws Error{input} when it is missing.
std::string beside(const std::string& header, const std::string& name);

} // namespace clvr

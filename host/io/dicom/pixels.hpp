// The pixels of DICOM slices.
#pragma once
#include "host/io/dicom/frame.hpp"

#include <sys/types.h>
#include <vector>

namespace clvr {

/// Decodes the pixels of slices, one after another. GDCM decodes compressed ones in a child process: it crashes or loops on some damaged
/// pixels (seen with 3.0.21: RLE, JPEG, JPEG-LS), which must end in an Error.
class DicomPixelReader {
public:
    /// The slices in the order in which `next` will give them; they outlive the reader.
    explicit DicomPixelReader(std::vector<const DicomFrame*> order);
    ~DicomPixelReader();
    DicomPixelReader(const DicomPixelReader&) = delete;
    DicomPixelReader& operator=(const DicomPixelReader&) = delete;

    /// Writes the pixels of the next slice to `to`: columns x rows samples of bits_allocated in host byte order, unused bits cut off; and
    /// to `padding`, where it is not null, which of them are padding. Throws Error{input} naming the file.
    void next(unsigned char* to, std::vector<bool>* padding = nullptr);

private:
    void start_child();
    void read_child(const DicomImage& image);
    void read_plain(const DicomImage& image, std::size_t number);
    void read_picture(const DicomFrame& frame);

    std::vector<const DicomFrame*> order_;
    std::size_t at_ = 0;
    const DicomFrame* current_ = nullptr; ///< whose whole picture, host byte order and clean, is at hand
    std::vector<unsigned char> picture_;
    std::vector<bool> padding_; ///< of the picture; empty where its file has no padding
    const DicomImage* inflated_of_ = nullptr;
    std::string inflated_; ///< the data set of the last deflated file
    pid_t child_ = -1;
    int pipe_ = -1; ///< where the child writes the pixels of compressed slices
};

} // namespace clvr

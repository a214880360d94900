// The pixels of DICOM slices.
#pragma once
#include "host/io/volume/dicom/arrange.hpp"

#include <cstdio>
#include <vector>

#include <sys/types.h>

namespace clvr {

/// Decodes the pixels of slices, one after another. GDCM decodes compressed ones in a child process: it crashes or loops on some damaged
/// pixels (seen with 3.0.21: RLE, JPEG, JPEG-LS), which must end in an Error.
class DicomPixelReader {
public:
    /// The slices in the order in which `next` will give them; they outlive the reader.
    explicit DicomPixelReader(std::vector<const DicomSlice*> order);
    ~DicomPixelReader();
    DicomPixelReader(const DicomPixelReader&) = delete;
    DicomPixelReader& operator=(const DicomPixelReader&) = delete;

    /// Writes the pixels of the next slice to `to`: columns x rows samples of bits_allocated in host byte order, unused bits cut off.
    /// Throws Error{input} naming the file.
    void next(unsigned char* to);

private:
    void start_child();
    void read_child(const DicomSlice& slice, unsigned char* to);

    std::vector<const DicomSlice*> order_;
    std::size_t at_ = 0;
    pid_t child_ = -1;
    int pipe_ = -1; ///< where the child writes the pixels of compressed slices
};

} // namespace clvr

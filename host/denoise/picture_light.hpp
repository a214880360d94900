// What the denoiser learns from a whole picture before it filters any part of it: the exposure, and the shares of what is known of its
// light.
#pragma once
#include "host/denoise/channels.hpp"
#include "host/denoise/known_light.hpp"
#include "host/frame/film.hpp"
#include "runtime/opencl/device.hpp"

#include <array>
#include <vector>

namespace clvr {

/// exposure_of and KnownLight of a picture on the device, with sums in float (the same bits on every device), of blocks that are added in
/// double. begin(), then add() for parts that cover the picture, then the rest. Beauty lies in R G B of the films, its opacity in opacity.A
/// (else in A, where `alpha`; else it is 1). Known light alone wants known_light_channels().
class PictureLight {
public:
    PictureLight(const Device& device, const Model& model);
    /// Has the programs built on a thread of their own.
    void prepare();
    /// Whether the model asks for anything of the whole picture.
    bool is_wanted() const { return wants_exposure_ || wants_known_; }
    /// Of the next picture.
    void begin(int width, int height, bool alpha);
    /// Parts of a picture begin at multiples of this, and end there or at its border [pixels].
    int block() const { return block_; }
    /// `film` holds `region` of the picture, and no value that is not finite.
    void add(Film& film, const Region& region);
    /// 1 for models that do not ask.
    double exposure() const { return wants_exposure_ ? exposure_of(blocks_) : 1; }
    /// Writes known.R/G/B of a film whose first pixel is (left, top) of the picture. Without effect for models that do not read it.
    void make_known(Film& film, int left, int top);

private:
    Device device_;
    bool wants_exposure_, wants_known_, varying_, alpha_ = false;
    int edge_, block_, lanes_;
    bool loaded_ = false; // the kernels
    Kernel exposure_columns_, light_columns_, block_sums_, known_light_;
    int width_ = 0, height_ = 0;
    std::vector<ExposureBlock> blocks_;          // of the picture, in rows
    std::array<std::vector<LightFit>, 3> cells_; // of each colour
    Buffer columns_, sums_, shares_;
    int shares_across_ = 0, shares_down_ = 0; // 0: shares_ are not there yet

    Defines defines(bool of_exposure) const;
    /// Sums of blocks of `edge` pixels along x, from sums of columns of `rows` rows.
    std::vector<float> folded(int width, int rows, int edge);
    void fit();
};

} // namespace clvr

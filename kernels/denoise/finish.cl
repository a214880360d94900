// From the denoiser's result to planes of a film: exposure taken back, nothing below 0. One work-item a pixel.
#include "lib/planes.clh"

// `result`: 3 of `channels` planes with a border (DenoiseParams). Its pixels from `from`.x, `from`.y on, `from`.z x `from`.w of them, go to those of three
// planes from `first_plane` on, of `size` floats each in rows of `width`, at `to` and after.
__kernel void finish(__constant const DenoiseParams* p, __global const float* result, int channels, int4 from, float exposure, __global float* planes,
                     uint first_plane, uint size, int width, uint to) {
    int x = (int)get_global_id(0), y = (int)get_global_id(1);
    if (x >= from.z || y >= from.w) return;
    size_t at = (size_t)((from.y + y) * p->row + from.x + x), place = (size_t)to + (size_t)y * (size_t)width + (size_t)x;
    for (int c = 0; c < 3; ++c) {
        float v = result[plane_start(p, 0, channels, c) + at] / exposure;
        planes[((size_t)first_plane + (size_t)c) * size + place] = v < 0.0f ? 0.0f : v;
    }
}

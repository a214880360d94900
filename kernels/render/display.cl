// From planes of a film to what a display shows: over a background or not, exposure, tone curve, 8-bit sRGB: the values that
// host/frame/tonemap.cpp finds in double, so the pixels of a PNG. One work-item a pixel number.
#include "lib/paths.clh"
#include "lib/two_floats.clh"

// The least values, as two floats each, that become the 8-bit codes 0 to 255; the last one not above v. v is not NaN.
static inline uchar code_of(__global const float2* least, TwoFloats v) {
    int code = 0;
#pragma nounroll
    for (int step = 128; step > 0; step >>= 1) {
        float2 l = least[code + step];
        TwoFloats bound = {l.x, l.y};
        if (!two_less(v, bound)) code += step;
    }
    return (uchar)code;
}

#define TWO(high, low) ((TwoFloats){high, low}) // a double as the sum of two floats

// The curves of host/frame/tonemap.cpp, where their sources stand. c: not negative.
static inline void filmic(TwoFloats* c) {
    const TwoFloats gain = TWO(1.29999995f, 4.76837165e-8f), knee = TWO(0.699999988f, 1.19209291e-8f), one = TWO(1.0f, 0.0f);
    const TwoFloats span2 = TWO(0.0900000036f, -3.57627861e-9f); // (1 - knee)^2
    const TwoFloats shift = TWO(-0.400000006f, 5.96046457e-9f);  // 1 - 2 knee
    const TwoFloats desaturation = TWO(0.150000006f, -5.96046457e-9f);
    TwoFloats peak = two_product(gain, two_max(c[0], two_max(c[1], c[2])));
    if (!two_less(knee, peak)) {
        for (int k = 0; k < 3; ++k) c[k] = two_product(gain, c[k]);
        return;
    }
    if (peak.high > 1e15f) { // white, and squares of it would not be finite
        c[0] = c[1] = c[2] = one;
        return;
    }
    TwoFloats rolled = two_sum(one, two_minus(two_quotient(span2, two_sum(peak, shift))));
    TwoFloats colour = two_quotient(one, two_sum(two_product(desaturation, two_sum(peak, two_minus(rolled))), one)); // 1 - white
    TwoFloats white = two_product(rolled, two_sum(one, two_minus(colour)));
    TwoFloats scale = two_product(two_product(gain, two_quotient(rolled, peak)), colour);
    for (int k = 0; k < 3; ++k) c[k] = two_sum(two_product(scale, c[k]), white);
}

static inline void aces(TwoFloats* c) {
    for (int k = 0; k < 3; ++k) {
        TwoFloats x = two_product(TWO(0.600000024f, -2.38418583e-8f), c[k]);
        if (x.high > 1e15f) x = two_floats(1e15f);
        TwoFloats above = two_product(x, two_sum(two_product(TWO(2.50999999f, 9.53674295e-9f), x), TWO(0.0299999993f, 6.7055228e-10f)));
        TwoFloats below =
            two_sum(two_product(x, two_sum(two_product(TWO(2.43000007f, -6.67572024e-8f), x), TWO(0.589999974f, 2.62260436e-8f))),
                    TWO(0.140000001f, -5.96046434e-10f));
        c[k] = two_quotient(above, below);
    }
}

static inline void reinhard(TwoFloats* c) {
    TwoFloats luminance = two_product(TWO(0.212599993f, 7.24792493e-9f), c[0]);
    luminance = two_sum(luminance, two_product(TWO(0.715200007f, -6.96182267e-9f), c[1]));
    luminance = two_sum(luminance, two_product(TWO(0.0722000003f, -2.86102309e-10f), c[2]));
    TwoFloats scale = two_quotient(two_floats(1.0f), two_sum(two_floats(1.0f), luminance));
    for (int k = 0; k < 3; ++k) c[k] = two_product(c[k], scale);
}

// `planes`: R G B A from `first_plane` on, of width * height floats each. `below`: [pixel numbers] linear radiance behind the picture,
// where `over` is 1; where it is 2, `colour` is. `curve`: a place in tonemap_names; gain: 2^exposure. `least`: [2][256] of sRGB, of alpha.
// `with_alpha`: straight colours and alpha; else colours over black. out: [height][width] R G B A.
__kernel void display(__global const float* planes, uint first_plane, __global const float4* below, int over, float4 colour, int width,
                      int height, int curve, float gain, float gain_low, __global const float2* least, int with_alpha,
                      __global uchar4* out) {
    uint number = (uint)get_global_id(0);
    uint2 pixel = pixel_of(number, width);
    if (pixel.x >= (uint)width || pixel.y >= (uint)height) return;
    size_t size = (size_t)width * (size_t)height, at = (size_t)pixel.y * (size_t)width + pixel.x;
    __global const float* from = planes + first_plane * size + at;
    float rgb[3] = {from[0], from[size], from[2 * size]}, alpha = from[3 * size];
    if (over) {
        float4 b = over == 1 ? below[number] : colour;
        float behind[3] = {b.x, b.y, b.z};
        for (int k = 0; k < 3; ++k) rgb[k] = rgb[k] + fma(1.0f - alpha, behind[k], 0.0f);
        alpha = 1.0f;
    }
    alpha = alpha > 0.0f ? (alpha < 1.0f ? alpha : 1.0f) : 0.0f;
    uchar shown = code_of(least + 256, two_floats(alpha));
    TwoFloats c[3], factor = {gain, gain_low};
    for (int k = 0; k < 3; ++k) { // the straight colour times the gain, from 0 to 1e30
        c[k] = two_floats(shown && rgb[k] > 0.0f ? (rgb[k] < 1e35f ? rgb[k] : 1e35f) : 0.0f);
        if (alpha < 1.0f && shown) c[k] = two_quotient(c[k], two_floats(alpha));
        c[k] = c[k].high * gain > 1e30f ? two_floats(1e30f) : two_product(c[k], factor);
    }
    if (curve == 0) filmic(c);
    if (curve == 1) aces(c);
    if (curve == 2) reinhard(c);
    uchar codes[3];
    for (int k = 0; k < 3; ++k) codes[k] = code_of(least, with_alpha ? c[k] : two_product(c[k], two_floats(alpha)));
    out[at] = (uchar4)(codes[0], codes[1], codes[2], shown);
}

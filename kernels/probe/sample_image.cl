// The samples of sample_buffer.cl from a 3-D image with the device's own filter, whose weights have few bits: for speed only, clvr's stages do not use it.
constant sampler_t linear = CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP_TO_EDGE | CLK_FILTER_LINEAR;

kernel void sample_image(read_only image3d_t from, global float* to, int side, int steps, uint items) {
    const uint i = get_global_id(0);
    if (i >= items) return;
    const int y = (int)i / side, x = (int)i - y * side;
    const float px = (float)min(x, side - 2) + 0.75f, py = (float)min(y, side - 2) + 1.125f;
    float sum = 0.0f;
    for (int step = 0; step < steps; ++step) {
        const float z = ((float)step + 0.5f) * (float)(side - 1) / (float)steps;
        sum = sum + read_imagef(from, linear, (float4)(px, py, z + 0.5f, 0.0f)).x;
    }
    to[i] = sum;
}

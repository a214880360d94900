// The gradient of the loss by a convolution's biases, in the 16 lanes of weight_gradient.cl. A work-item takes CLVR_WIDTH lanes of an output channel.
#include "lib/planes.clh"
#include "lib/vec.clh"

// `gradient`: dL/d(sums), `channels` planes an image. `lanes`: [images][parameters][16], the biases from parameter `first` on.
__kernel void bias_gradient(__constant DenoiseParams* p, __global const float* gradient, int channels, __global float* lanes, uint parameters, uint first) {
    int lane = (int)get_global_id(0) * CLVR_WIDTH, channel = (int)get_global_id(1), n = (int)get_global_id(2);
    if (lane >= 16 || channel >= channels) return;
    gradient += plane_start(p, n, channels, channel);
    vfloat sum = (vfloat)(0.0f);
    for (int y = 0; y < p->height; ++y)
        for (int x = lane; x < p->width; x += 16) sum += v_load(gradient + y * p->row + x);
    v_store(sum, lanes + ((size_t)n * parameters + first + (uint)channel) * 16 + (size_t)lane);
}

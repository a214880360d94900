// A step of Adam (Kingma and Ba, "Adam: a method for stochastic optimization", 2015), epsilon beside the corrected root. One work-item a parameter.
#pragma OPENCL FP_CONTRACT OFF

// `rates`: beta1, 1 - beta1, beta2, 1 - beta2. `correction`: 1 / (1 - beta1^t), 1 / (1 - beta2^t). `scale`: one factor of the gradient.
__kernel void adam(__global float* parameters, __global float* first_moment, __global float* second_moment, __global const float* gradient,
                   __global const float* scale, float4 rates, float2 correction, float learning_rate,
                   float epsilon, uint count) {
    uint i = (uint)get_global_id(0);
    if (i >= count) return;
    float g = gradient[i] * scale[0];
    float m = fma(rates.x, first_moment[i], rates.y * g);
    float v = fma(rates.z, second_moment[i], rates.w * g * g);
    first_moment[i] = m;
    second_moment[i] = v;
    parameters[i] = fma(-learning_rate * (m * correction.x), 1.0f / (sqrt(v * correction.y) + epsilon), parameters[i]);
}

// Parameters from the order of the model file to that of a convolution kernel. One work-item a value.
__kernel void pack_weights(__global const float* parameters, __global const int* from, __global float* packed, uint count) {
    uint i = (uint)get_global_id(0);
    if (i < count) packed[i] = from[i] < 0 ? 0.0f : parameters[from[i]];
}

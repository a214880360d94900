// Backwards through the division N / D of each cell (kernels/denoise/README.md, "Backward"): from Q = dL/dV to A = Q / D and b = <A, V>, in place. One
// work-item a cell.
#pragma OPENCL FP_CONTRACT OFF

// `cells`: V (xyz), D (w). `gradient`: Q (xyz), becomes A (xyz), b (w).
__kernel void normalise_gradient(__global const float4* cells, __global float4* gradient, uint count) {
    uint i = (uint)get_global_id(0);
    if (i >= count) return;
    float4 v = cells[i], a = v.w > 0.0f ? gradient[i] / v.w : (float4)(0.0f);
    gradient[i] = (float4)(a.x, a.y, a.z, fma(a.x, v.x, fma(a.y, v.y, a.z * v.z)));
}

// Adds neighbours of a row: from sums of columns to those of blocks or cells. One work-item a block of a row.
#pragma OPENCL FP_CONTRACT OFF

// columns: [rows][width]; blocks: [rows][ceil(width / edge)].
__kernel void block_sums(__global const float* columns, int width, int rows, int edge, __global float* blocks) {
    int block = (int)get_global_id(0), row = (int)get_global_id(1), across = (width + edge - 1) / edge;
    if (block >= across || row >= rows) return;
    int x = block * edge, end = x + edge < width ? x + edge : width;
    float sum = 0.0f;
    for (; x < end; ++x) sum += columns[(size_t)row * (size_t)width + (size_t)x];
    blocks[(size_t)row * (size_t)across + (size_t)block] = sum;
}

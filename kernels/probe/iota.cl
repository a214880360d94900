// to[i] = first + i, for i below n.
kernel void iota(global int* to, int first, uint n) {
    const uint i = get_global_id(0);
    if (i < n) to[i] = first + (int)i;
}

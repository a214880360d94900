// Lists the paths that go on and those with a light sample. One work-item takes a run of CLVR_RUN entries, with one atomic add per list. The runs may come in
// any order, because every path is computed by itself.
#ifndef CLVR_RUN
#define CLVR_RUN 64
#endif

__kernel void compact(__global const uint* active, __global const uint* state, uint count, __global uint* next_active, __global uint* shadowed, __global uint* counts) {
    uint first = (uint)get_global_id(0) * CLVR_RUN;
    if (first >= count) return;
    uint last = first + CLVR_RUN < count ? first + CLVR_RUN : count;
    uint going = 0, lit = 0;
    for (uint k = first; k < last; ++k) going += state[k] & 1u, lit += state[k] >> 1;
    going = going ? atomic_add(counts, going) : 0u;
    lit = lit ? atomic_add(counts + 1, lit) : 0u;
    for (uint k = first; k < last; ++k) {
        if (state[k] & 1u) next_active[going++] = active[k];
        if (state[k] & 2u) shadowed[lit++] = active[k];
    }
}

// Where this compiler puts the fields of the shared structs, and how large each is: in the order of shared/struct_fields.h.
#include "shared/struct_fields.h"

// `base`: any memory; only addresses are taken.
__kernel void struct_layout(__global uint* to, __global const float4* base) {
    if (get_global_id(0) != 0) return;
    uint n = 0;
#define CLVR_STRUCT(type) to[n++] = (uint)sizeof(type);
#define CLVR_FIELD(type, field) to[n++] = (uint)((size_t)&((__global const type*)base)->field - (size_t)base);
    CLVR_EACH_STRUCT_AND_FIELD
}

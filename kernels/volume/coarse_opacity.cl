// Mean opacity of the cells of a coarse grid: above 0 where an interpolated value of the cell may have any, else 0. One work-item a cell.
#include "lib/volume.clh"

// `visible`: [4097] how many entries of the transfer table before this one have opacity. `mean`: [cells], x fastest.
__kernel void coarse_opacity(VOLUME_ARGS, __global const uint* visible, __global float* mean) {
    VOLUME_HERE(vol);
    int log2_edge = vol.p->coarse.w, edge = 1 << log2_edge;
    int x = (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= vol.p->coarse.x || y >= vol.p->coarse.y || z >= vol.p->coarse.z) return;
    Int3 cell = {x, y, z}, low = {x << log2_edge, y << log2_edge, z << log2_edge}; // the first lower voxel
    Int3 around = cell_of(low, vol.p->cells.w);
    Support s = support_of(&vol, low);
    float result = 0.0f;
    if (majorant[cell_index(vol.p, around)] > 0.0f && s.offset >= 0) {
        int row, slice, address;
        int group = first_group(&s);
        group_lanes(&vol, &s, group, &row, &slice, &address);
        __global const CLVR_VOXEL* voxels = vol.voxels[group >> 2];
        int nx = v_min(edge, vol.p->last.x - low.x), ny = v_min(edge, vol.p->last.y - low.y), nz = v_min(edge, vol.p->last.z - low.z);
        float least = (float)voxels[address], greatest = least, sum = 0.0f;
        for (int k = 0; k <= nz; ++k)
            for (int j = 0; j <= ny; ++j)
                for (int i = 0; i <= nx; ++i) {
                    float v = (float)voxels[address + k * slice + j * row + i];
                    least = v_min(least, v), greatest = v_max(greatest, v);
                    if (i < nx && j < ny && k < nz) sum += opacity_of(&vol, v);
                }
        float last = (float)CLVR_TABLE_LAST;
        int first = (int)floor(v_clamp(table_index(vol.p, least), 0.0f, last)), end = (int)ceil(v_clamp(table_index(vol.p, greatest), 0.0f, last)) + 1;
        if (visible[end] > visible[first]) result = v_max(sum / (float)(nx * ny * nz), 0x1p-100f);
    }
    mean[coarse_index(vol.p, cell)] = result;
}

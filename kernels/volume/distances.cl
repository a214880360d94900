// From each cell of the grid of mean opacity to the nearest one that has any, along one axis after the other: the greatest of the differences along the axes
// (host/render/device_volume.cpp). A work-item takes CLVR_WIDTH cells of a row.
#include "lib/plane_rows.clh"

// The value, or minus the distance, `by` cells further along x; `missing` beyond the row's ends. `row`: of `count` cells; x: of the first lane.
static inline vfloat shifted(__global const float* row, int x, int by, int count, float missing) {
    int first = x + by;
    if (first >= 0 && first + CLVR_WIDTH <= count) return v_load(row + first);
    vint at = v_iota + first;
    vmask inside = v_ge(at, (vint)(0)) & v_lt(at, (vint)(count));
    return v_select(inside, v_gather(row, v_min(v_max(at, (vint)(0)), (vint)(count - 1))), (vfloat)(missing));
}

// from, to: [cells.z][cells.y][cells.x]: a cell's mean opacity above 0, or minus its distance along the axes before this one; 0 or less before the first axis
// (`axis` 0): not known yet. `farthest`: where there is no such cell.
__kernel void distances(__global const float* from, int4 cells, int axis, float farthest, __global float* to) {
    int x = (int)get_global_id(0) * CLVR_WIDTH, y = (int)get_global_id(1), z = (int)get_global_id(2);
    if (x >= cells.x || y >= cells.y || z >= cells.z) return;
    int at = axis == 1 ? y : z, count = axis == 0 ? cells.x : axis == 1 ? cells.y : cells.z;
    size_t step = axis == 1 ? (size_t)cells.x : (size_t)cells.x * (size_t)cells.y, start = ((size_t)z * (size_t)cells.y + (size_t)y) * (size_t)cells.x;
    __global const float* row = from + start;
    vfloat here = row_pixels(row + x, cells.x - x), nearest = axis == 0 ? (vfloat)(farthest) : -here;
    vmask empty = v_le(here, (vfloat)(0.0f));
    for (int r = 1; r < count && v_any(empty & v_gt(nearest, (vfloat)((float)r))); ++r)
        for (int side = -1; side <= 1; side += 2) {
            vfloat value = (vfloat)(-farthest);
            if (axis == 0)
                value = shifted(row, x, side * r, count, -farthest);
            else if (at + side * r >= 0 && at + side * r < count)
                value = row_pixels(side < 0 ? row + x - (size_t)r * step : row + x + (size_t)r * step, cells.x - x);
            vfloat before = axis == 0 ? (vfloat)(farthest) : -value; // distance of an empty cell
            vfloat distance = v_select(v_gt(value, (vfloat)(0.0f)), (vfloat)(0.0f), before);
            nearest = v_min(nearest, v_max(distance, (vfloat)((float)r)));
        }
    store_row(to + start + x, cells.x - x, v_select(empty, -nearest, here));
}

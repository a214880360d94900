// Starts the paths of a wave: `samples` of each of the wave's pixels, a random position in the pixel each. One work-item a path.
#include "lib/camera.clh"
#include "lib/paths.clh"
#include "lib/sobol.clh"

__kernel void camera_rays(__constant RenderParams* render, PATH_ARGS, __global uint* active, uint count, uint first_pixel, uint first_sample, uint samples) {
    uint path = (uint)get_global_id(0);
    if (path >= count) return;
    uint2 pixel = pixel_of(first_pixel + path / samples, render->width);
    uint2 id;
    id.x = pixel.y * (uint)render->width + pixel.x;
    id.y = first_sample + path % samples;
    uint name = pixel_name(id.x, render);
    float2 place = sobol_point(name, id.y, CLVR_POINTS_CAMERA), flight = sobol_point(name, id.y, CLVR_POINTS_FLIGHT);
    Vec3 o, d;
    camera_ray(render, (float)pixel.x + place.x, (float)pixel.y + place.y, &o, &d);
    path_id[path] = id;
    origin[path] = (float4)(o.x, o.y, o.z, flight.y);
    heading[path] = (float4)(d.x, d.y, d.z, 0.0f);
    weight[path] = (float4)(1.0f, 1.0f, 1.0f, flight.x);
    radiance[path] = (float4)(0.0f);
    active[path] = path;
}

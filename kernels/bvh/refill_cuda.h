// Persistent warps on a BVH (kernels/refill_cuda.h).
#include "kernels/refill_cuda.h"

// A layout whose lanes go through the loop together defines these instead.
#ifndef TOGETHER_ENTRIES
#define TOGETHER_ENTRIES TRAVERSAL_ENTRIES
#define TOGETHER_GOES_ON TRAVERSAL_GOES_ON
#endif

template <class Rays>
KERNEL_FN void trace_refilled(SceneView scene, TraceParams params, const Rays& rays, uint* counter)
{
    RayFrame frame = {};
    Nearest nearest = {};
    STACK(stack, TOGETHER_ENTRIES);
    TRAVERSAL_AT_ROOT(uint)
    refill_lanes(
        rays, counter,
        [&](uint item) {
            Ray ray = rays.ray(item);
            frame = frame_of(ray);
            nearest = no_hit_before(ray, rays.end(item));
            TRAVERSAL_AT_ROOT()
            return true;
        },
        [&](MAYBE_UNUSED uint going) {
#include KERNEL_LOOP_HEADER
            return TOGETHER_GOES_ON;
        },
        [&](uint item) { return hit_of(scene, rays.ray(item), nearest); });
}

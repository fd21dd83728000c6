// The kernels of a BVH: what its layouts share, and a layout with its traversal. They trace given rays in the same way
// as the rays of an image.
#define TAKES_RAYS

#include "kernels/bvh/bvh.h"

#include KERNEL_LAYOUT_HEADER

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    return trace_ray(scene, params, ray, real(NO_END));
}

KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    return trace_ray(scene, params, given_ray(direction, origin), as_real(origin.w));
}

#ifdef LANES_VOTE
#include "kernels/bvh/refill_cuda.h"
#endif

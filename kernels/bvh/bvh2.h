// Layout bvh2: a binary tree whose nodes hold their children's boxes; near child first.
// Source: Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009, and its addendum with
// Karras, 2012: the node and the loop, first through nodes, then through a leaf's triangles.

// The bottom of the stack: a leaf that ends the loop.
#define BVH2_END 0xFFFFFFFFu

#ifdef HOST_SSE2
#include "kernels/bvh/bvh2_boxes_sse2.h"
#else
// Depth at which the ray enters a box, 0 inside, or NEVER.
KERNEL_FN real box_entry(RayFrame frame, real limit, uint x_low, uint x_high, uint y_low, uint y_high, uint z_low,
                         uint z_high)
{
    real x0 = multiply_add(as_real(x_low), frame.inverse.x, -frame.offset.x);
    real x1 = multiply_add(as_real(x_high), frame.inverse.x, -frame.offset.x);
    real y0 = multiply_add(as_real(y_low), frame.inverse.y, -frame.offset.y);
    real y1 = multiply_add(as_real(y_high), frame.inverse.y, -frame.offset.y);
    real z0 = multiply_add(as_real(z_low), frame.inverse.z, -frame.offset.z);
    real z1 = multiply_add(as_real(z_high), frame.inverse.z, -frame.offset.z);
    real near = maximum(maximum(minimum(x0, x1), minimum(y0, y1)), maximum(minimum(z0, z1), real(0.0f)));
    real far = minimum(minimum(maximum(x0, x1), maximum(y0, y1)), minimum(maximum(z0, z1), limit));
    return near <= with_slack(far) ? near : NEVER;
}
#endif

// A traversal is text, not functions, because kernels have no pointers to its stack: trace_ray() has it, and so do
// lanes that go on with another ray (refill_cuda.h). The loop's body is bvh2_loop.h.
// Entries of the stack: children with their depths; BVH2_END; an entry that is written but not kept.
#define TRAVERSAL_ENTRIES (BVH2_STACK + 2u)
// type: of the variables; empty if they are declared already.
#define TRAVERSAL_AT_ROOT(type)                                                                                        \
    SET_ENTRY(scene, stack, 0u, BVH2_END, as_bits(real(0.0f)))                                                         \
    type waiting = 1u;                                                                                                 \
    type child = 0u;
#define TRAVERSAL_GOES_ON (child != BVH2_END)

KERNEL_FN Hit trace_ray(SceneView scene, TraceParams params, Ray ray, real end)
{
    RayFrame frame = frame_of(ray);
    Nearest nearest = no_hit_before(ray, end);
#ifdef HOST_SSE2
    // Before the compiler has the rest of the frame computed; for other rays the loop tests the root again.
    if (entries_of(node_of(scene, 0u), frame, nearest.limit).met == 0u) {
        COUNT_NODE();
        return make_no_hit(NO_HIT, NO_TET, 0u);
    }
#endif
    STACK(stack, STACK_ENTRIES(TRAVERSAL_ENTRIES));
    TRAVERSAL_AT_ROOT(uint)
    do {
#include "kernels/bvh/bvh2_loop.h"
    } while (TRAVERSAL_GOES_ON);
    return hit_of(scene, ray_of(frame), nearest);
}

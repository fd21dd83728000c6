// Layout bvh4: a tree with four children per node, whose boxes are stored component by component; nearest child first.
// Source: Dammertz, Hanika, Keller, "Shallow Bounding Volume Hierarchies for Fast SIMD Ray Tracing of Incoherent Rays",
// EGSR 2008, and Wald, Benthin, Boulos, "Getting Rid of Packets", IRT 2008: the node. The loop is that of bvh2.h.

// The bottom of the stack: a leaf that ends the loop.
#define BVH4_END 0xFFFFFFFFu
// Instead of a key, for a box that the ray does not enter.
#define BVH4_NO_KEY 0xFFFFFFFFu

// What the children are sorted by: the bits of the depth at which the ray enters each box, 0 inside, with the child's
// slot in the last two bits. Planes are those that the ray meets first (near) and last (far) along each axis.
#if defined(HOST_SSE2)
// bvh4_node_sse2.h has them in its own way.

// Depths of the planes that the ray meets last, fused where the processor can. By a rounding, other boxes may be
// entered than elsewhere, but in the same order, and hits are the same (docs/spec/bvhs.md, B7).
KERNEL_FN __m128 far_depths(const float* planes, __m128 inverse, __m128 offset)
{
#ifdef __FMA__
    return _mm_fmsub_ps(_mm_loadu_ps(planes), inverse, offset);
#else
    return _mm_loadu_ps(planes) * inverse - offset;
#endif
}
#elif defined(HAS_FLOAT4)
#include "kernels/bvh/bvh4_keys_opencl.h"
#else
KERNEL_FN uint entry_key(RayFrame frame, real limit, uint slot, uint near_x, uint near_y, uint near_z, uint far_x,
                         uint far_y, uint far_z)
{
    real x0 = multiply_add(as_real(near_x), frame.inverse.x, -frame.offset.x);
    real y0 = multiply_add(as_real(near_y), frame.inverse.y, -frame.offset.y);
    real z0 = multiply_add(as_real(near_z), frame.inverse.z, -frame.offset.z);
    real x1 = multiply_add(as_real(far_x), frame.inverse.x, -frame.offset.x);
    real y1 = multiply_add(as_real(far_y), frame.inverse.y, -frame.offset.y);
    real z1 = multiply_add(as_real(far_z), frame.inverse.z, -frame.offset.z);
    real near = maximum(maximum(x0, y0), maximum(z0, real(0.0f)));
    real far = minimum(minimum(x1, y1), minimum(z1, limit));
    return near <= with_slack(far) ? (as_bits(near) & ~3u) | slot : BVH4_NO_KEY;
}

KERNEL_FN uint4 entry_keys(RayFrame frame, real limit, uint4 near_x, uint4 near_y, uint4 near_z, uint4 far_x,
                           uint4 far_y, uint4 far_z)
{
    uint4 keys;
    keys.x = entry_key(frame, limit, 0u, near_x.x, near_y.x, near_z.x, far_x.x, far_y.x, far_z.x);
    keys.y = entry_key(frame, limit, 1u, near_x.y, near_y.y, near_z.y, far_x.y, far_y.y, far_z.y);
    keys.z = entry_key(frame, limit, 2u, near_x.z, near_y.z, near_z.z, far_x.z, far_y.z, far_z.z);
    keys.w = entry_key(frame, limit, 3u, near_x.w, near_y.w, near_z.w, far_x.w, far_y.w, far_z.w);
    return keys;
}
#endif

#if defined(HOST_SSE2) || defined(PREDICTS_BRANCHES)
// bvh4_children_predicted.h. ENTER_CHILD: the only child whose box is entered. ENTER_NEARER_CHILD: one of two, a in the
// lower slot, and the other waits. ADD_CHILD: one more, in a higher slot than the others, of which `others` wait.
#define BVH4_PREDICTED
#define ENTER_CHILD(slot)                                                                                              \
    KEEP_BRANCH;                                                                                                       \
    child = children.slot;
#define ENTER_NEARER_CHILD(a, b)                                                                                       \
    if (keys.b < keys.a) {                                                                                             \
        KEEP_BRANCH;                                                                                                   \
        SET_ENTRY(scene, stack, waiting, children.a, keys.a)                                                           \
        child = children.b;                                                                                            \
        key = keys.b;                                                                                                  \
    } else {                                                                                                           \
        KEEP_BRANCH;                                                                                                   \
        SET_ENTRY(scene, stack, waiting, children.b, keys.b)                                                           \
        child = children.a;                                                                                            \
        key = keys.a;                                                                                                  \
    }                                                                                                                  \
    ++waiting;
#define ADD_CHILD(slot, others)                                                                                        \
    if (keys.slot < key) {                                                                                             \
        KEEP_BRANCH;                                                                                                   \
        SET_ENTRY(scene, stack, waiting, child, key)                                                                   \
        child = children.slot;                                                                                         \
        key = keys.slot;                                                                                               \
    } else {                                                                                                           \
        uint place = waiting;                                                                                          \
        while (place > waiting - (others) && SECOND_OF_ENTRY(scene, stack, place - 1u) <= keys.slot) {                 \
            KEEP_BRANCH;                                                                                               \
            SET_ENTRY(scene, stack, place, FIRST_OF_ENTRY(scene, stack, place - 1u),                                   \
                      SECOND_OF_ENTRY(scene, stack, place - 1u))                                                       \
            --place;                                                                                                   \
        }                                                                                                              \
        SET_ENTRY(scene, stack, place, children.slot, keys.slot)                                                       \
    }                                                                                                                  \
    ++waiting;
#else
KERNEL_FN uint lower_key(uint a, uint b)
{
    return a < b ? a : b;
}

KERNEL_FN uint higher_key(uint a, uint b)
{
    return a < b ? b : a;
}

// The child in the slot that the key names.
KERNEL_FN uint child_of(uint4 children, uint key)
{
    uint even = (key & 2u) == 0u ? children.x : children.z;
    uint odd = (key & 2u) == 0u ? children.y : children.w;
    return (key & 1u) == 0u ? even : odd;
}
#define PUSH_CHILD(key)                                                                                                \
    if (key != BVH4_NO_KEY) {                                                                                          \
        SET_ENTRY(scene, stack, waiting, child_of(children, key), key & ~3u)                                           \
        ++waiting;                                                                                                     \
    }
#endif

// To the topmost entry that the nearest hit does not hide.
#define GO_TO_WAITING                                                                                                  \
    do {                                                                                                               \
        --waiting;                                                                                                     \
    } while (as_real(SECOND_OF_ENTRY(scene, stack, waiting)) > with_slack(nearest.limit));

// A traversal is text, as that of bvh2.h; the loop's body is bvh4_loop.h.
// Entries of the stack: children with their depths; BVH4_END.
#define TRAVERSAL_ENTRIES (BVH4_STACK + 1u)
#define TRAVERSAL_AT_ROOT(type)                                                                                        \
    SET_ENTRY(scene, stack, 0u, BVH4_END, as_bits(real(0.0f)))                                                         \
    type waiting = 1u;                                                                                                 \
    type child = 0u;
#define TRAVERSAL_GOES_ON (child != BVH4_END)

KERNEL_FN Hit trace_ray(SceneView scene, TraceParams params, Ray ray, real end)
{
    RayFrame frame = frame_of(ray);
    Nearest nearest = no_hit_before(ray, end);
    STACK(stack, STACK_ENTRIES(TRAVERSAL_ENTRIES));
    TRAVERSAL_AT_ROOT(uint)
    do {
#include "kernels/bvh/bvh4_loop.h"
    } while (TRAVERSAL_GOES_ON);
    return hit_of(scene, ray_of(frame), nearest);
}

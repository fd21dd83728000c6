// bvh/: the BVH layouts with their traversals, and what these share.

// What the BVHs share: a ray as their tests take it, boxes, and the triangle test (docs/spec/bvhs.md, B4).
#include "kernels/reciprocal.h"
#include "kernels/shear.h"

#include "kernels/stack.h"

// For a build that counts what a ray fetches. That build is never timed.
#ifndef COUNT_NODE
#define COUNT_NODE()
#define COUNT_TRIANGLE()
#endif

// Below, depth is the distance from the ray's origin along the axis of the direction's largest component, in the
// direction's sense: t times the magnitude of that component.

// The nearest hit so far.
STRUCT(Nearest)
{
    real limit;    // no triangle with a larger depth is nearer: at most the ray's end
    uint triangle; // of the input; NO_HIT; or DEFERRED
    uint at;       // one of the leaf triangles that refer to it
};

// Depth of a box that the ray does not enter.
#define NEVER real(3.0e38f)
// More than rounding can change a depth in a box test; needed only where bounds of different axes are compared.
#define BOX_SLACK real(1.000003814697265625f) // 1 + 2^-18
// A hit with a smaller depth than 2^-100 is not in front of the ray's origin.
#define LEAST_DEPTH real(8.67361737988403547e-19f) // 2^-60, in depth times 2^40

// Float depths that differ by NEAR_DEPTH or more are in the order of the exact ones, of which none is NEAR_KEY (in
// units of 2^-40) from its float depth (docs/spec/bvhs.md, B15).
#define NEAR_DEPTH real(0.0001220703125f) // 2^-13
#define NEAR_KEY 0x03000000u              // 3/8 of it

// A kernel for devices that execute every branch leaves rays at near triangles to another program
// (docs/spec/devices.md, W9).
#ifndef DEFERS_TIES
#define DEFERS_TIES false
#endif

// A function, because glslang does not terminate on a precise local that depends on a struct which the loop assigns as
// a whole.
KERNEL_FN real with_slack(real depth)
{
    PRECISE real result = depth * BOX_SLACK;
    return result;
}

// end: ray parameter. A value above 2^64 means no end; a value below 2^-60 means the origin.
KERNEL_FN Nearest no_hit_before(Ray ray, real end)
{
    Nearest nearest;
    real bounded = end < real(8.67361737988403547e-19f) ? real(0.0f) : minimum(end, real(18446744073709551616.0f));
#ifdef HOST_SSE2
    // gcc makes branches of an axis that is selected.
    Vec3 size = magnitudes(ray.direction);
    PRECISE real depth = bounded * maximum(maximum(size.x, size.y), size.z);
#else
    PRECISE real depth = bounded * magnitude(component(ray.direction, deepest_axis(ray.direction)));
#endif
    nearest.limit = depth;
    nearest.triangle = NO_HIT;
    nearest.at = 0u;
    return nearest;
}

// weighted: the sum of depths times 2^40, weighted by the sides, whose sum is the determinant.
KERNEL_FN real depth_of_mean(real weighted, real determinant)
{
    PRECISE real inverse = reciprocal(magnitude(determinant));
    PRECISE real scaled = (determinant < real(0.0f) ? -weighted : weighted) * inverse;
    PRECISE real depth = scaled * real(9.09494701772928238e-13f); // 2^-40
    return scaled < LEAST_DEPTH ? NEVER : depth;
}

#ifdef HOST_SSE2
#include "kernels/bvh/triangle_sse2.h"
#define FRAME const RayFrame&
#else
#include "kernels/bvh/triangle.h"
#define FRAME RayFrame
#endif

#include "kernels/bvh/exact_order.h"

// The nearer of a hit and leaf triangle `at`. If several are equally near, the first in the input wins, in any order of
// the tests.
KERNEL_FN Nearest nearer_triangle(SceneView scene, FRAME frame, Nearest nearest, uint at)
{
    COUNT_TRIANGLE();
    real depth = triangle_depth(scene, frame, at);
    if (depth > nearest.limit) return nearest;
    uint triangle = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at).w;
    PRECISE real behind = depth + NEAR_DEPTH;
    PRECISE real far_behind = behind + NEAR_DEPTH;
    Nearest found;
    found.limit = minimum(nearest.limit, behind);
    found.triangle = triangle;
    found.at = at;
    if (far_behind >= nearest.limit && nearest.triangle != NO_HIT) {
        if (triangle == nearest.triangle) return nearest; // a split one
        if (DEFERS_TIES) {
            found.limit = real(0.0f);
            found.triangle = DEFERRED;
            return found;
        }
        if (!is_before_exactly(scene, ray_of(frame), at, depth, nearest.at, triangle_depth(scene, frame, nearest.at)))
            return nearest;
    }
    return found;
}
#undef FRAME

KERNEL_FN Hit hit_of(SceneView scene, Ray ray, Nearest nearest)
{
    const uint other_end = DEFERS_TIES ? DEFERRED : NO_HIT; // no constant operand of ||, of which PoCL's compiler warns
    if (nearest.triangle == NO_HIT || nearest.triangle == other_end) return make_no_hit(nearest.triangle, NO_TET, 0u);
    uint4 r0 = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * nearest.at);
    uint4 r1 = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * nearest.at + 1u);
    uint4 r2 = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * nearest.at + 2u);
    Vec3 v0 = VEC3(as_real(r0.x), as_real(r0.y), as_real(r0.z));
    Vec3 v1 = VEC3(as_real(r1.x), as_real(r1.y), as_real(r1.z));
    Vec3 v2 = VEC3(as_real(r2.x), as_real(r2.y), as_real(r2.z));
    return make_hit(ray, nearest.triangle, v0, sub3(v1, v0), sub3(v2, v0), NO_TET, 0u);
}

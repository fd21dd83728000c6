// bvh/: the BVH layouts with their traversals, and what these share.

// What the BVHs share: a ray as their tests take it, boxes, and the triangle test (docs/spec/bvhs.md, B4).
#include "kernels/shear.h"

#include "kernels/stack.h"

// For a build that counts what a ray fetches. That build is never timed.
#ifndef COUNT_NODE
#define COUNT_NODE()
#define COUNT_TRIANGLE()
#endif

// Depth is the distance from the ray's origin along the axis of the direction's largest component, in the direction's
// sense: t times the magnitude of that component.
STRUCT(RayFrame)
{
    Vec3 origin;
    Vec3 inverse; // the depth of one unit along each axis
    Vec3 offset;  // origin * inverse
    uint axis;    // of the direction's largest component
    Vec3 shear;   // the direction times 2^20, its axes in cyclic order and `axis` the third; x and y negated
};

// A vertex as a ray sees it.
STRUCT(Seen)
{
    Sheared at; // the ray is the origin
    real depth; // times 2^40
};

// The nearest hit so far.
STRUCT(Nearest)
{
    real depth;
    uint triangle; // of the input, or NO_HIT: then depth is the ray's end
    uint at;       // one of the leaf triangles that refer to it
};

// Depth of a box that the ray does not enter.
#define NEVER real(3.0e38f)
// More than rounding can change a depth in a box test; needed only where bounds of different axes are compared.
#define BOX_SLACK real(1.000003814697265625f) // 1 + 2^-18
// A hit lies before the ray's origin unless its depth is at least 2^-100.
#define LEAST_DEPTH real(8.67361737988403547e-19f) // 2^-60, in depth times 2^40

// A function, because glslang does not terminate on a precise local that depends on a struct which the loop assigns as
// a whole.
KERNEL_FN real with_slack(real depth)
{
    PRECISE real result = depth * BOX_SLACK;
    return result;
}

// A ray that does not move along an axis gets a large finite quotient (Aila and Laine 2009).
KERNEL_FN real depth_per_unit(real deepest, real direction)
{
    PRECISE real quotient = deepest / (direction == real(0.0f) ? real(8.27180612553027675e-25f) : direction); // 2^-80
    return quotient;
}

KERNEL_FN RayFrame frame_of(Ray ray)
{
    real deepest = component(ray.direction, deepest_axis(ray.direction));
    RayFrame frame;
    frame.origin = ray.origin;
    frame.axis = deepest_axis(ray.direction);
    Vec3 turned = turned_from(ray.direction, frame.axis);
    PRECISE real shear_x = turned.x * real(-1048576.0f);
    PRECISE real shear_y = turned.y * real(-1048576.0f);
    PRECISE real shear_z = turned.z * real(1048576.0f);
    frame.shear = VEC3(shear_x, shear_y, shear_z);
    frame.inverse =
        VEC3(depth_per_unit(magnitude(deepest), ray.direction.x), depth_per_unit(magnitude(deepest), ray.direction.y),
             depth_per_unit(magnitude(deepest), ray.direction.z));
    PRECISE real offset_x = ray.origin.x * frame.inverse.x;
    PRECISE real offset_y = ray.origin.y * frame.inverse.y;
    PRECISE real offset_z = ray.origin.z * frame.inverse.z;
    frame.offset = VEC3(offset_x, offset_y, offset_z);
    return frame;
}

// The ray of a frame, exactly: products with powers of two are not rounded. A GPU has no registers for it beside the
// frame.
KERNEL_FN Ray ray_of(RayFrame frame)
{
    PRECISE real a = frame.shear.x * real(-9.5367431640625e-7f); // 2^-20
    PRECISE real b = frame.shear.y * real(-9.5367431640625e-7f);
    PRECISE real c = frame.shear.z * real(9.5367431640625e-7f);
    real x = frame.axis == 0u ? c : frame.axis == 1u ? b : a;
    real y = frame.axis == 0u ? a : frame.axis == 1u ? c : b;
    real z = frame.axis == 0u ? b : frame.axis == 1u ? a : c;
    return make_ray(frame.origin, VEC3(x, y, z));
}

// end: ray parameter. A value above 2^64 means no end; a value below 2^-60 means the origin.
KERNEL_FN Nearest nothing_before(Ray ray, real end)
{
    Nearest nearest;
    real bounded = end < real(8.67361737988403547e-19f) ? real(0.0f) : minimum(end, real(18446744073709551616.0f));
    PRECISE real depth = bounded * magnitude(component(ray.direction, deepest_axis(ray.direction)));
    nearest.depth = depth;
    nearest.triangle = NO_HIT;
    nearest.at = 0u;
    return nearest;
}

// A vertex is needed only as its two coordinates and its depth: a GPU has no registers for more of three vertices.
KERNEL_FN Seen seen_by(RayFrame frame, uint4 quad)
{
    Vec3 offset = sub3(VEC3(as_real(quad.x), as_real(quad.y), as_real(quad.z)), frame.origin);
    Vec3 turned = turned_from(offset, frame.axis);
    real forwards = frame.shear.z < real(0.0f) ? real(-1099511627776.0f) : real(1099511627776.0f); // 2^40
    PRECISE real x = turned.x * frame.shear.z + turned.z * frame.shear.x;
    PRECISE real y = turned.y * frame.shear.z + turned.z * frame.shear.y;
    PRECISE real depth = turned.z * forwards;
    Seen seen;
    seen.at.x = x;
    seen.at.y = y;
    seen.depth = depth;
    return seen;
}

// Quotients that are compared must have the same bits everywhere; division does not guarantee that. a: normal, 2^-126
// to 2^124.
KERNEL_FN real reciprocal(real a)
{
    real guess = as_real(0x7EF311C3u - as_bits(a));
    PRECISE real first = guess * (real(2.0f) - a * guess);
    PRECISE real second = first * (real(2.0f) - a * first);
    PRECISE real third = second * (real(2.0f) - a * second);
    return third;
}

KERNEL_FN bool has_two_signs(real a, real b, real c)
{
    return minimum(minimum(a, b), c) < real(0.0f) && maximum(maximum(a, b), c) > real(0.0f);
}

// Tests leaf triangle `at`. Of equally near triangles the first in the input wins, in any order of the tests.
// Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013; here without a division.
KERNEL_FN Nearest nearer_triangle(SceneView scene, RayFrame frame, Nearest nearest, uint at)
{
    COUNT_TRIANGLE();
    uint4 quad = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at);
    Seen a = seen_by(frame, quad);
    Seen b = seen_by(frame, FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at + 1u));
    Seen c = seen_by(frame, FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at + 2u));
    if (has_two_signs(rough_side(b.at, c.at), rough_side(c.at, a.at), rough_side(a.at, b.at))) return nearest;

    real u = fine_side(b.at, c.at);
    real v = fine_side(c.at, a.at);
    real w = fine_side(a.at, b.at);
    PRECISE real determinant = u + v + w;
    if (has_two_signs(u, v, w) || determinant == real(0.0f)) return nearest;
    PRECISE real weighted = u * a.depth + v * b.depth + w * c.depth;
    PRECISE real inverse = reciprocal(magnitude(determinant));
    PRECISE real scaled = (determinant < real(0.0f) ? -weighted : weighted) * inverse;
    PRECISE real depth = scaled * real(9.09494701772928238e-13f); // 2^-40
    bool nearer = depth < nearest.depth || (depth == nearest.depth && quad.w < nearest.triangle);
    if (scaled < LEAST_DEPTH || !nearer) return nearest;
    Nearest found;
    found.depth = depth;
    found.triangle = quad.w;
    found.at = at;
    return found;
}

KERNEL_FN Hit hit_of(SceneView scene, Ray ray, Nearest nearest)
{
    if (nearest.triangle == NO_HIT) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint4 r0 = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * nearest.at);
    uint4 r1 = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * nearest.at + 1u);
    uint4 r2 = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * nearest.at + 2u);
    Vec3 v0 = VEC3(as_real(r0.x), as_real(r0.y), as_real(r0.z));
    Vec3 v1 = VEC3(as_real(r1.x), as_real(r1.y), as_real(r1.z));
    Vec3 v2 = VEC3(as_real(r2.x), as_real(r2.y), as_real(r2.z));
    return make_hit(ray, nearest.triangle, v0, sub3(v1, v0), sub3(v2, v0), NO_TET, 0u);
}

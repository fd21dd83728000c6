// What a walk along a path carries from tet to tet.
#ifndef TETRACE_KERNELS_WALKS_CARRIED_H
#define TETRACE_KERNELS_WALKS_CARRIED_H

#include "kernels/methods/signs.h"

// A vertex that a walk along a path carries, as the ray sees it: one of the three of its current face. A step projects
// one new vertex, the apex of the next tet, and two signs select the vertex that it replaces.
STRUCT(Carried)
{
    Sheared seen;
    real along; // its depth, as ends_before() of half_faces.h has it; not used for rays without an end
};

KERNEL_FN Carried carried(Ray ray, Shear shear, uint4 vertex)
{
    Vec3 offset = sub3(VEC3(as_real(vertex.x), as_real(vertex.y), as_real(vertex.z)), ray.origin);
    Carried result;
    result.seen = sheared(shear, offset);
    result.along = dot3(offset, ray.direction);
    return result;
}

// A corner of the face by which a ray without an end enters.
KERNEL_FN Carried carried_from(Sheared corner)
{
    Carried result;
    result.seen = corner;
    result.along = real(0.0f);
    return result;
}

// Which of the face's vertices the apex replaces: the ray leaves by the face that has it in that vertex's place. The
// two tests of maria: of the edges that end in the apex, that from p2, then that from p0 or p1.
KERNEL_FN uint replaced_by(Sheared p0, Sheared p1, Sheared p2, Sheared apex)
{
    bool left = is_apex_left(p2, apex);
    bool other_left = is_apex_left(left ? p1 : p0, apex);
    return other_left ? (left ? 2u : 1u) : (left ? 0u : 2u);
}

// The same, using only float products; UNDECIDED at a tie.
#define UNDECIDED 3u
KERNEL_FN uint roughly_replaced_by(Sheared p0, Sheared p1, Sheared p2, Sheared apex)
{
    PRECISE real plus = p2.x * apex.y;
    PRECISE real minus = p2.y * apex.x;
    bool left = plus > minus;
    PRECISE real other_plus = (left ? p1.x : p0.x) * apex.y;
    PRECISE real other_minus = (left ? p1.y : p0.y) * apex.x;
    uint replaced = other_plus > other_minus ? (left ? 2u : 1u) : (left ? 0u : 2u);
    return plus == minus || other_plus == other_minus ? UNDECIDED : replaced;
}

#endif

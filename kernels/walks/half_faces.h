// Shared by the walks that read a face's opposite half-face: that half-face, whether the ray ends before the next tet,
// and the hit at the end.
#ifndef TETRACE_KERNELS_WALKS_HALF_FACES_H
#define TETRACE_KERNELS_WALKS_HALF_FACES_H

#include KERNEL_LAYOUT_HEADER
#include "kernels/layouts/faces.h"
#include "kernels/walks/triangle_hit.h"

// The opposite half-face of a face; NO_HALF_FACE if the face is NO_EXIT or not decided yet. A face from 0 to 3 is read
// in any case: all lanes then load alike, and none loads past the last tet.
KERNEL_FN uint opposite_or_none(SceneView scene, uint tet, uint face)
{
    uint half_face = opposite_half_face(scene, tet, face & 3u);
    return face >= NO_EXIT ? NO_HALF_FACE : half_face;
}

// Whether the ray ends before it enters the tet of the half-face: all three vertices of the face are past its end along
// its direction. Rounding does not matter here: hits past the end are discarded later.
KERNEL_FN bool ends_before(SceneView scene, uint half_face, Ray ray, real end)
{
    PRECISE real reach = end * dot3(ray.direction, ray.direction);
    uint tet = half_face >> 2u;
    uint face = half_face & 3u;
    if (dot3(sub3(vertex(scene, tet, corner(face, 0u)), ray.origin), ray.direction) <= reach) return false;
    if (dot3(sub3(vertex(scene, tet, corner(face, 1u)), ray.origin), ray.direction) <= reach) return false;
    return dot3(sub3(vertex(scene, tet, corner(face, 2u)), ray.origin), ray.direction) > reach;
}

// The hit of a walk that has ended after `steps` tets, with this exit face of the last one.
KERNEL_FN Hit hit_at_end(SceneView scene, TraceParams params, Ray ray, uint tet, uint face, uint steps, real end)
{
    uint hit_triangle = face_triangle(scene, tet, face);
    if (hit_triangle != FREE_FACE) return hit_on(scene, ray, hit_triangle, tet, steps, end);
    bool is_outside = opposite_half_face(scene, tet, face) == NO_HALF_FACE;
    bool ended = end < real(NO_END) && steps < params.max_steps;
    return make_no_hit(is_outside || ended ? NO_HIT : LOST, tet, steps);
}

#endif

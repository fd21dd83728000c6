// The walk from tet to tet by the opposite half-faces of faces. A method's exit_face() and start_face() return a face
// of the tet, or NO_EXIT: the walk is then lost.
#ifndef TETRACE_KERNELS_WALKS_WALK_BY_NEIGHBOURS_H
#define TETRACE_KERNELS_WALKS_WALK_BY_NEIGHBOURS_H

#include KERNEL_METHOD_HEADER
#include "kernels/walks/entry_nearest.h"
#include "kernels/walks/half_faces.h"

// From a tet and the face by which the ray leaves it to the ray's hit. end: the largest ray parameter of a hit; NO_END
// for a ray without an end. After STEPS_BEFORE_DOUBT steps the walk halts at each step, and compares the half-face with
// the one that it saved at the last power of two (Brent, "An improved Monte Carlo factorization algorithm", BIT 20,
// 1980): a walk in a circle ends as if it had reached its cap.
// Only the loops' own variables are used after the loops; everything else is loaded again, because some compilers lose
// it.
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, uint first_tet, uint first_face, real end)
{
    bool is_endless = end >= real(NO_END);
    uint tet = first_tet;
    uint face = first_face;
    uint half_face = opposite_or_none(scene, tet, face);
    uint triangle = face_triangle(scene, tet, face & 3u);
    uint steps = 1u;
    uint pause = first_pause(params);
    uint saved = NO_HALF_FACE;
    for (;;) {
        while (triangle == FREE_FACE && half_face != NO_HALF_FACE && steps < pause &&
               (is_endless || !ends_before(scene, half_face, ray, end))) {
            tet = half_face >> 2u;
            face = exit_face(scene, tet, half_face & 3u, ray);
            half_face = opposite_or_none(scene, tet, face);
            triangle = face_triangle(scene, tet, face & 3u);
            ++steps;
        }
        if (triangle != FREE_FACE || half_face == NO_HALF_FACE || steps < pause || steps >= params.max_steps) break;
        pause = steps + 1u;
        if (half_face == saved) {
            steps = params.max_steps;
            break;
        }
        saved = (steps & (steps - 1u)) == 0u ? half_face : saved;
    }
    if (face == NO_EXIT) return make_no_hit(LOST, tet, steps - 1u);
    return hit_at_end(scene, params, ray, tet, face, steps, end);
}

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    uint tet = params.start_tet;
    uint face = 0u;
    if (tet == NO_TET) {
        uint entry = entry_half_face(scene, entry_index(scene, ray));
        if (entry == NO_HALF_FACE) return make_no_hit(NO_HIT, NO_TET, 0u);
        tet = entry >> 2u;
        face = exit_face(scene, tet, entry & 3u, ray);
    } else {
        face = start_face(scene, tet, ray);
    }
    return walk(scene, params, ray, tet, face, real(NO_END));
}

// A given ray starts on its half-face, on the side of that tet. A method never leaves a tet by the face by which it
// entered, so the surface that a ray starts on is not hit again.
KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    uint half_face = direction.w;
    if (half_face == NO_HALF_FACE) half_face = entry_half_face(scene, entry_index(scene, ray));
    if (half_face == NO_HALF_FACE) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint face = exit_face(scene, half_face >> 2u, half_face & 3u, ray);
    return walk(scene, params, ray, half_face >> 2u, face, as_real(origin.w));
}

#endif

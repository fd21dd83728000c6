// The walk from tet to tet along a ray's path, for methods that define WALKS_PATHS, which always find an exit. Such a
// method defines rough_exit_face(), which returns TIE_AT | entry at a tie; exit_face() then decides after the loop.
// Ties are rare, and cost other steps nothing, even on devices that execute a conditional block if no lane needs it.
#ifndef TETRACE_KERNELS_WALKS_WALK_ALONG_PATHS_H
#define TETRACE_KERNELS_WALKS_WALK_ALONG_PATHS_H

#include "kernels/walks/half_faces.h"
#include "kernels/walks/path.h"

// How a walk begins.
#define WalkStart Exit

// By the boundary face of the half-face.
#define WALK_START_AT(scene, ray, half_face, entrance)                                                                 \
    walk_start_in((half_face) >> 2u, rough_exit_face(scene, (half_face) >> 2u, (half_face)&3u, ray))

// In a tet whose exit face is `face`, or NO_EXIT.
#define WALK_START_IN(scene, ray, shear, tet, face) walk_start_in(tet, face)
KERNEL_FN WalkStart walk_start_in(uint tet, uint face)
{
    WalkStart first;
    first.tet = tet;
    first.face = face;
    return first;
}

// From its beginning to the ray's hit. end: the largest ray parameter of a hit; NO_END
// for a ray without an end. start: the triangle that a ray from inside starts on, or FREE_FACE; FROM_OUTSIDE for a ray
// from outside. A ray from inside begins with exit_ahead() if its first face is NO_EXIT, and again if its walk is in a
// circle, which it checks once, after STEPS_BEFORE_DOUBT steps.
// Only the loops' own variables are used after the loops; everything else is loaded again, because some compilers lose
// it.
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, WalkStart first, uint start, real end)
{
    bool is_endless = end >= real(NO_END);
    bool has_exit = start == FROM_OUTSIDE || first.face != NO_EXIT;
    uint own = has_exit ? (first.tet << 2u) | first.face : NO_HALF_FACE;
    bool may_begin_anew = start != FROM_OUTSIDE;
    uint pause = may_begin_anew ? first_pause(params) : params.max_steps;
    uint tet = first.tet;
    uint face = has_exit ? first.face : 0u;
    uint half_face = has_exit ? opposite_or_none(scene, tet, face) : NO_HALF_FACE;
    uint triangle = face_triangle(scene, tet, face & 3u);
    uint steps = 1u;
    for (;;) {
        for (;;) {
            while (triangle == FREE_FACE && half_face != NO_HALF_FACE && steps < pause &&
                   (is_endless || !ends_before(scene, half_face, ray, end))) {
                tet = half_face >> 2u;
                face = rough_exit_face(scene, tet, half_face & 3u, ray);
                half_face = opposite_or_none(scene, tet, face);
                triangle = face_triangle(scene, tet, face & 3u);
                ++steps;
            }
            if (DEFERS_TIES || face < TIE_AT) break;
            face = exit_face(scene, tet, face & 3u, ray);
            half_face = opposite_half_face(scene, tet, face);
            triangle = face_triangle(scene, tet, face);
        }
        bool is_paused = steps >= pause && half_face != NO_HALF_FACE && triangle == FREE_FACE;
        if (!may_begin_anew || (own != NO_HALF_FACE && !is_paused)) break;
        uint exit = exit_ahead(scene, params, ray, start, own);
        pause = params.max_steps;
        may_begin_anew = false;
        tet = exit >> 2u;
        if (exit == NO_HALF_FACE) break;
        face = exit & 3u;
        half_face = opposite_half_face(scene, tet, face);
        triangle = face_triangle(scene, tet, face);
        steps = 1u;
    }
    if (DEFERS_TIES && face >= TIE_AT) return make_no_hit(DEFERRED, tet, steps);
    if (tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    return hit_at_end(scene, params, ray, tet, face, steps, end);
}

#endif

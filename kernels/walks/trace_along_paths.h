// From a ray to its walk along its path.
// Include it after walk_by_records.h or walk_along_paths.h, one of which defines walk() and how it begins.
#ifndef TETRACE_KERNELS_WALKS_TRACE_ALONG_PATHS_H
#define TETRACE_KERNELS_WALKS_TRACE_ALONG_PATHS_H

#include "kernels/walks/path.h"

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    Shear shear = shear_of(ray);
    WalkStart first;
    uint start = params.start_tet == NO_TET ? FROM_OUTSIDE : FREE_FACE; // here a compiler sees that it is constant
    if (params.start_tet == NO_TET) {
        Entrance entrance = entrance_of(scene, ray, shear);
        uint half_face = entry_half_face(scene, entrance.index);
        if (half_face == NO_HALF_FACE) return make_no_hit(entrance.index == DEFERRED ? DEFERRED : NO_HIT, NO_TET, 0u);
        first = WALK_START_AT(scene, ray, half_face, entrance);
    } else {
        first = WALK_START_IN(scene, ray, shear, params.start_tet, start_face(scene, params.start_tet, ray));
    }
    return walk(scene, params, ray, first, start, real(NO_END));
}

// A given ray starts on its half-face, on the side of that tet. exit_from_face() tests whether that face is on the
// ray's path, so the surface that a ray starts on is not hit again.
KERNEL_FN Hit trace_given(SceneView scene, TraceParams params, uint4 direction, uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    Shear shear = shear_of(ray);
    uint half_face = direction.w;
    if (half_face == NO_HALF_FACE) half_face = entry_half_face(scene, entrance_of(scene, ray, shear).index);
    if (half_face == NO_HALF_FACE) return make_no_hit(NO_HIT, NO_TET, 0u);
    Exit exit = exit_from_face(scene, ray, half_face);
    if (exit.tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint start = face_triangle(scene, half_face >> 2u, half_face & 3u);
    WalkStart first = WALK_START_IN(scene, ray, shear, exit.tet, exit.face);
    return walk(scene, params, ray, first, start, as_real(origin.w));
}

#endif

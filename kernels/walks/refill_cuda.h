// Persistent warps for walks through records (kernels/refill_cuda.h; docs/spec/devices.md, W11). Lanes take a few steps
// from one vote to the next. What few rays need, a walk that begins anew or may be in a circle, is left to trace() and
// trace_given(), which then trace the ray from its beginning.
#ifndef TETRACE_KERNELS_WALKS_REFILL_CUDA_H
#define TETRACE_KERNELS_WALKS_REFILL_CUDA_H

#include "kernels/refill_cuda.h"
#include "kernels/walks/trace_along_paths.h"

#ifndef STEPS_PER_VOTE
#define STEPS_PER_VOTE 4u
#endif

// The walk at its beginning, as trace() and trace_given() begin it; after 0 steps, and ended, if there is none. If it
// begins anew, it has as many steps as a walk may have, and goes on.
template <class Rays>
KERNEL_FN Walker walker_beginning(SceneView scene, TraceParams params, const Rays& rays, uint item, Ray ray,
                                  Shear shear)
{
    Walker none = {};
    none.exit = NO_HALF_FACE;
    Exit exit = {params.start_tet, 0u};
    if (rays.are_given()) {
        uint half_face = rays.half_face(item);
        if (half_face == NO_HALF_FACE) half_face = entry_half_face(scene, entrance_of(scene, ray, shear).index);
        if (half_face == NO_HALF_FACE) return none;
        exit = exit_from_face(scene, ray, half_face);
        if (exit.tet == NO_TET) return none;
    } else if (params.start_tet == NO_TET) {
        Entrance entrance = entrance_of(scene, ray, shear);
        uint half_face = entry_half_face(scene, entrance.index);
        return half_face == NO_HALF_FACE ? none : WALK_START_AT(scene, ray, half_face, entrance).at;
    } else {
        exit.face = start_face(scene, exit.tet, ray);
    }
    Walker first = WALK_START_IN(scene, ray, shear, exit.tet, exit.face).at;
    if (exit.face == NO_EXIT) {
        first.exit = exit_to(0u);
        first.steps = params.max_steps;
    }
    return first;
}

template <class Rays>
KERNEL_FN void trace_refilled(SceneView scene, TraceParams params, const Rays& rays, uint* counter)
{
    bool may_begin_anew = rays.are_given() || params.start_tet != NO_TET;
    uint pause = may_begin_anew ? first_pause(params) : params.max_steps;
    Ray ray = {};
    Shear shear = {};
    Walker at = {};
    bool is_endless = true;
    real reach = real(0.0f);
    refill_lanes(
        rays, counter,
        [&](uint item) {
            ray = rays.ray(item);
            shear = shear_of(ray);
            real end = rays.end(item);
            is_endless = end >= real(NO_END);
            reach = reach_of(ray, end);
            at = walker_beginning(scene, params, rays, item, ray, shear);
            return goes_on(at, pause, is_endless, reach);
        },
        [&](uint) {
            uint halt = pause - at.steps < STEPS_PER_VOTE ? pause : at.steps + STEPS_PER_VOTE;
            do {
                at = next_face(scene, ray, shear, at);
            } while (goes_on(at, halt, is_endless, reach));
            if (at.exit == EXIT_AT_TIE) at = face_at_tie(scene, ray, shear, at);
            return goes_on(at, pause, is_endless, reach);
        },
        [&](uint item) {
            Walker ended = at; // reset before what takes many registers: else the compiler keeps the old walk there
            ray = {};
            shear = {};
            at = {};
            bool is_paused = (ended.exit & 3u) != EXIT_END && ended.steps >= pause;
            if (may_begin_anew && is_paused) return rays.traced(scene, item);
            return hit_after(scene, params, rays.ray(item), ended, rays.end(item));
        });
}

#endif

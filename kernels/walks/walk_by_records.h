// The walk of project through records (half32.h, tet64.h): it carries the vertices of the current face. Decisions, and
// so the bits of the hits, are the same as in walk_along_paths.h on tets that store their vertices
// (docs/spec/layouts.md, L4). Corner i of a record's entry face is the carried vertex (i + rotation) % 3. How an exit
// changes the rotation, and how the rotation selects an exit, is the layout's.
#ifndef TETRACE_KERNELS_WALKS_WALK_BY_RECORDS_H
#define TETRACE_KERNELS_WALKS_WALK_BY_RECORDS_H

#include "kernels/walks/carried.h"
#include "kernels/walks/path.h"
#include "kernels/walks/triangle_hit.h"

// What is across a face of the tet in which a walk starts, as a record's exit without a rotation: the corners are then
// fetched from memory.
KERNEL_FN uint first_exit(SceneView scene, uint tet, uint face)
{
    uint exit = exit_through(scene, tet, face);
    return (exit & 3u) == EXIT_END ? exit : exit & ~3u;
}

// The state of a walk: the current face, and what is across it.
STRUCT(Walker)
{
    Carried p0;
    Carried p1;
    Carried p2;
    uint rotation; // in the previous record, changed by ROTATION_AFTER()
    uint exit;     // of that record, or EXIT_AT_TIE
    uint before;   // the exit that led to that record
    uint steps;
};

// pause: the number of steps at which the walk halts. reach: of the end, as ends_before() of half_faces.h has it.
KERNEL_FN bool goes_on(Walker at, uint pause, bool is_endless, real reach)
{
    return (at.exit & 3u) != EXIT_END && at.steps < pause &&
           (is_endless || at.p0.along <= reach || at.p1.along <= reach || at.p2.along <= reach);
}

// The walker with the apex of its previous record in place of a carried vertex; its exit is still to be set.
KERNEL_FN Walker with_apex(Walker at, Carried apex, uint replaced)
{
    Walker next = at;
    next.p0 = replaced == 0u ? apex : at.p0;
    next.p1 = replaced == 1u ? apex : at.p1;
    next.p2 = replaced == 2u ? apex : at.p2;
    next.rotation = replaced == UNDECIDED ? at.rotation : ROTATION_AFTER(at.rotation, replaced);
    return next;
}

#ifdef KEEP_BRANCH
#include "kernels/walks/next_face_predicted.h"
#else
// The exit face of the tet across the current face, or a tie, if float products do not decide it. One branch ends the
// loop around it: nothing waits only for the record's second half.
KERNEL_FN Walker next_face(SceneView scene, Ray ray, Shear shear, Walker at)
{
    uint record = record_across(at.exit);
    Carried apex = carried(ray, shear, record_apex(scene, record));
    RecordExits exits = RECORD_EXITS(scene, record);
    uint rotation = rotation_at(at.rotation, at.exit);
    uint replaced = roughly_replaced_by(at.p0.seen, at.p1.seen, at.p2.seen, apex.seen);
    Walker next = at;
    next.rotation = rotation;
    next.before = at.exit;
    next = with_apex(next, apex, replaced);
    uint exit = EXIT_REPLACING(scene, exits, rotation, replaced);
    next.exit = replaced == UNDECIDED ? EXIT_AT_TIE : exit;
    next.steps = at.steps + 1u; // last: the OpenCL of NVIDIA 580.159 loses steps that are counted before the selects
    return next;
}
#endif

// The same at a tie, which the step to `at` has left undecided.
KERNEL_FN Walker face_at_tie(SceneView scene, Ray ray, Shear shear, Walker at)
{
    uint record = record_across(at.before);
    uint rotation = at.rotation >= 3u ? at.rotation - 3u : at.rotation;
    Carried apex = carried(ray, shear, record_apex(scene, record));
    uint replaced = replaced_by(at.p0.seen, at.p1.seen, at.p2.seen, apex.seen);
    RecordExits exits = RECORD_EXITS(scene, record);
    Walker next = with_apex(at, apex, replaced);
    next.exit = EXIT_REPLACING(scene, exits, rotation, replaced);
    return next;
}

// A walk at an exit of `tet`, after it has left `steps` tets.
KERNEL_FN Walker walker_with(Carried p0, Carried p1, Carried p2, uint tet, uint exit, uint steps)
{
    Walker at;
    at.p0 = p0;
    at.p1 = p1;
    at.p2 = p2;
    at.rotation = 0u;
    at.exit = exit;
    at.before = exit_to(tet << 2u);
    at.steps = steps;
    return at;
}

// The walk at its first exit face.
KERNEL_FN Walker walker_leaving(SceneView scene, Ray ray, Shear shear, uint tet, uint face)
{
    uint exit = first_exit(scene, tet, face);
    uint record = (exit & 3u) == EXIT_END ? tet << 2u : record_across(exit);
    return walker_with(carried(ray, shear, record_apex(scene, record_of_corner(record, 0u))),
                       carried(ray, shear, record_apex(scene, record_of_corner(record, 1u))),
                       carried(ray, shear, record_apex(scene, record_of_corner(record, 2u))), tet, exit, 1u);
}

// How a walk begins.
STRUCT(WalkStart)
{
    Walker at;
    uint own; // the face by which the ray leaves its first tet, as tet << 2 | face; NO_HALF_FACE if there is none
};

// By the boundary face of the half-face.
#define WALK_START_AT(scene, ray, half_face, entrance) walk_start_at(half_face, entrance)
KERNEL_FN WalkStart walk_start_at(uint half_face, Entrance entrance)
{
    WalkStart first;
    first.at = walker_with(carried_from(entrance.p0), carried_from(entrance.p1), carried_from(entrance.p2),
                           half_face >> 2u, exit_to(half_face), 0u);
    first.at.rotation = ROTATION_OF_CORNERS(half_face & 3u);
    first.own = half_face;
    return first;
}

// In a tet whose exit face is `face`, or NO_EXIT.
#define WALK_START_IN(scene, ray, shear, tet, face) walk_start_in(scene, ray, shear, tet, face)
KERNEL_FN WalkStart walk_start_in(SceneView scene, Ray ray, Shear shear, uint tet, uint face)
{
    WalkStart first;
    first.at = walker_leaving(scene, ray, shear, tet, face & 3u);
    first.own = (tet << 2u) | face;
    if (face == NO_EXIT) first.at.exit = NO_HALF_FACE;
    if (face == NO_EXIT) first.own = NO_HALF_FACE;
    return first;
}

// From its beginning to the ray's hit. start, end and the use of exit_ahead(): as in walk_along_paths.h. Loops test at
// their end, and ties are decided after the inner loop: some devices execute a conditional block even if no lane needs
// it (docs/spec/devices.md, W1).
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, WalkStart first, uint start, real end)
{
    Shear shear = shear_of(ray);
    bool is_endless = end >= real(NO_END);
    PRECISE real reach = end * dot3(ray.direction, ray.direction);
    bool may_begin_anew = start != FROM_OUTSIDE;
    uint pause = may_begin_anew ? first_pause(params) : params.max_steps;
    Walker at = first.at;
    for (;;) {
        if (goes_on(at, pause, is_endless, reach)) {
            for (;;) {
                for (;;) {
                    at = next_face(scene, ray, shear, at);
                    if (!goes_on(at, pause, is_endless, reach)) break;
                }
                if (DEFERS_TIES || at.exit != EXIT_AT_TIE) break;
                at = face_at_tie(scene, ray, shear, at);
                if (!goes_on(at, pause, is_endless, reach)) break;
            }
        }
        bool is_paused = (at.exit & 3u) != EXIT_END && at.steps >= pause;
        if (!may_begin_anew || (first.own != NO_HALF_FACE && !is_paused)) break;
        uint ahead = exit_ahead(scene, params, ray, start, first.own);
        pause = params.max_steps;
        may_begin_anew = false;
        if (ahead == NO_HALF_FACE) at.steps = 0u;
        if (ahead == NO_HALF_FACE) break;
        at = walker_leaving(scene, ray, shear, ahead >> 2u, ahead & 3u);
    }
    if (at.steps == 0u) return make_no_hit(NO_HIT, NO_TET, 0u);
    uint tet = record_across(at.before) >> 2u;
    uint deferred =
        DEFERS_TIES ? EXIT_AT_TIE : NO_HALF_FACE; // no constant operand of ||, of which PoCL's compiler warns
    if (at.exit == NO_HALF_FACE || at.exit == deferred)
        return make_no_hit(at.exit == NO_HALF_FACE ? NO_HIT : DEFERRED, tet, at.steps);
    if ((at.exit & 3u) == EXIT_END) return hit_on(scene, ray, record_across(at.exit), tet, at.steps, end);
    return make_no_hit(!is_endless && at.steps < params.max_steps ? NO_HIT : LOST, tet, at.steps);
}

#endif

// Task segments: every tet that a given ray crosses, from where it enters the domain, or from its origin, to where it
// leaves the domain (docs/spec/volume.md). Task tally: the same, and for each tet the sum of the lengths of all rays
// inside it. Task absorb: the light of a medium in these tets, until it lets no more pass. The walk passes through
// occlusive faces. It is a method's own: tets, and so their hash, are the same on all layouts.
#ifndef TETRACE_KERNELS_WALKS_SEGMENTS_H
#define TETRACE_KERNELS_WALKS_SEGMENTS_H

#include KERNEL_METHOD_HEADER
#include KERNEL_LAYOUT_HEADER
#include "kernels/layouts/faces.h"
#include "kernels/walks/absorption.h"
#include "kernels/walks/places.h"

#define CROSSES_TETS

// For a build that notes each tet, and where the ray leaves it; that build is never timed.
#ifndef NOTE_BEGIN
#define NOTE_BEGIN(place)
#define NOTE_CROSSING(tet, place)
#endif

// Task tally: the sums of the tets, two words each, lower word first. Entry files with that task define how a word is
// added to (kernel.h); others have no sums.
#ifndef ADD_TO_SUM
#define LENGTH_SUMS uint
#define NO_SUMS 0u
#define HAS_SUMS(sums) false
#define ADD_LENGTH(sums, tet, length, is_undone)
#else
// Adds a length to the tet's sum, or takes it back. Sums are modulo 2^64, so any order of these atomic additions of
// words gives the same bits (docs/spec/volume.md, S9).
KERNEL_FN void add_length(LENGTH_SUMS sums, uint tet, uint length, bool is_undone)
{
    if (!HAS_SUMS(sums) || length == 0u) return;
    uint low = is_undone ? 0u - length : length;
    uint before = ADD_TO_SUM(sums, 2u * tet, low);
    uint high = (is_undone ? 0xFFFFFFFFu : 0u) + (before > 0xFFFFFFFFu - low ? 1u : 0u);
    if (high != 0u) ADD_TO_SUM(sums, 2u * tet + 1u, high);
}
#define ADD_LENGTH(sums, tet, length, is_undone) add_length(sums, tet, length, is_undone)
#endif

// A ray's answer, in the order of its words in the output. Of task absorb, `total` is the light and `reversed` the
// transmittance.
STRUCT(Segments)
{
    uint first;     // tet; or NO_HIT, if the ray crosses none; or LOST
    uint last;      // tet, or NO_TET
    uint total;     // length of all segments, in units of 2^-LENGTH_BITS
    uint hash;      // of the tets in order, each with the place where it is left
    uint reversed;  // faces whose place is before that of a face met earlier
    uint crossings; // tets left
};

KERNEL_FN Segments no_segments(bool absorbs)
{
    Segments none;
    none.first = NO_HIT;
    none.last = NO_TET;
    none.total = 0u;
    none.hash = 0u;
    none.reversed = absorbs ? NO_ABSORPTION : 0u;
    none.crossings = 0u;
    return none;
}

// A walk, in a tet that it leaves by `face`.
STRUCT(Crossing)
{
    uint tet;
    uint face;
    uint begin;    // place of its beginning
    uint farthest; // of the places so far
    Segments sum;  // so far; `total` is computed at the end
    Absorption absorption;
};

KERNEL_FN Crossing begin_crossing(uint tet, uint face, uint place)
{
    NOTE_BEGIN(place);
    Crossing at;
    at.tet = tet;
    at.face = face;
    at.begin = place;
    at.farthest = place;
    at.sum = no_segments(false);
    at.sum.first = tet;
    at.absorption = no_absorption();
    return at;
}

KERNEL_FN uint hash_with(uint hash, uint word)
{
    uint mixed = (hash ^ word) * 0x9E3779B1u;
    return mixed ^ (mixed >> 15u);
}

// Where the ray meets the half-face.
KERNEL_FN uint place_of_half_face(SceneView scene, Ray ray, uint half_face, uint stretch)
{
    uint tet = half_face >> 2u;
    uint face = half_face & 3u;
    return place_on_face(ray, vertex(scene, tet, corner(face, 0u)), vertex(scene, tet, corner(face, 1u)),
                         vertex(scene, tet, corner(face, 2u)), stretch);
}

// The walk after it has left its tet; tet and face are still those. is_undone: its length is taken back.
KERNEL_FN Crossing leaving_tet(SceneView scene, Ray ray, uint stretch, MAYBE_UNUSED LENGTH_SUMS sums, bool absorbs,
                               MAYBE_UNUSED bool is_undone, Crossing at)
{
    uint place = place_of_half_face(scene, ray, (at.tet << 2u) | at.face, stretch);
    NOTE_CROSSING(at.tet, place);
    Crossing next = at;
    next.farthest = place > at.farthest ? place : at.farthest;
    ADD_LENGTH(sums, at.tet, next.farthest - at.farthest, is_undone);
    if (absorbs) next.absorption = absorbed_in(at.tet, next.farthest - at.farthest, at.absorption);
    next.sum.last = at.tet;
    next.sum.hash = hash_with(hash_with(at.sum.hash, at.tet), place);
    next.sum.reversed = at.sum.reversed + (place < at.farthest ? 1u : 0u);
    next.sum.crossings = at.sum.crossings + 1u;
    return next;
}

// Whether the medium lets too little pass for the walk to go on.
KERNEL_FN bool is_absorbed(bool absorbs, Crossing at)
{
    return absorbs && at.absorption.transmittance < MIN_TRANSMITTANCE;
}

// The walk in the tet of the half-face by which it enters.
KERNEL_FN Crossing entering_tet(SceneView scene, Ray ray, uint half_face, Crossing at)
{
    Crossing next = at;
    next.tet = half_face >> 2u;
    next.face = exit_face(scene, next.tet, half_face & 3u, ray);
    return next;
}

#ifdef WALKS_PATHS
// Takes back the lengths of a walk that begins anew: of the first `count` tets, those that it has left.
KERNEL_FN void take_back(SceneView scene, Ray ray, uint stretch, LENGTH_SUMS sums, Crossing begin, uint count)
{
    Crossing at = begin;
    for (;;) {
        at = leaving_tet(scene, ray, stretch, sums, false, true, at);
        uint half_face = opposite_half_face(scene, at.tet, at.face);
        if (half_face == NO_HALF_FACE || at.sum.crossings >= count) break;
        at = entering_tet(scene, ray, half_face, at);
    }
}

KERNEL_FN uint entered_half_face(SceneView scene, Ray ray)
{
    return entry_half_face(scene, entrance_of(scene, ray, shear_of(ray)).index);
}
#else
KERNEL_FN uint entered_half_face(SceneView scene, Ray ray)
{
    return entry_half_face(scene, entry_index(scene, ray));
}

STRUCT(Exit)
{
    uint tet;
    uint face;
};

KERNEL_FN Exit exit_from_face(SceneView scene, Ray ray, uint half_face)
{
    Exit exit;
    exit.tet = half_face >> 2u;
    exit.face = exit_face(scene, exit.tet, half_face & 3u, ray);
    return exit;
}
#endif

// sums: to which each tet's length is added, or NO_SUMS. absorbs: for task absorb; without sums. direction, origin: the
// ray's quads. Walks from inside begin anew as those to a hit do (docs/spec/project.md, P6 and P8), but not if they are
// absorbed before that is tested. Other walks than those along paths cannot begin anew: they are lost where they are
// found in a circle (walk_by_neighbours.h), or where their method finds no exit.
KERNEL_FN Segments cross_tets(SceneView scene, TraceParams params, LENGTH_SUMS sums, bool absorbs, uint4 direction,
                              uint4 origin)
{
    Ray ray = given_ray(direction, origin);
    uint stretch = origin.w;
    bool from_outside = direction.w == NO_HALF_FACE;
    uint entry = from_outside ? entered_half_face(scene, ray) : direction.w;
    if (entry == NO_HALF_FACE) return no_segments(absorbs);
    Exit exit;
    exit.tet = entry >> 2u;
    exit.face = 0u;
    uint begin = 0u;
    if (from_outside) {
        exit.face = exit_face(scene, exit.tet, entry & 3u, ray);
        begin = place_of_half_face(scene, ray, entry, stretch);
    } else {
        exit = exit_from_face(scene, ray, entry);
        begin = place_of_point(ray, ray.origin, stretch);
    }
    if (exit.tet == NO_TET) return no_segments(absorbs);

#ifdef WALKS_PATHS
    bool may_begin_anew = !from_outside;
    uint own = exit.face == NO_EXIT ? NO_HALF_FACE : (exit.tet << 2u) | exit.face;
    uint pause = from_outside ? params.max_steps : first_pause(params);
#else
    uint pause = first_pause(params);
    uint saved = NO_HALF_FACE;
#endif
    uint half_face = NO_HALF_FACE;
    Crossing at = begin_crossing(exit.tet, exit.face, begin);
    for (;;) {
        if (at.face != NO_EXIT) {
            for (;;) {
                at = leaving_tet(scene, ray, stretch, sums, absorbs, false, at);
                half_face = opposite_half_face(scene, at.tet, at.face);
                if (half_face == NO_HALF_FACE || at.sum.crossings >= pause || is_absorbed(absorbs, at)) break;
                at = entering_tet(scene, ray, half_face, at);
#ifdef FINDS_NO_EXIT
                if (at.face == NO_EXIT) break;
#endif
            }
        }
        if (is_absorbed(absorbs, at)) half_face = NO_HALF_FACE;
#ifdef WALKS_PATHS
        bool is_paused = half_face != NO_HALF_FACE;
        if (!may_begin_anew || (own != NO_HALF_FACE && !is_paused)) break;
        may_begin_anew = false;
        pause = params.max_steps;
        uint ahead = exit_ahead(scene, params, ray, face_triangle(scene, entry >> 2u, entry & 3u), own);
        if (is_paused && ahead == own) {
            if (at.sum.crossings >= pause) break;
            at = entering_tet(scene, ray, half_face, at);
        } else {
            if (HAS_SUMS(sums) && at.sum.crossings != 0u)
                take_back(scene, ray, stretch, sums, begin_crossing(exit.tet, exit.face, begin), at.sum.crossings);
            half_face = NO_HALF_FACE;
            at = begin_crossing(ahead >> 2u, ahead & 3u, begin);
            if (ahead == NO_HALF_FACE) break;
        }
#else
#ifdef FINDS_NO_EXIT
        if (at.face == NO_EXIT) break;
#endif
        uint steps = at.sum.crossings;
        if (half_face == NO_HALF_FACE || half_face == saved || steps >= params.max_steps) break;
        pause = steps + 1u;
        saved = (steps & (steps - 1u)) == 0u ? half_face : saved;
        at = entering_tet(scene, ray, half_face, at);
#endif
    }
#ifdef FINDS_NO_EXIT
    if (at.face == NO_EXIT) {
        at.sum.first = LOST;
        at.sum.total = at.farthest - at.begin;
        return at.sum;
    }
#endif
    if (at.sum.crossings == 0u) return no_segments(absorbs);
    at.sum.total = absorbs ? at.absorption.light : at.farthest - at.begin;
    at.sum.reversed = absorbs ? at.absorption.transmittance : at.sum.reversed;
    if (half_face != NO_HALF_FACE) at.sum.first = LOST;
    return at.sum;
}

#endif

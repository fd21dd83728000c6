// The kernels of a CDT whose tets share their vertices: the walk of project through tets that are the xor of their
// vertices (tet20.h, tet16.h; docs/spec/layouts.md, L8). It carries the vertices of the current face and their numbers;
// the numbers and the xor give the tet's fourth vertex. Decisions, and so the bits of the hits, are the same as in
// walk_along_paths.h. A layout defines CompactTet, compact_tet() and NEIGHBOUR(scene, tet, rank, known_rank, known):
// what is across the face opposite the vertex of that rank among the four; `known` is the same for known_rank.
#ifndef TETRACE_KERNELS_WALKS_STRUCTURE_COMPACT_H
#define TETRACE_KERNELS_WALKS_STRUCTURE_COMPACT_H

#include KERNEL_LAYOUT_HEADER
#include "kernels/layouts/faces.h"
#include "kernels/walks/carried.h"
#include "kernels/walks/entry_faces.h"
#include "kernels/walks/entry_on_path.h"
#include "kernels/walks/triangle_hit.h"

// The current face, an exit face of the last tet. Seen from the next tet, the edges from p0 to p1, p1 to p2, p2 to p0
// have the ray on their positive side.
STRUCT(CarriedFace)
{
    Carried p0;
    Carried p1;
    Carried p2;
    uint v0; // their numbers
    uint v1;
    uint v2;
    uint tet;    // the last tet; NO_TET if the ray enters the domain
    uint across; // what the last tet names across the face: a tet, or an end of the walk (layout.h)
    uint before; // what the next tet names across the face
};

// How many of four vertices come before one of them.
KERNEL_FN uint rank_among(uint vertex, uint a, uint b, uint c, uint d)
{
    return (a < vertex ? 1u : 0u) + (b < vertex ? 1u : 0u) + (c < vertex ? 1u : 0u) + (d < vertex ? 1u : 0u);
}

KERNEL_FN uint apex_across(CarriedFace current, CompactTet tet)
{
    return tet.vertices ^ current.v0 ^ current.v1 ^ current.v2;
}

KERNEL_FN Carried carried_vertex(SceneView scene, Ray ray, Shear shear, uint vertex)
{
    return carried(ray, shear, FETCH(scene, vertices, vertex));
}

// Among the vertices of the tet across the current face, the ranks of the apex, and of the vertex that it replaces.
// vertex: the apex's number.
KERNEL_FN uint apex_rank(CarriedFace current, uint vertex)
{
    return rank_among(vertex, current.v0, current.v1, current.v2, vertex);
}

KERNEL_FN uint replaced_rank(CarriedFace current, uint vertex, uint replaced)
{
    uint replaced_vertex = replaced == 0u ? current.v0 : replaced == 1u ? current.v1 : current.v2;
    return rank_among(replaced_vertex, current.v0, current.v1, current.v2, vertex);
}

// The exit face of the tet across the current face. vertex: the apex's number; across: what is across that face.
KERNEL_FN CarriedFace face_across(CarriedFace current, uint vertex, Carried apex, uint replaced, uint across)
{
    CarriedFace next;
    next.p0 = replaced == 0u ? apex : current.p0;
    next.p1 = replaced == 1u ? apex : current.p1;
    next.p2 = replaced == 2u ? apex : current.p2;
    next.v0 = replaced == 0u ? vertex : current.v0;
    next.v1 = replaced == 1u ? vertex : current.v1;
    next.v2 = replaced == 2u ? vertex : current.v2;
    next.tet = current.across;
    next.across = across;
    next.before = current.across;
    return next;
}

// roughly_replaced_by() of carried.h with a branch for each tie: with its selects, scalar C++ walks tet20 15 % more
// slowly (tetrace bench --scene bunny --size 384 --method project --layout tet20 --backend openmp --threads 1).
KERNEL_FN uint replaced_unless_tie(Sheared p0, Sheared p1, Sheared p2, Sheared apex)
{
    PRECISE real plus = p2.x * apex.y;
    PRECISE real minus = p2.y * apex.x;
    if (plus == minus) return UNDECIDED;
    bool left = plus > minus;
    real other_x = left ? p1.x : p0.x;
    real other_y = left ? p1.y : p0.y;
    PRECISE real other_plus = other_x * apex.y;
    PRECISE real other_minus = other_y * apex.x;
    if (other_plus == other_minus) return UNDECIDED;
    return other_plus > other_minus ? (left ? 2u : 1u) : (left ? 0u : 2u);
}

// From a face through the next tet to its exit face.
KERNEL_FN CarriedFace next_carried_face(SceneView scene, Ray ray, Shear shear, CarriedFace current)
{
    CompactTet tet = compact_tet(scene, current.across);
    uint vertex = apex_across(current, tet);
    Carried apex = carried_vertex(scene, ray, shear, vertex);
    uint replaced = replaced_by(current.p0.seen, current.p1.seen, current.p2.seen, apex.seen);
    uint across =
        NEIGHBOUR(scene, tet, replaced_rank(current, vertex, replaced), apex_rank(current, vertex), current.before);
    return face_across(current, vertex, apex, replaced, across);
}

// The face with these vertices.
KERNEL_FN CarriedFace carried_face_of(SceneView scene, Ray ray, Shear shear, uint v0, uint v1, uint v2)
{
    CarriedFace current;
    current.p0 = carried_vertex(scene, ray, shear, v0);
    current.p1 = carried_vertex(scene, ray, shear, v1);
    current.p2 = carried_vertex(scene, ray, shear, v2);
    current.v0 = v0;
    current.v1 = v1;
    current.v2 = v2;
    current.tet = NO_TET;
    current.across = NO_HALF_FACE;
    current.before = NO_HALF_FACE;
    return current;
}

// A boundary face, from outside.
KERNEL_FN CarriedFace entered_face(SceneView scene, Entrance entrance)
{
    uint4 quad = FETCH(scene, entry_faces, entrance.index);
    CarriedFace current;
    current.p0 = carried_from(entrance.p0);
    current.p1 = carried_from(entrance.p1);
    current.p2 = carried_from(entrance.p2);
    current.v0 = quad.x;
    current.v1 = quad.y;
    current.v2 = quad.z;
    current.tet = NO_TET;
    current.across = quad.w;
    current.before = NO_HALF_FACE;
    return current;
}

KERNEL_FN uint start_vertex(TraceParams params, uint corner)
{
    uint of_low = corner == 0u ? params.start_v0 : params.start_v1;
    uint of_high = corner == 2u ? params.start_v2 : params.start_v3;
    return corner < 2u ? of_low : of_high;
}

// A face of the tet that a ray starts in.
KERNEL_FN CarriedFace start_carried_face(SceneView scene, TraceParams params, Ray ray, Shear shear, uint face)
{
    uint rank =
        rank_among(start_vertex(params, face), params.start_v0, params.start_v1, params.start_v2, params.start_v3);
    uint v0 = start_vertex(params, corner(face, 0u));
    uint v1 = start_vertex(params, corner(face, 1u));
    uint v2 = start_vertex(params, corner(face, 2u));
    CarriedFace current =
        carried_face_of(scene, ray, shear, v0, v2, v1); // reversed: corners are listed for the tet itself
    current.tet = params.start_tet;
    current.across = NEIGHBOUR(scene, compact_tet(scene, params.start_tet), rank, 3u, params.start_neighbour);
    current.before = params.start_tet;
    return current;
}

// The same face, but if it is occlusive, with the tet across it: the ray goes on.
KERNEL_FN CarriedFace opened(SceneView scene, CarriedFace current)
{
    CarriedFace result = current;
    if (current.across >= OCCLUSIVE && current.across != NO_HALF_FACE) {
        uint other_side = (current.across ^ OCCLUSIVE) ^ 1u;
        result.across = FETCH(scene, occlusive_faces, OCCLUSIVE_WORDS * (other_side >> 1u) + 1u + (other_side & 1u));
        result.before = OCCLUSIVE | other_side;
    }
    return result;
}

KERNEL_FN bool is_carried_face_ahead(SceneView scene, Ray ray, CarriedFace current)
{
    return is_face_ahead(ray, position_of(scene, current.v0), position_of(scene, current.v1),
                         position_of(scene, current.v2));
}

// The first face of its path that the ray crosses in front of its origin, as in path.h; tet is NO_TET if the ray has
// no path. doubted: the first tet of a walk that may be in a circle, or NO_TET. The result's tet is `doubted` if that
// is on the path, or if the path's end is too far. If neither, the path is followed once more, to the face that is
// wanted: nothing is kept, as in path.h.
RARE_FN CarriedFace carried_face_ahead(SceneView scene, TraceParams params, Ray ray, Shear shear, uint doubted)
{
    uint entry = entry_anywhere(scene, ray, 0u, 0u);
    CarriedFace current = entered_face(scene, entrance_by(scene, ray, shear, entry == NO_ENTRY ? 0u : entry));
    uint in_doubt = doubted;
    uint wanted = 0u; // its number of steps
    bool ahead = false;
    bool done = entry == NO_ENTRY;
    uint steps = 0u;
    while (!done && steps < params.max_steps) {
        current = next_carried_face(scene, ray, shear, opened(scene, current));
        ++steps;
        if (!ahead) wanted = steps;
        ahead = ahead || is_carried_face_ahead(scene, ray, current);
        bool is_end = current.across == NO_HALF_FACE;
        done = is_end || current.tet == in_doubt || (ahead && in_doubt == NO_TET && steps == wanted);
        if (is_end && in_doubt != NO_TET && current.tet != in_doubt && steps != wanted) {
            current = entered_face(scene, entrance_by(scene, ray, shear, entry));
            in_doubt = NO_TET;
            steps = 0u;
            done = false;
        }
    }
    if (in_doubt != NO_TET && !done) current.tet = in_doubt;
    return current;
}

// From an exit face to the ray's hit. own: for a ray that starts in a tet, the face of that tet that holds the ray, or
// NO_EXIT. first_steps: the number of tets before. Loops test at their end, and ties are decided after the inner loop,
// as in walk_by_records.h. carried_face_ahead() is used as exit_ahead() in walk_along_paths.h.
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, Shear shear, CarriedFace first, uint first_steps,
                   uint own)
{
    CarriedFace current = first;
    uint steps = first_steps;
    bool may_begin_anew = params.start_tet != NO_TET;
    uint pause = may_begin_anew ? first_pause(params) : params.max_steps;
    for (;;) {
        if (current.across < OCCLUSIVE && steps < pause) {
            for (;;) {
                for (;;) {
                    CompactTet tet = compact_tet(scene, current.across);
                    uint vertex = apex_across(current, tet);
                    Carried apex = carried_vertex(scene, ray, shear, vertex);
                    uint replaced = replaced_unless_tie(current.p0.seen, current.p1.seen, current.p2.seen, apex.seen);
                    if (replaced == UNDECIDED) break;
                    uint across = NEIGHBOUR(scene, tet, replaced_rank(current, vertex, replaced),
                                            apex_rank(current, vertex), current.before);
                    current = face_across(current, vertex, apex, replaced, across);
                    ++steps;
                    if (current.across >= OCCLUSIVE || steps >= pause) break;
                }
                if (current.across >= OCCLUSIVE || steps >= pause) break;
                if (DEFERS_TIES) current.across = DEFERRED;
                if (DEFERS_TIES) break;
                current = next_carried_face(scene, ray, shear, current);
                ++steps;
                if (current.across >= OCCLUSIVE || steps >= pause) break;
            }
        }
        if (!may_begin_anew || (own != NO_EXIT && current.across >= OCCLUSIVE)) break;
        current = carried_face_ahead(scene, params, ray, shear, own == NO_EXIT ? NO_TET : params.start_tet);
        if (current.tet == NO_TET) break;
        if (current.tet == params.start_tet) current = start_carried_face(scene, params, ray, shear, own);
        steps = 1u;
        pause = params.max_steps;
        may_begin_anew = false;
    }
    if (DEFERS_TIES && current.across == DEFERRED) return make_no_hit(DEFERRED, current.tet, steps);
    if (current.tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    if (current.across == NO_HALF_FACE) return make_no_hit(NO_HIT, current.tet, steps);
    if (current.across < OCCLUSIVE) return make_no_hit(LOST, current.tet, steps);
    uint face = (current.across ^ OCCLUSIVE) >> 1u;
    return hit_on(scene, ray, FETCH(scene, occlusive_faces, OCCLUSIVE_WORDS * face), current.tet, steps, real(NO_END));
}

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    Shear shear = shear_of(ray);
    if (params.start_tet == NO_TET) {
        Entrance entrance = entrance_of(scene, ray, shear);
        if (entrance.index >= DEFERRED) return make_no_hit(entrance.index == DEFERRED ? DEFERRED : NO_HIT, NO_TET, 0u);
        return walk(scene, params, ray, shear, entered_face(scene, entrance), 0u, 0u);
    }
    uint face = face_left_by(ray, position_of(scene, params.start_v0), position_of(scene, params.start_v1),
                             position_of(scene, params.start_v2), position_of(scene, params.start_v3));
    CarriedFace current = start_carried_face(scene, params, ray, shear, face & 3u);
    if (face == NO_EXIT) current.across = NO_HALF_FACE;
    return walk(scene, params, ray, shear, current, 1u, face);
}

#endif

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
STRUCT(Gate)
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

KERNEL_FN uint apex_across(Gate gate, CompactTet tet)
{
    return tet.vertices ^ gate.v0 ^ gate.v1 ^ gate.v2;
}

KERNEL_FN Carried carried_vertex(SceneView scene, Ray ray, Shear shear, uint vertex)
{
    return carried(ray, shear, FETCH(scene, vertices, vertex));
}

// Among the vertices of the tet across a gate, the ranks of the apex, and of the gate's vertex that it replaces.
// vertex: the apex's number.
KERNEL_FN uint apex_rank(Gate gate, uint vertex)
{
    return rank_among(vertex, gate.v0, gate.v1, gate.v2, vertex);
}

KERNEL_FN uint replaced_rank(Gate gate, uint vertex, uint replaced)
{
    uint gone = replaced == 0u ? gate.v0 : replaced == 1u ? gate.v1 : gate.v2;
    return rank_among(gone, gate.v0, gate.v1, gate.v2, vertex);
}

// The exit face of the tet across a gate. vertex: the apex's number; across: what is across that face.
KERNEL_FN Gate gate_across(Gate gate, uint vertex, Carried apex, uint replaced, uint across)
{
    Gate next;
    next.p0 = replaced == 0u ? apex : gate.p0;
    next.p1 = replaced == 1u ? apex : gate.p1;
    next.p2 = replaced == 2u ? apex : gate.p2;
    next.v0 = replaced == 0u ? vertex : gate.v0;
    next.v1 = replaced == 1u ? vertex : gate.v1;
    next.v2 = replaced == 2u ? vertex : gate.v2;
    next.tet = gate.across;
    next.across = across;
    next.before = gate.across;
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
KERNEL_FN Gate next_gate(SceneView scene, Ray ray, Shear shear, Gate gate)
{
    CompactTet tet = compact_tet(scene, gate.across);
    uint vertex = apex_across(gate, tet);
    Carried apex = carried_vertex(scene, ray, shear, vertex);
    uint replaced = replaced_by(gate.p0.seen, gate.p1.seen, gate.p2.seen, apex.seen);
    uint across = NEIGHBOUR(scene, tet, replaced_rank(gate, vertex, replaced), apex_rank(gate, vertex), gate.before);
    return gate_across(gate, vertex, apex, replaced, across);
}

// The face with these vertices.
KERNEL_FN Gate gate_of(SceneView scene, Ray ray, Shear shear, uint v0, uint v1, uint v2)
{
    Gate gate;
    gate.p0 = carried_vertex(scene, ray, shear, v0);
    gate.p1 = carried_vertex(scene, ray, shear, v1);
    gate.p2 = carried_vertex(scene, ray, shear, v2);
    gate.v0 = v0;
    gate.v1 = v1;
    gate.v2 = v2;
    gate.tet = NO_TET;
    gate.across = NO_HALF_FACE;
    gate.before = NO_HALF_FACE;
    return gate;
}

// A boundary face, from outside.
KERNEL_FN Gate entered_gate(SceneView scene, Entrance entrance)
{
    uint4 quad = FETCH(scene, entry_faces, entrance.index);
    Gate gate;
    gate.p0 = carried_from(entrance.p0);
    gate.p1 = carried_from(entrance.p1);
    gate.p2 = carried_from(entrance.p2);
    gate.v0 = quad.x;
    gate.v1 = quad.y;
    gate.v2 = quad.z;
    gate.tet = NO_TET;
    gate.across = quad.w;
    gate.before = NO_HALF_FACE;
    return gate;
}

KERNEL_FN uint start_vertex(TraceParams params, uint corner)
{
    uint of_low = corner == 0u ? params.start_v0 : params.start_v1;
    uint of_high = corner == 2u ? params.start_v2 : params.start_v3;
    return corner < 2u ? of_low : of_high;
}

// A face of the tet that a ray starts in.
KERNEL_FN Gate start_gate(SceneView scene, TraceParams params, Ray ray, Shear shear, uint face)
{
    uint rank =
        rank_among(start_vertex(params, face), params.start_v0, params.start_v1, params.start_v2, params.start_v3);
    uint v0 = start_vertex(params, corner(face, 0u));
    uint v1 = start_vertex(params, corner(face, 1u));
    uint v2 = start_vertex(params, corner(face, 2u));
    Gate gate = gate_of(scene, ray, shear, v0, v2, v1); // reversed: corners are listed for the tet itself
    gate.tet = params.start_tet;
    gate.across = NEIGHBOUR(scene, compact_tet(scene, params.start_tet), rank, 3u, params.start_neighbour);
    gate.before = params.start_tet;
    return gate;
}

// The same face, but if it is occlusive, with the tet across it: the ray goes on.
KERNEL_FN Gate opened(SceneView scene, Gate gate)
{
    Gate result = gate;
    if (gate.across >= OCCLUSIVE && gate.across != NO_HALF_FACE) {
        uint other_side = (gate.across ^ OCCLUSIVE) ^ 1u;
        result.across = FETCH(scene, occlusive_faces, OCCLUSIVE_WORDS * (other_side >> 1u) + 1u + (other_side & 1u));
        result.before = OCCLUSIVE | other_side;
    }
    return result;
}

KERNEL_FN bool is_gate_ahead(SceneView scene, Ray ray, Gate gate)
{
    return is_face_ahead(ray, position_of(scene, gate.v0), position_of(scene, gate.v1), position_of(scene, gate.v2));
}

// The first face of its path that the ray crosses in front of its origin, as in path.h; tet is NO_TET if the ray has
// no path. doubted: the first tet of a walk that may be in a circle, or NO_TET. The result's tet is `doubted` if that
// is on the path, or if the path's end is too far. If neither, the path is followed once more, to the face that is
// wanted: nothing is kept, as in path.h.
RARE_FN Gate gate_ahead(SceneView scene, TraceParams params, Ray ray, Shear shear, uint doubted)
{
    uint entry = entry_anywhere(scene, ray, 0u, 0u);
    Gate gate = entered_gate(scene, entrance_by(scene, ray, shear, entry == NO_ENTRY ? 0u : entry));
    uint in_doubt = doubted;
    uint wanted = 0u; // its number of steps
    bool ahead = false;
    bool done = entry == NO_ENTRY;
    uint steps = 0u;
    while (!done && steps < params.max_steps) {
        gate = next_gate(scene, ray, shear, opened(scene, gate));
        ++steps;
        if (!ahead) wanted = steps;
        ahead = ahead || is_gate_ahead(scene, ray, gate);
        bool is_end = gate.across == NO_HALF_FACE;
        done = is_end || gate.tet == in_doubt || (ahead && in_doubt == NO_TET && steps == wanted);
        if (is_end && in_doubt != NO_TET && gate.tet != in_doubt && steps != wanted) {
            gate = entered_gate(scene, entrance_by(scene, ray, shear, entry));
            in_doubt = NO_TET;
            steps = 0u;
            done = false;
        }
    }
    if (in_doubt != NO_TET && !done) gate.tet = in_doubt;
    return gate;
}

// From an exit face to the ray's hit. own: for a ray that starts in a tet, the face of that tet that holds the ray, or
// NO_EXIT. first_steps: the number of tets before. Loops test at their end, and ties are decided after the inner loop,
// as in walk_by_records.h. gate_ahead() is used as exit_ahead() in walk_along_paths.h.
KERNEL_FN Hit walk(SceneView scene, TraceParams params, Ray ray, Shear shear, Gate first, uint first_steps, uint own)
{
    Gate gate = first;
    uint steps = first_steps;
    bool may_begin_anew = params.start_tet != NO_TET;
    uint pause = may_begin_anew ? first_pause(params) : params.max_steps;
    for (;;) {
        if (gate.across < OCCLUSIVE && steps < pause) {
            for (;;) {
                for (;;) {
                    CompactTet tet = compact_tet(scene, gate.across);
                    uint vertex = apex_across(gate, tet);
                    Carried apex = carried_vertex(scene, ray, shear, vertex);
                    uint replaced = replaced_unless_tie(gate.p0.seen, gate.p1.seen, gate.p2.seen, apex.seen);
                    if (replaced == UNDECIDED) break;
                    uint across = NEIGHBOUR(scene, tet, replaced_rank(gate, vertex, replaced), apex_rank(gate, vertex),
                                            gate.before);
                    gate = gate_across(gate, vertex, apex, replaced, across);
                    ++steps;
                    if (gate.across >= OCCLUSIVE || steps >= pause) break;
                }
                if (gate.across >= OCCLUSIVE || steps >= pause) break;
                if (DEFERS_TIES) gate.across = DEFERRED;
                if (DEFERS_TIES) break;
                gate = next_gate(scene, ray, shear, gate);
                ++steps;
                if (gate.across >= OCCLUSIVE || steps >= pause) break;
            }
        }
        if (!may_begin_anew || (own != NO_EXIT && gate.across >= OCCLUSIVE)) break;
        gate = gate_ahead(scene, params, ray, shear, own == NO_EXIT ? NO_TET : params.start_tet);
        if (gate.tet == NO_TET) break;
        if (gate.tet == params.start_tet) gate = start_gate(scene, params, ray, shear, own);
        steps = 1u;
        pause = params.max_steps;
        may_begin_anew = false;
    }
    if (DEFERS_TIES && gate.across == DEFERRED) return make_no_hit(DEFERRED, gate.tet, steps);
    if (gate.tet == NO_TET) return make_no_hit(NO_HIT, NO_TET, 0u);
    if (gate.across == NO_HALF_FACE) return make_no_hit(NO_HIT, gate.tet, steps);
    if (gate.across < OCCLUSIVE) return make_no_hit(LOST, gate.tet, steps);
    uint face = (gate.across ^ OCCLUSIVE) >> 1u;
    return hit_on(scene, ray, FETCH(scene, occlusive_faces, OCCLUSIVE_WORDS * face), gate.tet, steps, real(NO_END));
}

KERNEL_FN Hit trace(SceneView scene, TraceParams params, Ray ray)
{
    Shear shear = shear_of(ray);
    if (params.start_tet == NO_TET) {
        Entrance entrance = entrance_of(scene, ray, shear);
        if (entrance.index >= DEFERRED) return make_no_hit(entrance.index == DEFERRED ? DEFERRED : NO_HIT, NO_TET, 0u);
        return walk(scene, params, ray, shear, entered_gate(scene, entrance), 0u, 0u);
    }
    uint face = face_left_by(ray, position_of(scene, params.start_v0), position_of(scene, params.start_v1),
                             position_of(scene, params.start_v2), position_of(scene, params.start_v3));
    Gate gate = start_gate(scene, params, ray, shear, face & 3u);
    if (face == NO_EXIT) gate.across = NO_HALF_FACE;
    return walk(scene, params, ray, shear, gate, 1u, face);
}

#endif

// The boundary face by which a ray's path enters the domain. For walks along paths, which start only at the end of a
// path. Include it after entry_half_faces.h or entry_faces.h, one of which defines entry_face().
#ifndef TETRACE_KERNELS_WALKS_ENTRY_ON_PATH_H
#define TETRACE_KERNELS_WALKS_ENTRY_ON_PATH_H

#include "kernels/methods/signs.h"
#include "kernels/walks/entry.h"

// For a build that counts how often a path is searched from its beginning: 0 entry_anywhere(), 1 exit_ahead(), 2 a ray
// that goes on past the face that it starts on. That build is never timed.
#ifndef COUNT_SEARCH
#define COUNT_SEARCH(where)
#endif

// For a device that executes rare work whether a ray needs it or not: true if a ray that meets a tie, or is in none of
// its square's faces, is deferred to a program with the whole kernel (docs/spec/devices.md, W9). Its hit is DEFERRED.
#ifndef DEFERS_TIES
#define DEFERS_TIES false
#endif

// The vertex at which a product with `factors` is the smallest (or, with them negated, the largest) of all that lie in
// a box: rounding is monotone, so no vertex in the box has a smaller one.
KERNEL_FN Vec3 min_corner(DomainBox box, Vec3 factors)
{
    return VEC3(factors.x < real(0.0f) ? box.high.x : box.low.x, factors.y < real(0.0f) ? box.high.y : box.low.y,
                factors.z < real(0.0f) ? box.high.z : box.low.z);
}

// Whether the ray sees all vertices in a box on one side of a line through it: it then enters by no face with such
// vertices (docs/spec/project.md, P10).
KERNEL_FN bool sees_on_one_side(DomainBox box, Ray ray, Vec3 factors)
{
    Vec3 negated = VEC3(-factors.x, -factors.y, -factors.z);
    return dot3(sub3(min_corner(box, factors), ray.origin), factors) > real(0.0f) ||
           dot3(sub3(min_corner(box, negated), ray.origin), factors) < real(0.0f);
}

// The box of all vertices on a side.
KERNEL_FN DomainBox side_box(SceneView scene, uint side)
{
    DomainBox box = scene.domain;
    uint across = side >> 1u;
    Vec3 plane = (side & 1u) == 1u ? box.high : box.low;
    Vec3 low = VEC3(across == 0u ? plane.x : box.low.x, across == 1u ? plane.y : box.low.y,
                    across == 2u ? plane.z : box.low.z);
    Vec3 high = VEC3(across == 0u ? plane.x : box.high.x, across == 1u ? plane.y : box.high.y,
                     across == 2u ? plane.z : box.high.z);
    box.low = low;
    box.high = high;
    return box;
}

// The number of the first boundary face by which the ray enters, or NO_ENTRY. Faces first to last - 1, those of the
// square, are tested first; then those of each side that the ray may enter by. A GPU would wait for the one ray that
// tests all sides.
RARE_FN uint entry_anywhere(SceneView scene, Ray ray, uint first, uint last)
{
    COUNT_SEARCH(0);
    Shear shear = shear_of(ray);
    uint list = 6u * scene.divisions * scene.divisions; // the sides' lists follow those of the squares
    uint side = 0u;
    uint index = first;
    uint behind = last;
    uint found = NO_ENTRY;
    while (found == NO_ENTRY && (index < behind || side < 6u)) {
        if (index < behind) {
            found = depth_in(entry_face(scene, index), ray) < real(0.0f) ? NO_ENTRY : index;
            ++index;
        } else {
            DomainBox box = side_box(scene, side);
            bool passed = sees_on_one_side(box, ray, shear.across) || sees_on_one_side(box, ray, shear.upwards);
            index = passed ? index : FETCH(scene, entry_ranges, list + side);
            behind = passed ? behind : FETCH(scene, entry_ranges, list + side + 1u);
            ++side;
        }
    }
    return found;
}

// The number of the square's column or row, by one quotient. Rounding may name the square past a line: that one lists
// all faces near it, and the ray enters by the same face (docs/spec/data-and-rays.md, D5).
KERNEL_FN uint line_near(uint divisions, SideCrossing at)
{
    PRECISE real place = (at.reach - at.first) * to_real(divisions) / (at.last - at.first);
    uint line = to_uint(maximum(place, real(0.0f)));
    return line < divisions ? line : divisions - 1u;
}

// A square of the box at which the ray enters, or 6 divisions^2 if it misses the box.
KERNEL_FN uint entry_square(SceneView scene, Ray ray)
{
    Entry entry = entry_of(scene.domain, ray);
    if (entry.side == 6u) return 6u * scene.divisions * scene.divisions;
    uint i = line_near(scene.divisions, entry.a);
    uint j = line_near(scene.divisions, entry.b);
    return square_at(scene, entry, i, j);
}

// The boundary face by which a ray enters. The ray has seen its corners: a walk that carries them need not load them
// again.
STRUCT(Entrance)
{
    uint index; // the face's number; NO_ENTRY if the ray misses the domain, or DEFERRED
    Sheared p0; // its corners, in the order of faces.h; only if it has a number
    Sheared p1;
    Sheared p2;
};

KERNEL_FN Entrance entrance_by(SceneView scene, Ray ray, Shear shear, uint index)
{
    EntryFace face = entry_face(scene, index);
    Entrance entrance;
    entrance.index = index;
    entrance.p0 = sheared(shear, sub3(face.a, ray.origin));
    entrance.p1 = sheared(shear, sub3(face.b, ray.origin));
    entrance.p2 = sheared(shear, sub3(face.c, ray.origin));
    return entrance;
}

KERNEL_FN Entrance no_entrance(uint why)
{
    Entrance entrance;
    entrance.index = why;
    entrance.p0.x = real(0.0f);
    entrance.p0.y = real(0.0f);
    entrance.p1 = entrance.p0;
    entrance.p2 = entrance.p0;
    return entrance;
}

// The face by which the ray enters. Float products decide nearly all cases. Ties are decided after the loop, since some
// devices execute a conditional block even if no lane needs it.
KERNEL_FN Entrance entrance_of(SceneView scene, Ray ray, Shear shear)
{
    uint square = entry_square(scene, ray);
    if (square == 6u * scene.divisions * scene.divisions) return no_entrance(NO_ENTRY);
    uint first = FETCH(scene, entry_ranges, square);
    uint last = FETCH(scene, entry_ranges, square + 1u);
    Entrance entrance = no_entrance(NO_ENTRY);
    for (uint index = first;; ++index) {
        Entrance next = entrance_by(scene, ray, shear, index);
        uint held = roughly_held(next.p0, next.p1, next.p2);
        if (held == HELD) {
            entrance = next;
            break;
        }
        if (held == HELD_OR_TIE || index + 1u == last) break;
    }
    if (entrance.index != NO_ENTRY) return entrance;
    if (DEFERS_TIES) return no_entrance(DEFERRED);
    uint found = entry_anywhere(scene, ray, first, last);
    return found == NO_ENTRY ? no_entrance(NO_ENTRY) : entrance_by(scene, ray, shear, found);
}

#endif

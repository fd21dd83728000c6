// For rays from outside: the point at which a ray meets the domain's box, and the boundary face by which it enters.
// Only products are compared, never quotients: position <= line is |direction| (line - origin) <= |gap| direction_a.
// The left side is monotone in the line, so that the squares of one side never contradict each other.
// Included by entry_half_faces.h and entry_faces.h, which read the boundary faces of squares and sides, after what
// defines side_at_entry().
#ifndef TETRACE_KERNELS_WALKS_ENTRY_H
#define TETRACE_KERNELS_WALKS_ENTRY_H

#include "kernels/ray.h"

#define NO_ENTRY 0xFFFFFFFFu // instead of a boundary face's number
#define STARTS_IN_TETS       // rays of an image may also begin inside the domain

// The corners of a boundary face, in the order of faces.h.
STRUCT(EntryFace)
{
    Vec3 a;
    Vec3 b;
    Vec3 c;
};

// The two axes other than this one, in cyclic order.
KERNEL_FN uint first_axis(uint across)
{
    return across == 2u ? 0u : across + 1u;
}

KERNEL_FN uint second_axis(uint across)
{
    return across == 0u ? 2u : across - 1u;
}

// The point at which the ray meets the plane of a side, along an axis of that side. It is past a line there if slope
// (line - origin) <= reach. first, last: that product for the side's borders.
STRUCT(SideCrossing)
{
    uint axis;
    real origin;
    real direction;
    real slope;
    real reach;
    real first;
    real last;
};

// gap, slope: the distance to the plane, and how fast the ray comes nearer to it.
KERNEL_FN SideCrossing side_crossing(DomainBox box, Ray ray, real gap, real slope, uint axis)
{
    SideCrossing at;
    at.axis = axis;
    at.origin = component(ray.origin, axis);
    at.direction = component(ray.direction, axis);
    at.slope = slope;
    PRECISE real reach = gap * at.direction;
    PRECISE real first = (component(box.low, axis) - at.origin) * slope;
    PRECISE real last = (component(box.high, axis) - at.origin) * slope;
    at.reach = reach;
    at.first = first;
    at.last = last;
    return at;
}

// Whether the ray meets the plane between the side's borders. On a border it must be moving inwards: a ray that runs in
// the plane of a side (a grazing ray) misses the box.
KERNEL_FN bool is_on_side(SideCrossing at)
{
    bool is_inside = at.first < at.reach || (at.first == at.reach && at.direction > real(0.0f));
    return is_inside && (at.reach < at.last || (at.reach == at.last && at.direction < real(0.0f)));
}

// How a ray enters the box: by which side, and where.
STRUCT(Entry)
{
    uint side;      // 2 axis, and 1 more for the high one; 6 if the ray misses the box
    SideCrossing a; // along first_axis() of the side's axis
    SideCrossing b; // along second_axis() of it
};

// How far the ray is from the plane of the side across an axis that it moves towards; 0 if it does not, or is past it.
KERNEL_FN real gap_along(DomainBox box, Ray ray, uint axis)
{
    real direction = component(ray.direction, axis);
    real origin = component(ray.origin, axis);
    PRECISE real above = origin - component(box.high, axis);
    PRECISE real below = component(box.low, axis) - origin;
    real gap = direction < real(0.0f) ? above : direction > real(0.0f) ? below : real(0.0f);
    return maximum(gap, real(0.0f));
}

// The origin is not inside. If a ray enters, it is by the side whose plane it meets last, among the sides that it moves
// towards. Two planes are compared by the products of is_on_side(); since rounding is monotone, at least one of three
// planes is not met before another.
KERNEL_FN Entry entry_of(DomainBox box, Ray ray)
{
    Vec3 gap = VEC3(gap_along(box, ray, 0u), gap_along(box, ray, 1u), gap_along(box, ray, 2u));
    Vec3 rise = magnitudes(ray.direction);
    PRECISE real xy = gap.x * rise.y;
    PRECISE real yx = gap.y * rise.x;
    PRECISE real yz = gap.y * rise.z;
    PRECISE real zy = gap.z * rise.y;
    PRECISE real zx = gap.z * rise.x;
    PRECISE real xz = gap.x * rise.z;
    uint across = gap.x > real(0.0f) && xy >= yx && xz >= zx ? 0u : 3u;
    across = gap.y > real(0.0f) && yx >= xy && yz >= zy ? 1u : across;
    across = gap.z > real(0.0f) && zx >= xz && zy >= yz ? 2u : across;
    uint met = across == 3u ? 0u : across;
    Entry entry;
    entry.a = side_crossing(box, ray, component(gap, met), component(rise, met), first_axis(met));
    entry.b = side_crossing(box, ray, component(gap, met), component(rise, met), second_axis(met));
    bool is_met = across != 3u && is_on_side(entry.a) && is_on_side(entry.b);
    entry.side = is_met ? 2u * met + (component(ray.direction, met) < real(0.0f) ? 1u : 0u) : 6u;
    return entry;
}

// The square in column i and row j of the side by which the ray enters.
KERNEL_FN uint square_at(SceneView scene, Entry entry, uint i, uint j)
{
    return (entry.side * scene.divisions + j) * scene.divisions + i;
}

// How deep the ray is inside a boundary face: the smallest of its three side products, negative outside. They are the
// method's own products, so that a walk never begins at a face by which its method would not have left.
KERNEL_FN real depth_in(EntryFace face, Ray ray)
{
    real ab = side_at_entry(ray, face.a, face.b);
    real bc = side_at_entry(ray, face.b, face.c);
    real ca = side_at_entry(ray, face.c, face.a);
    real least = ab < bc ? ab : bc;
    return ca < least ? ca : least;
}

#endif

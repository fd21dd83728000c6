// Where a ray meets a face, as an integer that both tets of the face compute alike, whatever the order in which they
// list its corners: docs/spec/volume.md, S2.
#ifndef TETRACE_KERNELS_WALKS_PLACES_H
#define TETRACE_KERNELS_WALKS_PLACES_H

#include "kernels/ray.h"
#include "kernels/reciprocal.h"
#include "kernels/shear.h"

// The units of layout.h, as factors: 2^PLACE_BITS, and the same for offsets that are multiplied by 2^40, so that no
// product with a weight is denormal.
#define PLACES_PER_UNIT real(536870912.0f)      // 2^29
#define PLACES_OF_SCALED real(0.00048828125f)   // 2^(29 - 40)
#define OFFSET_SCALE real(1099511627776.0f)     // 2^40
#define FLAT_SHARE real(1.1920928955078125e-7f) // 2^-23

// The median, and a sum, that do not depend on the order of the numbers.
KERNEL_FN real median_of(Vec3 a)
{
    return maximum(minimum(a.x, a.y), minimum(maximum(a.x, a.y), a.z));
}

KERNEL_FN real sum_of(Vec3 a)
{
    real low = minimum(minimum(a.x, a.y), a.z);
    real high = maximum(maximum(a.x, a.y), a.z);
    PRECISE real sum = (low + high) + median_of(a);
    return sum;
}

KERNEL_FN real max_of(Vec3 a)
{
    return maximum(maximum(magnitude(a.x), magnitude(a.y)), magnitude(a.z));
}

// A place along a line on which the ray is 0, for corners at h: those on one side together weigh as much as those on
// the other, and one on the ray at least as much as all others.
KERNEL_FN real weight_on_line(real h, real above, real below)
{
    PRECISE real both = above + below;
    return h > real(0.0f) ? below : h < real(0.0f) ? above : both;
}

KERNEL_FN real above_zero(real a)
{
    return maximum(a, real(0.0f));
}

// The weights of a face's corners, of a face that the ray sees edge-on, or nearly so: along the axis of the plane along
// which it is longest. With all corners on one side of the ray: the nearest.
KERNEL_FN Vec3 weights_edge_on(Vec3 h)
{
    PRECISE real above = above_zero(h.x) + above_zero(h.y) + above_zero(h.z);
    PRECISE real below = above_zero(-h.x) + above_zero(-h.y) + above_zero(-h.z);
    Vec3 weights =
        VEC3(weight_on_line(h.x, above, below), weight_on_line(h.y, above, below), weight_on_line(h.z, above, below));
    Vec3 away = magnitudes(h);
    real least = minimum(minimum(away.x, away.y), away.z);
    real zero = real(0.0f);
    real one = real(1.0f);
    bool has_weight = sum_of(weights) > zero;
    return VEC3(has_weight        ? weights.x
                : away.x <= least ? one
                                  : zero,
                has_weight        ? weights.y
                : away.y <= least ? one
                                  : zero,
                has_weight        ? weights.z
                : away.z <= least ? one
                                  : zero);
}

// The weight of p for the point of the edge from p to q that is nearest to the ray.
KERNEL_FN real weight_on_edge(Sheared p, Sheared q)
{
    PRECISE real x = q.x - p.x;
    PRECISE real y = q.y - p.y;
    PRECISE real weight = q.x * x + q.y * y;
    return above_zero(weight);
}

// Whether the face's point nearest to the ray is on the edge from corner 0 to 1: the ray is outside that edge alone, or
// behind one of the two corners, from where the edge rises towards it. is_inside: the ray is on the corner's side of
// the edge across from it. w01: the weight of corner 0 on that edge.
KERNEL_FN bool is_nearest_edge(bool is_inside0, bool is_inside1, bool is_inside2, real w01, real w10)
{
    bool rises = is_inside0 ? w10 > real(0.0f) : w01 > real(0.0f);
    return !is_inside2 && ((is_inside0 && is_inside1) || ((is_inside0 || is_inside1) && rises));
}

KERNEL_FN real weight_on_edges(bool on_first, real first, bool on_second, real second)
{
    real zero = real(0.0f);
    PRECISE real weight = (on_first ? first : zero) + (on_second ? second : zero);
    return weight;
}

// The weights for the point of a face that is nearest to a ray that passes outside: on an edge, or else the corner that
// the ray is behind.
KERNEL_FN Vec3 weights_outside(Sheared p0, Sheared p1, Sheared p2, bool is_inside0, bool is_inside1, bool is_inside2)
{
    real w01 = weight_on_edge(p0, p1);
    real w02 = weight_on_edge(p0, p2);
    real w10 = weight_on_edge(p1, p0);
    real w12 = weight_on_edge(p1, p2);
    real w20 = weight_on_edge(p2, p0);
    real w21 = weight_on_edge(p2, p1);
    bool on01 = is_nearest_edge(is_inside0, is_inside1, is_inside2, w01, w10);
    bool on12 = is_nearest_edge(is_inside1, is_inside2, is_inside0, w12, w21);
    bool on20 = is_nearest_edge(is_inside2, is_inside0, is_inside1, w20, w02);
    if (on01 || on12 || on20)
        return VEC3(weight_on_edges(on01, w01, on20, w02), weight_on_edges(on12, w12, on01, w10),
                    weight_on_edges(on20, w20, on12, w21));
    real zero = real(0.0f);
    real one = real(1.0f);
    return VEC3(is_inside0 ? one : zero, is_inside1 ? one : zero, is_inside2 ? one : zero);
}

KERNEL_FN bool sees_corner(real side, real area)
{
    return area > real(0.0f) ? side >= real(0.0f) : side <= real(0.0f);
}

// How much each corner of a face counts for the point at which the ray meets it, or which is nearest to the ray: not
// negative, and with a positive sum.
KERNEL_FN Vec3 corner_weights(Sheared p0, Sheared p1, Sheared p2)
{
    Vec3 areas = VEC3(fine_side(p1, p2), fine_side(p2, p0), fine_side(p0, p1));
    Vec3 sides = magnitudes(areas);
    Vec3 x = VEC3(p0.x, p1.x, p2.x);
    Vec3 y = VEC3(p0.y, p1.y, p2.y);
    bool is_high = max_of(y) > max_of(x);
    Vec3 h = VEC3(is_high ? y.x : x.x, is_high ? y.y : x.y, is_high ? y.z : x.z);
    real size = max_of(h);
    PRECISE real least = size * size * FLAT_SHARE;
    Vec3 edge_on = weights_edge_on(h);
    real area = sum_of(areas);
    bool is_edge_on = sum_of(sides) <= least || area == real(0.0f);
    bool is_inside0 = sees_corner(areas.x, area);
    bool is_inside1 = sees_corner(areas.y, area);
    bool is_inside2 = sees_corner(areas.z, area);
    if (!is_edge_on && !(is_inside0 && is_inside1 && is_inside2))
        return weights_outside(p0, p1, p2, is_inside0, is_inside1, is_inside2);
    return VEC3(is_edge_on ? edge_on.x : sides.x, is_edge_on ? edge_on.y : sides.y, is_edge_on ? edge_on.z : sides.z);
}

// units: truncated.
KERNEL_FN uint moved_by(uint place, real units)
{
    uint whole = to_uint(magnitude(units));
    return units < real(0.0f) ? place - whole : place + whole;
}

// A coordinate along the ray's deepest axis, counted in the ray's sense, from PLACE_OF_ZERO.
KERNEL_FN uint place_of_coordinate(real along)
{
    PRECISE real units = along * PLACES_PER_UNIT;
    return moved_by(PLACE_OF_ZERO, units);
}

// The point's coordinate along the ray's deepest axis, counted in the ray's sense.
KERNEL_FN real along_axis(Ray ray, Vec3 point)
{
    uint axis = deepest_axis(ray.direction);
    return component(ray.direction, axis) < real(0.0f) ? -component(point, axis) : component(point, axis);
}

// A place in units of length. stretch: of the ray, as layout.h has it.
KERNEL_FN uint stretched(uint place, uint stretch)
{
    return high_product(place, stretch);
}

KERNEL_FN uint place_of_point(Ray ray, Vec3 point, uint stretch)
{
    return stretched(place_of_coordinate(along_axis(ray, point)), stretch);
}

// Where the ray meets a face. The corners may come in any order: the offsets from the median have one that is zero, so
// that of the other two the sum does not depend on the order either.
KERNEL_FN uint place_on_face(Ray ray, Vec3 a, Vec3 b, Vec3 c, uint stretch)
{
    Shear shear = shear_along(ray.direction);
    Vec3 weights = corner_weights(sheared(shear, sub3(a, ray.origin)), sheared(shear, sub3(b, ray.origin)),
                                  sheared(shear, sub3(c, ray.origin)));
    Vec3 along = VEC3(along_axis(ray, a), along_axis(ray, b), along_axis(ray, c));
    real median = median_of(along);
    PRECISE real offset_a = (along.x - median) * OFFSET_SCALE;
    PRECISE real offset_b = (along.y - median) * OFFSET_SCALE;
    PRECISE real offset_c = (along.z - median) * OFFSET_SCALE;
    PRECISE real weighted = weights.x * offset_a + weights.y * offset_b + weights.z * offset_c;
    real inverse = reciprocal(sum_of(weights));
    PRECISE real offset = weighted * inverse;
    PRECISE real units = offset * PLACES_OF_SCALED;
    return stretched(moved_by(place_of_coordinate(median), units), stretch);
}

#endif

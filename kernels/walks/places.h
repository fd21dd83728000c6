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

KERNEL_FN real largest_of(Vec3 a)
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
// which it is longest.
KERNEL_FN Vec3 weights_edge_on(Vec3 h)
{
    PRECISE real above = above_zero(h.x) + above_zero(h.y) + above_zero(h.z);
    PRECISE real below = above_zero(-h.x) + above_zero(-h.y) + above_zero(-h.z);
    Vec3 weights =
        VEC3(weight_on_line(h.x, above, below), weight_on_line(h.y, above, below), weight_on_line(h.z, above, below));
    real one = real(1.0f);
    return sum_of(weights) > real(0.0f) ? weights : VEC3(one, one, one);
}

// How much each corner of a face counts for the point at which the ray meets it: not negative, and with a positive sum.
KERNEL_FN Vec3 corner_weights(Sheared p0, Sheared p1, Sheared p2)
{
    Vec3 sides = magnitudes(VEC3(fine_side(p1, p2), fine_side(p2, p0), fine_side(p0, p1)));
    Vec3 x = VEC3(p0.x, p1.x, p2.x);
    Vec3 y = VEC3(p0.y, p1.y, p2.y);
    bool is_high = largest_of(y) > largest_of(x);
    Vec3 h = VEC3(is_high ? y.x : x.x, is_high ? y.y : x.y, is_high ? y.z : x.z);
    real size = largest_of(h);
    PRECISE real least = size * size * FLAT_SHARE;
    Vec3 edge_on = weights_edge_on(h);
    bool is_edge_on = sum_of(sides) <= least;
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

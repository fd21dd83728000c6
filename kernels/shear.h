// A vertex as a ray sees it: projected to a plane across the ray, with the ray as the plane's origin; and the sides of
// the ray at edges in that plane. Source: Woop, Benthin, Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013;
// here without a division.
#ifndef TETRACE_KERNELS_SHEAR_H
#define TETRACE_KERNELS_SHEAR_H

STRUCT(Shear)
{
    Vec3 across;  // a point's products with these are its x and y in the plane times 2^20: no product of two
    Vec3 upwards; // such coordinates is denormal
};

KERNEL_FN uint deepest_axis(Vec3 direction)
{
    real x = magnitude(direction.x);
    real y = magnitude(direction.y);
    real z = magnitude(direction.z);
    uint of_xy = y > x ? 1u : 0u;
    return z > maximum(x, y) ? 2u : of_xy;
}

// The axes in cyclic order, such that `axis` is the third.
KERNEL_FN Vec3 permuted_to(Vec3 a, uint axis)
{
    real x = axis == 0u ? a.z : axis == 1u ? a.y : a.x;
    real y = axis == 0u ? a.x : axis == 1u ? a.z : a.y;
    real z = axis == 0u ? a.y : axis == 1u ? a.x : a.z;
    return VEC3(x, y, z);
}

// The other way round: its axes in cyclic order, and `axis` the third.
KERNEL_FN Vec3 permuted_from(Vec3 a, uint axis)
{
    real x = axis == 0u ? a.y : axis == 1u ? a.z : a.x;
    real y = axis == 0u ? a.z : axis == 1u ? a.x : a.y;
    real z = axis == 0u ? a.x : axis == 1u ? a.y : a.z;
    return VEC3(x, y, z);
}

KERNEL_FN Shear shear_along(Vec3 direction)
{
    uint axis = deepest_axis(direction);
    uint axis_x = axis == 2u ? 0u : axis + 1u;
    uint axis_y = axis == 0u ? 2u : axis - 1u;
    real deepest = component(direction, axis);
    real zero = real(0.0f);
    PRECISE real x = component(direction, axis_x) * real(-1048576.0f);
    PRECISE real y = component(direction, axis_y) * real(-1048576.0f);
    PRECISE real z = deepest * real(1048576.0f);
    Shear shear;
    shear.across = permuted_to(VEC3(z, zero, x), axis);
    shear.upwards = permuted_to(VEC3(zero, z, y), axis);
    return shear;
}

// A point projected along the ray; the ray is the origin.
STRUCT(Sheared)
{
    real x;
    real y;
};

// Projects a vertex, given by its difference from the ray's origin; the same for every face. One of the three products
// is zero.
KERNEL_FN Sheared sheared(Shear shear, Vec3 seen)
{
    Sheared result;
    result.x = dot3(seen, shear.across);
    result.y = dot3(seen, shear.upwards);
    return result;
}

// Side of the ray at the edge from a to b: the right sign or zero, since rounding is monotone.
KERNEL_FN real rough_side(Sheared a, Sheared b)
{
    PRECISE real side = a.x * b.y - a.y * b.x;
    return side;
}

// The exact rounding error of a product (Dekker 1971; Veltkamp's split: 12 bits and 12).
KERNEL_FN real lost_by(real a, real b, real product)
{
    PRECISE real a_large = a * real(4097.0f);
    PRECISE real a_high = a_large - (a_large - a);
    PRECISE real a_low = a - a_high;
    PRECISE real b_large = b * real(4097.0f);
    PRECISE real b_high = b_large - (b_large - b);
    PRECISE real b_low = b - b_high;
    PRECISE real lost = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return lost;
}

// The same side with an error of some units in the last place, also where rough_side() cancels.
KERNEL_FN real fine_side(Sheared a, Sheared b)
{
    PRECISE real plus = a.x * b.y;
    PRECISE real minus = a.y * b.x;
    PRECISE real side = (plus - minus) + (lost_by(a.x, b.y, plus) - lost_by(a.y, b.x, minus));
    return side;
}

#endif

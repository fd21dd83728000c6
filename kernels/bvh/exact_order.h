// Which of two triangles a ray meets first, in integers: nearer_triangle() asks if float depths leave it open. The
// depths of their planes along the exact ray are fractions; nothing is rounded (docs/spec/bvhs.md, B15).

// A coordinate, or a depth, in units of 2^-40; a component of a direction in units of 2^-43. Two's complement.
STRUCT(Fixed)
{
    uint low;
    uint high;
};

// The biased exponents of floats whose last place is the unit.
#define UNIT_OF_COORDINATES 110u
#define UNIT_OF_DIRECTIONS 107u

KERNEL_FN Fixed negated_fixed(Fixed a)
{
    Fixed result;
    result.low = ~a.low + 1u;
    result.high = ~a.high + (a.low == 0u ? 1u : 0u);
    return result;
}

// value: below 2^7; what is smaller than the unit is dropped.
KERNEL_FN Fixed fixed_of(real value, uint unit)
{
    uint bits = as_bits(value);
    uint exponent = bits >> 23u & 0xFFu;
    uint digits = (bits & 0x7FFFFFu) | 0x800000u;
    Fixed result;
    result.high = 0u;
    if (exponent < unit) {
        uint down = unit - exponent;
        result.low = down < 24u ? digits >> down : 0u;
    } else {
        uint up = (exponent - unit) & 31u;
        result.low = digits << up;
        result.high = up == 0u ? 0u : digits >> (32u - up);
    }
    if (bits >> 31u != 0u) result = negated_fixed(result);
    return result;
}

KERNEL_FN Fixed difference_of(real a, real b)
{
    Fixed p = fixed_of(a, UNIT_OF_COORDINATES);
    Fixed q = fixed_of(b, UNIT_OF_COORDINATES);
    Fixed result;
    result.low = p.low - q.low;
    result.high = p.high - q.high - (p.low < q.low ? 1u : 0u);
    return result;
}

KERNEL_FN bool is_negative(Fixed a)
{
    return a.high >> 31u != 0u;
}

// Read anew for each use: a GPU lacks registers for three corners.
KERNEL_FN real coordinate_of(SceneView scene, uint quad, uint axis)
{
    uint4 words = FETCH(scene, leaf_triangles, quad);
    return as_real(axis == 0u ? words.x : axis == 1u ? words.y : words.z);
}

// Of a coordinate of corner `quad`, less that of the first corner `from`.
KERNEL_FN Fixed edge_of(SceneView scene, uint quad, uint from, uint axis)
{
    return difference_of(coordinate_of(scene, quad, axis), coordinate_of(scene, from, axis));
}

// Numbers of 352 bits in two's complement: seven slots, 0 to 6, and what may be done with them. Coordinates and
// directions are at most 2^6, so no value here takes more than 341 bits.
//   WIDE_SLOTS                         declares the slots
//   COPY_WIDE(to, from)
//   SET_WIDE(to, fixed)
//   NEGATE_WIDE(at)
//   UP_A_WORD(at)                      times 2^32
//   ADD_PRODUCT(to, from, word)        adds a slot's product with a word
//   ADD_FIXED_PRODUCT(to, from, fixed)
//   LOW_WORD(at, number)               0 to 4
//   IS_NEGATIVE_WIDE(at), IS_ZERO_WIDE(at)
#ifdef WIDE_IN_REGISTERS
#include "kernels/bvh/wide_in_registers.h"
#else
#include "kernels/bvh/wide_in_memory.h"
#endif

// Whether leaf triangle a is before b: nearer, or as near and earlier in the input. depth_a, depth_b: by floats. A
// triangle's depth is that at which the exact ray meets its plane; or its float depth, if they are NEAR_KEY apart or
// more, or if the ray is in the plane.
RARE_FN bool is_before_exactly(SceneView scene, Ray ray, uint a, real depth_a, uint b, real depth_b)
{
    // Slots 0 and 1: the depth of b, then of a, above / below, in units of 2^-40; below is positive, and below 2^160.
    // First, 1 is the plane's normal times the direction. 2 and 3: the depth of b. 4: of a plane, its normal's
    // component; 5: a difference of coordinates; 6: the plane's normal times a vertex, seen from the origin.
    WIDE_SLOTS
    Fixed zero;
    zero.low = 0u;
    zero.high = 0u;
    Fixed one = zero;
    one.low = 1u;
    SET_WIDE(0, zero)
    SET_WIDE(1, zero)
    KEEP_LOOP
    for (uint second = 0u; second < 2u; ++second) {
        COPY_WIDE(2, 0)
        COPY_WIDE(3, 1)
        uint first = LEAF_TRIANGLE_QUADS * (second == 0u ? b : a);
        SET_WIDE(6, zero)
        SET_WIDE(1, zero)
        KEEP_LOOP
        for (uint axis = 0u; axis < 3u; ++axis) {
            uint x = axis == 2u ? 0u : axis + 1u; // cyclic, with `axis` the third
            uint y = axis == 0u ? 2u : axis - 1u;
            SET_WIDE(4, zero)
            SET_WIDE(5, edge_of(scene, first + 1u, first, y))
            ADD_FIXED_PRODUCT(4, 5, edge_of(scene, first, first + 2u, x))
            SET_WIDE(5, edge_of(scene, first + 1u, first, x))
            ADD_FIXED_PRODUCT(4, 5, edge_of(scene, first + 2u, first, y))
            ADD_FIXED_PRODUCT(6, 4, difference_of(coordinate_of(scene, first, axis), component(ray.origin, axis)))
            ADD_FIXED_PRODUCT(1, 4, fixed_of(component(ray.direction, axis), UNIT_OF_DIRECTIONS))
        }
        if (IS_NEGATIVE_WIDE(1)) {
            NEGATE_WIDE(6)
            NEGATE_WIDE(1)
        }
        real deepest = magnitude(component(ray.direction, deepest_axis(ray.direction)));
        Fixed rounded = fixed_of(second == 0u ? depth_b : depth_a, UNIT_OF_COORDINATES);
        SET_WIDE(0, zero)
        ADD_FIXED_PRODUCT(0, 6, fixed_of(deepest, UNIT_OF_DIRECTIONS))
        // Slot 4: less than nothing by as much as the float depth is off, and NEAR_KEY more.
        COPY_WIDE(4, 0)
        ADD_FIXED_PRODUCT(4, 1, negated_fixed(rounded))
        if (!IS_NEGATIVE_WIDE(4)) {
            NEGATE_WIDE(4)
        }
        ADD_PRODUCT(4, 1, NEAR_KEY)
        NEGATE_WIDE(4)
        if (!IS_NEGATIVE_WIDE(4)) {
            SET_WIDE(0, rounded)
            SET_WIDE(1, one)
        }
    }
    NEGATE_WIDE(2)
    SET_WIDE(4, zero) // becomes the depth of a less that of b, times both denominators
    KEEP_LOOP
    for (uint digit = 5u; digit > 0u; --digit) {
        UP_A_WORD(4)
        ADD_PRODUCT(4, 0, LOW_WORD(3, digit - 1u))
        ADD_PRODUCT(4, 2, LOW_WORD(1, digit - 1u))
    }
    uint number_a = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * a).w;
    uint number_b = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * b).w;
    return IS_ZERO_WIDE(4) ? number_a < number_b : IS_NEGATIVE_WIDE(4);
}

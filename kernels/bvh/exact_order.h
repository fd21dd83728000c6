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

// Numbers of 352 bits in two's complement are slots of an array `wide`, the lowest word first. Coordinates and
// directions are at most 2^6, so no value here takes more than 341 bits. Each operation is a loop that is kept: an
// array indexed by one stays in memory, so that a GPU that needs this for few rays keeps its registers for all
// (results/registers.md). They are statements, since a function of this language copies the arrays that it gets.
#define WIDE_WORDS 11u
#define SLOT(number) ((number)*WIDE_WORDS)

// Slot `to` becomes a Fixed.
#define SET_WIDE(to, fixed)                                                                                            \
    {                                                                                                                  \
        Fixed value = fixed;                                                                                           \
        uint sign = is_negative(value) ? ~0u : 0u;                                                                     \
        KEEP_LOOP                                                                                                      \
        for (uint word = 0u; word < WIDE_WORDS; ++word)                                                                \
            wide[SLOT(to) + word] = word == 0u ? value.low : word == 1u ? value.high : sign;                           \
    }

// Slot `at` changes its sign.
#define NEGATE_WIDE(at)                                                                                                \
    {                                                                                                                  \
        uint carry = 1u;                                                                                               \
        KEEP_LOOP                                                                                                      \
        for (uint word = 0u; word < WIDE_WORDS; ++word) {                                                              \
            uint inverted = ~wide[SLOT(at) + word];                                                                    \
            wide[SLOT(at) + word] = inverted + carry;                                                                  \
            carry = inverted + carry < carry ? 1u : 0u;                                                                \
        }                                                                                                              \
    }

// Slot `to` grows, or shrinks if `shrinks`, by slot `from` times 2^(32 up) times a word.
#define ADD_PRODUCT(to, from, up, factor, shrinks)                                                                     \
    {                                                                                                                  \
        uint carry = 0u;                                                                                               \
        KEEP_LOOP                                                                                                      \
        for (uint word = (up); word < WIDE_WORDS; ++word) {                                                            \
            uint multiplied = wide[SLOT(from) + word - (up)];                                                          \
            uint old = wide[SLOT(to) + word];                                                                          \
            uint part = multiplied * (factor) + carry;                                                                 \
            carry = high_product(multiplied, factor) + (part < carry ? 1u : 0u);                                       \
            uint changed = (shrinks) ? old - part : old + part;                                                        \
            carry += ((shrinks) ? old < part : changed < part) ? 1u : 0u;                                              \
            wide[SLOT(to) + word] = changed;                                                                           \
        }                                                                                                              \
    }

// Slot `to` grows by slot `from` times a Fixed.
#define ADD_FIXED_PRODUCT(to, from, factor)                                                                            \
    {                                                                                                                  \
        Fixed signed_factor = factor;                                                                                  \
        bool is_minus = is_negative(signed_factor);                                                                    \
        Fixed size = is_minus ? negated_fixed(signed_factor) : signed_factor;                                          \
        KEEP_LOOP                                                                                                      \
        for (uint up = 0u; up < 2u; ++up)                                                                              \
            ADD_PRODUCT(to, from, up, up == 0u ? size.low : size.high, is_minus)                                       \
    }

#define IS_NEGATIVE_WIDE(at) (wide[SLOT(at) + WIDE_WORDS - 1u] >> 31u != 0u)

// Whether leaf triangle a is before b: nearer, or as near and earlier in the input. depth_a, depth_b: by floats. A
// triangle's depth is that at which the exact ray meets its plane; or its float depth, if they are NEAR_KEY apart or
// more, or if the ray is in the plane.
RARE_FN bool is_before_exactly(SceneView scene, Ray ray, uint a, real depth_a, uint b, real depth_b)
{
    // Slots 0 and 1: the depth of a, above / below, in units of 2^-40; below is positive, and below 2^160. 2 and 3:
    // that of b. 4: of a plane, its normal's component; 5: a difference of coordinates; 6: the plane's normal times a
    // vertex, seen from the origin. `below` is first the normal times the direction.
    uint wide[SLOT(7)];
    Fixed zero;
    zero.low = 0u;
    zero.high = 0u;
    Fixed one = zero;
    one.low = 1u;
    KEEP_LOOP
    for (uint second = 0u; second < 2u; ++second) {
        uint above = 2u * second;
        uint below = above + 1u;
        uint first = LEAF_TRIANGLE_QUADS * (second == 0u ? a : b);
        SET_WIDE(6u, zero)
        SET_WIDE(below, zero)
        KEEP_LOOP
        for (uint axis = 0u; axis < 3u; ++axis) {
            uint x = axis == 2u ? 0u : axis + 1u; // cyclic, with `axis` the third
            uint y = axis == 0u ? 2u : axis - 1u;
            SET_WIDE(4u, zero)
            SET_WIDE(5u, edge_of(scene, first + 1u, first, y))
            ADD_FIXED_PRODUCT(4u, 5u, edge_of(scene, first, first + 2u, x))
            SET_WIDE(5u, edge_of(scene, first + 1u, first, x))
            ADD_FIXED_PRODUCT(4u, 5u, edge_of(scene, first + 2u, first, y))
            ADD_FIXED_PRODUCT(6u, 4u, difference_of(coordinate_of(scene, first, axis), component(ray.origin, axis)))
            ADD_FIXED_PRODUCT(below, 4u, fixed_of(component(ray.direction, axis), UNIT_OF_DIRECTIONS))
        }
        if (IS_NEGATIVE_WIDE(below)) {
            NEGATE_WIDE(6u)
            NEGATE_WIDE(below)
        }
        real deepest = magnitude(component(ray.direction, deepest_axis(ray.direction)));
        Fixed rounded = fixed_of(second == 0u ? depth_a : depth_b, UNIT_OF_COORDINATES);
        SET_WIDE(above, zero)
        ADD_FIXED_PRODUCT(above, 6u, fixed_of(deepest, UNIT_OF_DIRECTIONS))
        // Slot 4: less than nothing by as much as the float depth is off, and NEAR_KEY more.
        SET_WIDE(4u, zero)
        ADD_PRODUCT(4u, above, 0u, 1u, false)
        ADD_FIXED_PRODUCT(4u, below, negated_fixed(rounded))
        if (!IS_NEGATIVE_WIDE(4u)) NEGATE_WIDE(4u)
        ADD_PRODUCT(4u, below, 0u, NEAR_KEY, false)
        NEGATE_WIDE(4u)
        if (!IS_NEGATIVE_WIDE(4u)) {
            SET_WIDE(above, rounded)
            SET_WIDE(below, one)
        }
    }
    SET_WIDE(4u, zero) // becomes the depth of a less that of b, times both denominators
    KEEP_LOOP
    for (uint up = 0u; up < 5u; ++up) {
        ADD_PRODUCT(4u, 0u, up, wide[SLOT(3u) + up], false)
        ADD_PRODUCT(4u, 2u, up, wide[SLOT(1u) + up], true)
    }
    uint any = 0u;
    KEEP_LOOP
    for (uint word = 0u; word < WIDE_WORDS; ++word)
        any |= wide[SLOT(4u) + word];
    uint number_a = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * a).w;
    uint number_b = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * b).w;
    return any == 0u ? number_a < number_b : IS_NEGATIVE_WIDE(4u);
}
#undef IS_NEGATIVE_WIDE
#undef ADD_FIXED_PRODUCT
#undef ADD_PRODUCT
#undef NEGATE_WIDE
#undef SET_WIDE
#undef SLOT
#undef WIDE_WORDS

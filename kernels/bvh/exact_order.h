// Which of two triangles a ray meets first, in integers: nearer_triangle() asks if float depths leave it open. The
// depths of their planes along the exact ray are fractions; nothing is rounded (docs/spec/bvhs.md, B15).

// A coordinate, or a depth, in units of 2^-40; a component of a direction in units of 2^-43. Two's complement.
STRUCT(Fixed)
{
    uint low;
    uint high;
};

// 352 bits, in two's complement. Coordinates and directions are at most 2^6, so no value here takes more than 341.
STRUCT(Wide)
{
    uint w0;
    uint w1;
    uint w2;
    uint w3;
    uint w4;
    uint w5;
    uint w6;
    uint w7;
    uint w8;
    uint w9;
    uint w10;
};

// A depth above / below, in units of 2^-40. below: positive, and below 2^160.
STRUCT(ExactDepth)
{
    Wide above;
    Wide below;
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

KERNEL_FN Wide wide_of(Fixed a)
{
    uint sign = a.high >> 31u != 0u ? 0xFFFFFFFFu : 0u;
    Wide result;
    result.w0 = a.low;
    result.w1 = a.high;
    result.w2 = sign;
    result.w3 = sign;
    result.w4 = sign;
    result.w5 = sign;
    result.w6 = sign;
    result.w7 = sign;
    result.w8 = sign;
    result.w9 = sign;
    result.w10 = sign;
    return result;
}

KERNEL_FN Wide small_wide(uint a)
{
    Fixed value;
    value.low = a;
    value.high = 0u;
    return wide_of(value);
}

// A word of sum + a * factor; its carry is below 2^32.
#define ADD_WORD_OF_PRODUCT(word)                                                                                      \
    low = a.word * factor;                                                                                             \
    high = high_product(a.word, factor);                                                                               \
    low += carry;                                                                                                      \
    high += low < carry ? 1u : 0u;                                                                                     \
    result.word = sum.word + low;                                                                                      \
    carry = high + (result.word < low ? 1u : 0u);

KERNEL_FN Wide plus_product(Wide sum, Wide a, uint factor)
{
    uint low;
    uint high;
    uint carry = 0u;
    Wide result;
    ADD_WORD_OF_PRODUCT(w0)
    ADD_WORD_OF_PRODUCT(w1)
    ADD_WORD_OF_PRODUCT(w2)
    ADD_WORD_OF_PRODUCT(w3)
    ADD_WORD_OF_PRODUCT(w4)
    ADD_WORD_OF_PRODUCT(w5)
    ADD_WORD_OF_PRODUCT(w6)
    ADD_WORD_OF_PRODUCT(w7)
    ADD_WORD_OF_PRODUCT(w8)
    ADD_WORD_OF_PRODUCT(w9)
    ADD_WORD_OF_PRODUCT(w10)
    return result;
}
#undef ADD_WORD_OF_PRODUCT

KERNEL_FN Wide negated_wide(Wide a)
{
    Wide inverted;
    inverted.w0 = ~a.w0;
    inverted.w1 = ~a.w1;
    inverted.w2 = ~a.w2;
    inverted.w3 = ~a.w3;
    inverted.w4 = ~a.w4;
    inverted.w5 = ~a.w5;
    inverted.w6 = ~a.w6;
    inverted.w7 = ~a.w7;
    inverted.w8 = ~a.w8;
    inverted.w9 = ~a.w9;
    inverted.w10 = ~a.w10;
    return plus_product(small_wide(1u), inverted, 1u);
}

KERNEL_FN bool is_negative(Wide a)
{
    return a.w10 >> 31u != 0u;
}

KERNEL_FN bool is_zero(Wide a)
{
    return (a.w0 | a.w1 | a.w2 | a.w3 | a.w4 | a.w5 | a.w6 | a.w7 | a.w8 | a.w9 | a.w10) == 0u;
}

// a * 2^32.
KERNEL_FN Wide up_a_word(Wide a)
{
    Wide result;
    result.w0 = 0u;
    result.w1 = a.w0;
    result.w2 = a.w1;
    result.w3 = a.w2;
    result.w4 = a.w3;
    result.w5 = a.w4;
    result.w6 = a.w5;
    result.w7 = a.w6;
    result.w8 = a.w7;
    result.w9 = a.w8;
    result.w10 = a.w9;
    return result;
}

// sum + a * factor.
KERNEL_FN Wide plus_signed_product(Wide sum, Wide a, Fixed factor)
{
    Wide multiplied = a;
    Fixed size = factor;
    if (factor.high >> 31u != 0u) {
        multiplied = negated_wide(a);
        size = negated_fixed(factor);
    }
    return plus_product(plus_product(sum, up_a_word(multiplied), size.high), multiplied, size.low);
}

KERNEL_FN Vec3 corner_of(SceneView scene, uint quad)
{
    uint4 words = FETCH(scene, leaf_triangles, quad);
    return VEC3(as_real(words.x), as_real(words.y), as_real(words.z));
}

// The depth at which the exact ray meets the plane of leaf triangle `at`; or `depth`, its float depth, if they are
// NEAR_KEY apart or more, or if the ray is in the plane.
KERNEL_FN ExactDepth exact_depth(SceneView scene, Ray ray, uint at, real depth)
{
    Vec3 v0 = corner_of(scene, LEAF_TRIANGLE_QUADS * at);
    Vec3 v1 = corner_of(scene, LEAF_TRIANGLE_QUADS * at + 1u);
    Vec3 v2 = corner_of(scene, LEAF_TRIANGLE_QUADS * at + 2u);
    Wide along = small_wide(0u); // the plane's normal times a vertex, seen from the origin,
    Wide across = along;         // and times the direction
    for (uint axis = 0u; axis < 3u; ++axis) {
        Vec3 a = permuted_from(v0, axis);
        Vec3 b = permuted_from(v1, axis);
        Vec3 c = permuted_from(v2, axis);
        Wide minus = plus_signed_product(small_wide(0u), wide_of(difference_of(b.y, a.y)), difference_of(a.x, c.x));
        Wide normal = plus_signed_product(minus, wide_of(difference_of(b.x, a.x)), difference_of(c.y, a.y));
        along = plus_signed_product(along, normal, difference_of(a.z, component(ray.origin, axis)));
        across = plus_signed_product(across, normal, fixed_of(component(ray.direction, axis), UNIT_OF_DIRECTIONS));
    }
    if (is_negative(across)) {
        along = negated_wide(along);
        across = negated_wide(across);
    }
    Fixed rounded = fixed_of(depth, UNIT_OF_COORDINATES);
    real deepest = magnitude(component(ray.direction, deepest_axis(ray.direction)));
    ExactDepth exact;
    exact.above = plus_signed_product(small_wide(0u), along, fixed_of(deepest, UNIT_OF_DIRECTIONS));
    exact.below = across;
    Wide off = plus_signed_product(exact.above, across, negated_fixed(rounded));
    if (!is_negative(off)) off = negated_wide(off);
    if (!is_negative(negated_wide(plus_product(off, across, NEAR_KEY)))) {
        exact.above = wide_of(rounded);
        exact.below = small_wide(1u);
    }
    return exact;
}

// Word 0 to 4.
KERNEL_FN uint low_word(Wide a, uint word)
{
    uint even = word == 0u ? a.w0 : word == 2u ? a.w2 : a.w4;
    return word == 1u ? a.w1 : word == 3u ? a.w3 : even;
}

// Whether leaf triangle a is before b: nearer, or as near and earlier in the input. depth_a, depth_b: by floats.
RARE_FN bool is_before_exactly(SceneView scene, Ray ray, uint a, real depth_a, uint b, real depth_b)
{
    ExactDepth depth;
    depth.above = small_wide(0u);
    depth.below = depth.above;
    ExactDepth other = depth;
    for (uint second = 0u; second < 2u; ++second) {
        other = depth;
        depth = exact_depth(scene, ray, second == 0u ? b : a, second == 0u ? depth_b : depth_a);
    }
    Wide minus = negated_wide(other.above);
    Wide difference = small_wide(0u);
    for (uint word = 5u; word > 0u; --word) {
        difference = plus_product(up_a_word(difference), depth.above, low_word(other.below, word - 1u));
        difference = plus_product(difference, minus, low_word(depth.below, word - 1u));
    }
    uint number_a = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * a).w;
    uint number_b = FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * b).w;
    return is_zero(difference) ? number_a < number_b : is_negative(difference);
}

// triangle.h for processors with SSE2: the ray's axes, and a triangle's vertices, in the lanes of one register. Each
// lane does what triangle.h does, so all numbers are the same (docs/spec/bvhs.md, B13).

// Lane i of the result is lane (i + 1) % 3, or (i + 2) % 3, for i < 3.
KERNEL_FN __m128 next_lanes(__m128 a)
{
    return _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 0, 2, 1));
}
KERNEL_FN __m128 previous_lanes(__m128 a)
{
    return _mm_shuffle_ps(a, a, _MM_SHUFFLE(3, 1, 0, 2));
}

STRUCT(Lanes3)
{
    __m128 x;
    __m128 y;
    __m128 z;
};

KERNEL_FN Lanes3 each_in_all_lanes(__m128 a)
{
    return {_mm_shuffle_ps(a, a, 0x00), _mm_shuffle_ps(a, a, 0x55), _mm_shuffle_ps(a, a, 0xAA)};
}

// dot3(); with at most two products that are not zero, any order is the same.
KERNEL_FN __m128 dot_lanes(Lanes3 a, Lanes3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

STRUCT(RayFrame)
{
    Ray ray;
    __m128 origin;
    __m128 inverse;  // the depth of one unit along each axis
    __m128 offset;   // origin * inverse
    Lanes3 inverses; // each component in all lanes
    Lanes3 offsets;
    Lanes3 origins;
    Lanes3 across; // a point's products with these, from the origin on, are its x and y times 2^20, as in shear.h,
    Lanes3 upwards;
    __m128 forwards; // its products with this add up to its depth times 2^40
};

KERNEL_FN RayFrame frame_of(Ray ray)
{
    const __m128 direction = _mm_setr_ps(ray.direction.x, ray.direction.y, ray.direction.z, 0.0f);
    const __m128 origin = _mm_setr_ps(ray.origin.x, ray.origin.y, ray.origin.z, 0.0f);
    const __m128 sign_bit = _mm_castsi128_ps(_mm_slli_epi32(_mm_set1_epi32(1), 31));
    const __m128 sign = _mm_and_ps(direction, sign_bit);
    const __m128 size = _mm_xor_ps(direction, sign);
    const __m128 deepest = _mm_max_ps(_mm_max_ps(size, next_lanes(size)), previous_lanes(size));
    // The axis of the first of equally large components.
    const __m128i largest = _mm_castps_si128(_mm_cmpeq_ps(size, deepest));
    const __m128i above_one = _mm_or_si128(_mm_slli_si128(largest, 4), _mm_slli_si128(largest, 8));
    const __m128i above = _mm_or_si128(above_one, _mm_slli_si128(largest, 12));
    const __m128 axis = _mm_castsi128_ps(_mm_andnot_si128(above, largest));

    const __m128 scaled = direction * _mm_set1_ps(1048576.0f);
    const __m128 of_axis = _mm_and_ps(axis, scaled);
    const __m128 negated = _mm_xor_ps(scaled, sign_bit);
    const __m128 across = _mm_or_ps(previous_lanes(of_axis), _mm_and_ps(axis, next_lanes(negated)));
    const __m128 upwards = _mm_or_ps(next_lanes(of_axis), _mm_and_ps(axis, previous_lanes(negated)));
    const __m128 forwards = _mm_and_ps(axis, _mm_or_ps(sign, _mm_set1_ps(1099511627776.0f))); // 2^40

    const __m128 is_zero = _mm_cmpeq_ps(direction, _mm_setzero_ps());
    const __m128 instead = _mm_and_ps(is_zero, _mm_set1_ps(8.27180612553027675e-25f)); // as depth_per_unit()
    const __m128 inverse = deepest / _mm_or_ps(_mm_andnot_ps(is_zero, direction), instead);
    return {ray,
            origin,
            inverse,
            origin * inverse,
            each_in_all_lanes(inverse),
            each_in_all_lanes(origin * inverse),
            each_in_all_lanes(origin),
            each_in_all_lanes(across),
            each_in_all_lanes(upwards),
            forwards};
}

KERNEL_FN Ray ray_of(const RayFrame& frame)
{
    return frame.ray;
}

// lost_by() of shear.h. What a product loses is a float (B8), so a fused product has the same bits.
KERNEL_FN __m128 lost_in_lanes(__m128 a, __m128 b, __m128 product)
{
#ifdef __FMA__
    return _mm_fmsub_ps(a, b, product);
#else
    const __m128 split = _mm_set1_ps(4097.0f);
    const __m128 a_large = a * split;
    const __m128 a_high = a_large - (a_large - a);
    const __m128 a_low = a - a_high;
    const __m128 b_large = b * split;
    const __m128 b_high = b_large - (b_large - b);
    const __m128 b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
#endif
}

// Whether plus - minus is below 0 in some lane, and above in another. One branch: each half of the answer by itself is
// hard to predict. Only an empty mask is negative less one.
KERNEL_FN bool has_two_signs(__m128 plus, __m128 minus)
{
    const int below = _mm_movemask_ps(_mm_cmplt_ps(plus, minus)), above = _mm_movemask_ps(_mm_cmpgt_ps(plus, minus));
    return ((below - 1) | (above - 1)) >= 0;
}

KERNEL_FN __m128 quad_in_lanes(const uint4& quad)
{
    return _mm_loadu_ps(reinterpret_cast<const float*>(&quad));
}

// The depth of leaf triangle `at`, or NEVER if the ray does not meet it.
KERNEL_FN real triangle_depth(SceneView scene, const RayFrame& frame, uint at)
{
    const __m128 a = quad_in_lanes(FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at));
    const __m128 b = quad_in_lanes(FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at + 1u));
    const __m128 c = quad_in_lanes(FETCH(scene, leaf_triangles, LEAF_TRIANGLE_QUADS * at + 2u));
    // The vertices' lanes are a, b, c, c; their numbers in word w take part in no arithmetic.
    const __m128 xy = _mm_unpacklo_ps(a, b), z = _mm_unpackhi_ps(a, b);
    const Lanes3 offset = {_mm_shuffle_ps(xy, c, _MM_SHUFFLE(0, 0, 1, 0)) - frame.origins.x,
                           _mm_shuffle_ps(xy, c, _MM_SHUFFLE(1, 1, 3, 2)) - frame.origins.y,
                           _mm_shuffle_ps(z, c, _MM_SHUFFLE(2, 2, 1, 0)) - frame.origins.z};
    const __m128 x = dot_lanes(offset, frame.across), y = dot_lanes(offset, frame.upwards);
    // Sides of the edges from a to b, b to c, c to a, c to a.
    const __m128 next_x = _mm_shuffle_ps(x, x, _MM_SHUFFLE(0, 0, 2, 1));
    const __m128 next_y = _mm_shuffle_ps(y, y, _MM_SHUFFLE(0, 0, 2, 1));
    const __m128 plus = x * next_y, minus = y * next_x;
    if (has_two_signs(plus, minus)) return NEVER;

    const __m128 fine = (plus - minus) + (lost_in_lanes(x, next_y, plus) - lost_in_lanes(y, next_x, minus));
    const __m128 sides = next_lanes(fine); // opposite a, b, c
    const Lanes3 side = each_in_all_lanes(sides),
                 part = each_in_all_lanes(sides * dot_lanes(offset, each_in_all_lanes(frame.forwards)));
    const real determinant = _mm_cvtss_f32(side.x + side.y + side.z);
    if (has_two_signs(fine, _mm_setzero_ps()) || determinant == 0.0f) return NEVER;
    return depth_of_mean(_mm_cvtss_f32(part.x + part.y + part.z), determinant);
}

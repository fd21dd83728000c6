// visit_of() of cwbvh.h for processors: a node's eight children at once by AVX2, else four and four. The depths, and so
// the hits, are those of cwbvh.h (docs/spec/bvhs.md, B13).
#ifdef __AVX2__
#define SLOTS_AT_ONCE 8u
using Slots = __m256;

STRUCT(Slots3)
{
    Slots x;
    Slots y;
    Slots z;
};

KERNEL_FN Slots in_all_slots(real a)
{
    return _mm256_set1_ps(a);
}
KERNEL_FN Slots3 each_in_all_slots(__m128 a)
{
    const Slots twice = _mm256_set_m128(a, a);
    return {_mm256_permute_ps(twice, 0x00), _mm256_permute_ps(twice, 0x55), _mm256_permute_ps(twice, 0xAA)};
}
KERNEL_FN Slots minimum(Slots a, Slots b)
{
    return _mm256_min_ps(a, b);
}
KERNEL_FN Slots maximum(Slots a, Slots b)
{
    return _mm256_max_ps(a, b);
}
KERNEL_FN __m256i words_of(const unsigned char* bytes)
{
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes)));
}
KERNEL_FN Slots planes_of(const unsigned char* bytes)
{
    return _mm256_cvtepi32_ps(words_of(bytes));
}
KERNEL_FN uint hits_of_slots(Slots near, Slots far, uint octant, const unsigned char* meta)
{
    const __m256i child = words_of(meta), inner = _mm256_set1_epi32(24);
    const __m256i is_inner = _mm256_cmpeq_epi32(_mm256_and_si256(child, inner), inner);
    const __m256i octants = _mm256_and_si256(is_inner, _mm256_set1_epi32(static_cast<int>(octant)));
    const __m256i bit = _mm256_xor_si256(_mm256_and_si256(child, _mm256_set1_epi32(31)), octants);
    const __m256i bits = _mm256_sllv_epi32(_mm256_srli_epi32(child, 5), bit);
    const __m256i met = _mm256_and_si256(bits, _mm256_castps_si256(_mm256_cmp_ps(near, far, _CMP_LE_OQ)));
    const __m128i half = _mm_or_si128(_mm256_castsi256_si128(met), _mm256_extracti128_si256(met, 1));
    const __m128i quarter = _mm_or_si128(half, _mm_srli_si128(half, 8));
    return static_cast<uint>(_mm_cvtsi128_si32(_mm_or_si128(quarter, _mm_srli_si128(quarter, 4))));
}
#else
#define SLOTS_AT_ONCE 4u
using Slots = __m128;
using Slots3 = Lanes3;

KERNEL_FN Slots in_all_slots(real a)
{
    return _mm_set1_ps(a);
}
KERNEL_FN Slots3 each_in_all_slots(__m128 a)
{
    return each_in_all_lanes(a);
}
KERNEL_FN Slots minimum(Slots a, Slots b)
{
    return _mm_min_ps(a, b);
}
KERNEL_FN Slots maximum(Slots a, Slots b)
{
    return _mm_max_ps(a, b);
}
KERNEL_FN __m128i words_of(const unsigned char* bytes)
{
    const __m128i zero = _mm_setzero_si128();
    return _mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_loadu_si32(bytes), zero), zero);
}
KERNEL_FN Slots planes_of(const unsigned char* bytes)
{
    return _mm_cvtepi32_ps(words_of(bytes));
}
// SSE2 shifts all lanes by one number, so lanes are shifted by products with powers of two. 2^31 is too large for a
// signed number, for which the conversion has that very word.
KERNEL_FN uint hits_of_slots(Slots near, Slots far, uint octant, const unsigned char* meta)
{
    const __m128i child = words_of(meta), inner = _mm_set1_epi32(24);
    const __m128i is_inner = _mm_cmpeq_epi32(_mm_and_si128(child, inner), inner);
    const __m128i octants = _mm_and_si128(is_inner, _mm_set1_epi32(static_cast<int>(octant)));
    const __m128i bit = _mm_xor_si128(_mm_and_si128(child, _mm_set1_epi32(31)), octants);
    const __m128 power = _mm_castsi128_ps(_mm_slli_epi32(_mm_add_epi32(bit, _mm_set1_epi32(127)), 23));
    const __m128i bits = _mm_cvttps_epi32(_mm_cvtepi32_ps(_mm_srli_epi32(child, 5)) * power);
    const __m128i met = _mm_and_si128(bits, _mm_castps_si128(_mm_cmple_ps(near, far)));
    const __m128i half = _mm_or_si128(met, _mm_srli_si128(met, 8));
    return static_cast<uint>(_mm_cvtsi128_si32(_mm_or_si128(half, _mm_srli_si128(half, 4))));
}
#endif

KERNEL_FN Visit visit_of(SceneView scene, const RayFrame& frame, real limit, uint octant, uint node)
{
    COUNT_NODE();
    const uint4& r0 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node);
    const uint4& r1 = FETCH(scene, nodes, CWBVH_NODE_QUADS * node + 1u);
    const auto* const bytes = reinterpret_cast<const unsigned char*>(&r0);
    const __m128i zero = _mm_setzero_si128();
    const __m128i exponents = _mm_unpacklo_epi16(_mm_unpacklo_epi8(_mm_loadu_si32(&r0.w), zero), zero);
    const __m128 corner = _mm_and_ps(quad_in_lanes(r0), _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0)));
    const __m128 step = _mm_castsi128_ps(_mm_slli_epi32(exponents, 23)) * frame.inverse;
    const __m128 start = (corner - frame.origin) * frame.inverse;
    const Slots3 steps = each_in_all_slots(step), starts = each_in_all_slots(start);
    Visit visit;
    visit.hits = 0u;
    for (uint slot = 0u; slot < 8u; slot += SLOTS_AT_ONCE) {
        // Of each axis the eight planes where boxes begin, then those where they end.
        const unsigned char* const low = bytes + 32u + slot;
        const auto plane = [&](uint axis, bool is_high, Slots of_step, Slots of_start) {
            return planes_of(low + 8u * axis + (is_high ? 24u : 0u)) * of_step + of_start;
        };
        const bool up_x = (octant & 4u) != 0u, up_y = (octant & 2u) != 0u, up_z = (octant & 1u) != 0u;
        const Slots near = maximum(maximum(plane(0u, !up_x, steps.x, starts.x), plane(1u, !up_y, steps.y, starts.y)),
                                   maximum(plane(2u, !up_z, steps.z, starts.z), Slots{}));
        const Slots far = minimum(minimum(plane(0u, up_x, steps.x, starts.x), plane(1u, up_y, steps.y, starts.y)),
                                  minimum(plane(2u, up_z, steps.z, starts.z), in_all_slots(limit)));
        visit.hits |= hits_of_slots(near, far * in_all_slots(BOX_SLACK), octant, bytes + 24u + slot);
    }
    visit.inner = r0.w >> 24u;
    visit.children = r1.x;
    visit.triangles = r1.y;
    return visit;
}
#undef SLOTS_AT_ONCE

KERNEL_FN uint octant_of(const RayFrame& frame)
{
    const uint down = static_cast<uint>(_mm_movemask_ps(frame.inverse));
    return 7u ^ ((down << 2u & 4u) | (down & 2u) | (down >> 2u & 1u));
}

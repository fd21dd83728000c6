// A small vector layer for packets: LANES floats or words, 4, 8 (AVX2) or 16 (AVX-512). Arithmetic uses the compilers'
// vector types, IEEE lane by lane. This file adds masks, which differ most among processors, and the loading of
// records. For inclusion in an unnamed namespace, with LANES set: nothing here may be shared with code that is compiled
// for another processor. Include <cstdint>, <immintrin.h> for 8 and 16 lanes, and layout.h before it.
#define LANE_FN [[maybe_unused, gnu::always_inline]] inline

using uint = std::uint32_t;
using Floats = float __attribute__((vector_size(4 * LANES)));
using Words = uint __attribute__((vector_size(4 * LANES)));
using Ints = int __attribute__((vector_size(4 * LANES)));
using Longs = std::uint64_t __attribute__((vector_size(4 * LANES)));

constexpr uint every_lane = (1u << LANES) - 1u;

LANE_FN Floats as_floats(Words a)
{
    return reinterpret_cast<Floats>(a);
}
LANE_FN Words as_words(Floats a)
{
    return reinterpret_cast<Words>(a);
}
LANE_FN Floats all(float a)
{
    return a - Floats{};
}
LANE_FN Words all(uint a)
{
    return a - Words{};
}
// As many lanes, or all.
LANE_FN uint first_lanes(uint count)
{
    return count < LANES ? (1u << count) - 1u : every_lane;
}
LANE_FN uint first_of(uint lanes)
{
    return static_cast<uint>(__builtin_ctz(lanes));
}

#if LANES == 16
struct Mask {
    __mmask16 of;
};
LANE_FN Mask mask_of(uint lanes)
{
    return {static_cast<__mmask16>(lanes)};
}
LANE_FN uint lanes_of(Mask a)
{
    return a.of;
}
// By instructions on masks: compilers move masks to integer registers and back for & and |.
LANE_FN Mask operator&(Mask a, Mask b)
{
    return {_kand_mask16(a.of, b.of)};
}
LANE_FN Mask operator|(Mask a, Mask b)
{
    return {_kor_mask16(a.of, b.of)};
}
LANE_FN Mask without(Mask a, Mask b)
{
    return {_kandn_mask16(b.of, a.of)};
}
LANE_FN Mask neither(Mask a, Mask b)
{
    return {_knot_mask16(_kor_mask16(a.of, b.of))};
}
LANE_FN Mask greater(Floats a, Floats b)
{
    return {_mm512_cmp_ps_mask(a, b, _CMP_GT_OQ)};
}
LANE_FN Mask equal(Floats a, Floats b)
{
    return {_mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ)};
}
LANE_FN Mask equal(Words a, Words b)
{
    return {_mm512_cmpeq_epi32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b))};
}
LANE_FN Mask greater(Words a, Words b)
{
    return {_mm512_cmpgt_epu32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b))};
}
LANE_FN Floats select(Mask mask, Floats a, Floats b)
{
    return _mm512_mask_blend_ps(mask.of, b, a);
}
LANE_FN Words select(Mask mask, Words a, Words b)
{
    return reinterpret_cast<Words>(
        _mm512_mask_blend_epi32(mask.of, reinterpret_cast<__m512i>(b), reinterpret_cast<__m512i>(a)));
}
// Replaces lanes of a vector in memory.
LANE_FN void replace(Mask mask, Floats by, Floats& of)
{
    _mm512_mask_store_ps(&of, mask.of, by);
}
#else
using Mask = Words; // all bits of a lane, or none
LANE_FN Mask without(Mask a, Mask b)
{
    return a & ~b;
}
LANE_FN Mask neither(Mask a, Mask b)
{
    return ~(a | b);
}
LANE_FN Mask greater(Floats a, Floats b)
{
    return reinterpret_cast<Mask>(a > b);
}
LANE_FN Mask equal(Floats a, Floats b)
{
    return reinterpret_cast<Mask>(a == b);
}
LANE_FN Mask equal(Words a, Words b)
{
    return reinterpret_cast<Mask>(a == b);
}
LANE_FN Mask greater(Words a, Words b)
{
    return reinterpret_cast<Mask>(a > b);
}
LANE_FN Words select(Mask mask, Words a, Words b)
{
    return (a & mask) | (b & ~mask);
}
LANE_FN Floats select(Mask mask, Floats a, Floats b)
{
    return as_floats(select(mask, as_words(a), as_words(b)));
}
LANE_FN void replace(Mask mask, Floats by, Floats& of)
{
    of = select(mask, by, of);
}
#if LANES == 8
constexpr Words lane_bits = {1, 2, 4, 8, 16, 32, 64, 128};
LANE_FN uint lanes_of(Mask a)
{
    return static_cast<uint>(_mm256_movemask_ps(reinterpret_cast<__m256>(a)));
}
#else
constexpr Words lane_bits = {1, 2, 4, 8};
LANE_FN uint lanes_of(Mask a)
{
    const Words set = a & lane_bits;
    return set[0] | set[1] | set[2] | set[3];
}
#endif
LANE_FN Mask mask_of(uint lanes)
{
    return equal(all(lanes) & lane_bits, lane_bits);
}
#endif

// a * b + c, rounded once or twice: only for error bounds.
LANE_FN Floats fused(Floats a, Floats b, Floats c)
{
#if LANES == 16
    return _mm512_fmadd_ps(a, b, c);
#else
    return a * b + c;
#endif
}

// The rounding error of a product, if it is no denormal: what lost_by() of shear.h computes.
LANE_FN Floats lost_by(Floats a, Floats b, Floats product)
{
#if LANES == 16
    return _mm512_fmsub_ps(a, b, product);
#else
    const Floats a_large = a * 4097.0f, b_large = b * 4097.0f;
    const Floats a_high = a_large - (a_large - a), b_high = b_large - (b_large - b);
    const Floats a_low = a - a_high, b_low = b - b_high;
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
#endif
}

// The upper words of the products of words.
LANE_FN Words high_product(Words a, Words b)
{
#if LANES == 16
    const auto even = [](Words of) { return reinterpret_cast<__m512i>(of); };
    const auto times = [](__m512i x, __m512i y) { // masked, with every bit: as in load_records()
        return reinterpret_cast<Longs>(_mm512_maskz_mul_epu32(0xFF, x, y));
    };
#elif LANES == 8
    const auto even = [](Words of) { return reinterpret_cast<__m256i>(of); };
    const auto times = [](__m256i x, __m256i y) { return reinterpret_cast<Longs>(_mm256_mul_epu32(x, y)); };
#else
    const auto even = [](Words of) { return reinterpret_cast<Longs>(of) & 0xFFFFFFFFu; };
    const auto times = [](Longs x, Longs y) { return x * y; };
#endif
    const auto odd = [&](Words of) { return even(reinterpret_cast<Words>(reinterpret_cast<Longs>(of) >> 32)); };
    const Longs low = times(even(a), even(b)) >> 32, high = times(odd(a), odd(b)) >> 32 << 32;
    return reinterpret_cast<Words>(low | high);
}

LANE_FN Words least(Words a, Words b)
{
    return a < b ? a : b;
}
// As minimum() and maximum() of the kernels.
LANE_FN Floats least(Floats a, Floats b)
{
    return a < b ? a : b;
}
LANE_FN Floats greatest(Floats a, Floats b)
{
    return a > b ? a : b;
}
LANE_FN Floats magnitude(Floats a)
{
    return as_floats(as_words(a) & all(0x7FFFFFFFu));
}
LANE_FN Floats negated_where(Mask mask, Floats a)
{
    return as_floats(as_words(a) ^ select(mask, all(0x80000000u), Words{}));
}

// A word a lane in memory. It is written as a vector and read word by word. A compiler that saw this would extract the
// words from the register one by one, which is slower.
struct LaneWords {
    alignas(4 * LANES) uint of[LANES];
};
LANE_FN void store(LaneWords& to, Words a)
{
#if LANES == 16
    // In halves: a word of a whole vector's upper half, loaded at once, waits much longer for the store.
    using Half = uint __attribute__((vector_size(2 * LANES)));
    *reinterpret_cast<Half*>(to.of) = __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7);
    *reinterpret_cast<Half*>(to.of + LANES / 2) = __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
#else
    *reinterpret_cast<Words*>(to.of) = a;
#endif
    asm("" : "+m"(to));
}

// Quads of 16 bytes, one a lane, in four vectors of their words. 4 x 4 words are transposed at once.
struct Quad {
    Words of[4];
};
#if LANES == 16
#define LOW_WORDS 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29
#define HIGH_WORDS 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31
#define LOW_PAIRS 0, 8, 2, 10, 4, 12, 6, 14
#define HIGH_PAIRS 1, 9, 3, 11, 5, 13, 7, 15
#define EVEN_QUADS 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27
#define ODD_QUADS 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31
#elif LANES == 8
#define LOW_WORDS 0, 8, 1, 9, 4, 12, 5, 13
#define HIGH_WORDS 2, 10, 3, 11, 6, 14, 7, 15
#define LOW_PAIRS 0, 4, 2, 6
#define HIGH_PAIRS 1, 5, 3, 7
#define EVEN_QUADS 0, 1, 2, 3, 8, 9, 10, 11
#define ODD_QUADS 4, 5, 6, 7, 12, 13, 14, 15
#else
#define LOW_WORDS 0, 4, 1, 5
#define HIGH_WORDS 2, 6, 3, 7
#define LOW_PAIRS 0, 2
#define HIGH_PAIRS 1, 3
#endif
LANE_FN Words low_pairs(Words a, Words b)
{
    return reinterpret_cast<Words>(
        __builtin_shufflevector(reinterpret_cast<Longs>(a), reinterpret_cast<Longs>(b), LOW_PAIRS));
}
LANE_FN Words high_pairs(Words a, Words b)
{
    return reinterpret_cast<Words>(
        __builtin_shufflevector(reinterpret_cast<Longs>(a), reinterpret_cast<Longs>(b), HIGH_PAIRS));
}
LANE_FN Quad transposed(Words a, Words b, Words c, Words d)
{
    const Words ab_low = __builtin_shufflevector(a, b, LOW_WORDS), cd_low = __builtin_shufflevector(c, d, LOW_WORDS);
    const Words ab_high = __builtin_shufflevector(a, b, HIGH_WORDS),
                cd_high = __builtin_shufflevector(c, d, HIGH_WORDS);
    return {{low_pairs(ab_low, cd_low), high_pairs(ab_low, cd_low), low_pairs(ab_high, cd_high),
             high_pairs(ab_high, cd_high)}};
}

using Quad4 = uint __attribute__((vector_size(16)));
LANE_FN Quad4 quad_at(const uint* words)
{
    return *reinterpret_cast<const Quad4*>(words);
}
#if LANES == 16
LANE_FN Words quads_at(const uint* base, const uint* offsets)
{
    const auto low =
        __builtin_shufflevector(quad_at(base + offsets[0]), quad_at(base + offsets[4]), 0, 1, 2, 3, 4, 5, 6, 7);
    const auto high =
        __builtin_shufflevector(quad_at(base + offsets[8]), quad_at(base + offsets[12]), 0, 1, 2, 3, 4, 5, 6, 7);
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
#elif LANES == 8
LANE_FN Words quads_at(const uint* base, const uint* offsets)
{
    return __builtin_shufflevector(quad_at(base + offsets[0]), quad_at(base + offsets[4]), 0, 1, 2, 3, 4, 5, 6, 7);
}
#else
LANE_FN Words quads_at(const uint* base, const uint* offsets)
{
    return quad_at(base + offsets[0]);
}
#endif
// offsets: in words, of one quad a lane.
LANE_FN Quad load_quads(const uint* base, const LaneWords& offsets)
{
    const uint* of = offsets.of;
    return transposed(quads_at(base, of), quads_at(base, of + 1), quads_at(base, of + 2), quads_at(base, of + 3));
}

// Prefetches what lanes will load next.
LANE_FN void prefetch_quads(const uint* base, const LaneWords& offsets)
{
    for (const uint offset : offsets.of)
        __builtin_prefetch(base + offset);
}

// Both quads of half32's records, one per lane. A load reads a whole record, which is in one cache line. A record's two
// quads are then adjacent, and the transposed vectors hold first and second quads alternately.
struct Records {
    Quad apex, exits;
};
LANE_FN Records load_records(const uint* base, const LaneWords& offsets)
{
#if LANES == 4
    return {load_quads(base, offsets), load_quads(base + 4, offsets)};
#else
    using Record = uint __attribute__((vector_size(32), aligned(16)));
    Quad half[2];
    for (uint i = 0; i < 2; ++i) {
        const auto record = [&](uint lane) {
            return reinterpret_cast<__m256i>(
                *reinterpret_cast<const Record*>(base + offsets.of[i * (LANES / 2) + lane]));
        };
#if LANES == 16
        // Masked, with every bit: in the plain form, GCC 12 warns of an undefined value in its own header.
        const auto records = [&](uint lane) {
            return reinterpret_cast<Words>(
                _mm512_maskz_inserti64x4(0xFF, _mm512_castsi256_si512(record(lane)), record(lane + 4), 1));
        };
#else
        const auto records = [&](uint lane) { return reinterpret_cast<Words>(record(lane)); };
#endif
        half[i] = transposed(records(0), records(1), records(2), records(3));
    }
    Records result;
    for (uint i = 0; i < 4; ++i) {
        result.apex.of[i] = __builtin_shufflevector(half[0].of[i], half[1].of[i], EVEN_QUADS);
        result.exits.of[i] = __builtin_shufflevector(half[0].of[i], half[1].of[i], ODD_QUADS);
    }
    return result;
#endif
}

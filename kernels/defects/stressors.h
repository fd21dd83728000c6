// Stressors: kernels of forms in which compilers have been wrong for others. core/device/stressors.cpp has the
// answers, and names the public reports of each kind. The first 4,096 items have more rounds than the others, so that a
// launch of a million takes no longer than it must.

// 64-bit arithmetic by pairs of words, of which 16 are alive in a loop that loads.
STRUCT(Pair)
{
    uint low;
    uint high;
};

KERNEL_FN Pair pair_of(uint low, uint high)
{
    Pair made;
    made.low = low;
    made.high = high;
    return made;
}

KERNEL_FN Pair pair_sum(Pair a, Pair b)
{
    uint low = a.low + b.low;
    uint carry = low < a.low ? 1u : 0u;
    return pair_of(low, a.high + b.high + carry);
}

KERNEL_FN Pair pair_product(Pair a, uint factor)
{
    return pair_of(a.low * factor, high_product(a.low, factor) + a.high * factor);
}

// a ^ a >> 29
KERNEL_FN Pair pair_mixed(Pair a)
{
    return pair_of(a.low ^ ((a.low >> 29u) | (a.high << 3u)), a.high ^ (a.high >> 29u));
}

#define PAIR_STEP(a, b) a = pair_mixed(pair_sum(pair_product(a, factor), b));
#define PAIR_OF(number) pair_of(item*(2u * number + 1u), number)

KERNEL_FN uint pairs_under_pressure(DEFECT_WORDS uint item)
{
    Pair p0 = PAIR_OF(0u), p1 = PAIR_OF(1u), p2 = PAIR_OF(2u), p3 = PAIR_OF(3u);
    Pair p4 = PAIR_OF(4u), p5 = PAIR_OF(5u), p6 = PAIR_OF(6u), p7 = PAIR_OF(7u);
    Pair p8 = PAIR_OF(8u), p9 = PAIR_OF(9u), p10 = PAIR_OF(10u), p11 = PAIR_OF(11u);
    Pair p12 = PAIR_OF(12u), p13 = PAIR_OF(13u), p14 = PAIR_OF(14u), p15 = PAIR_OF(15u);
    uint rounds = item < 4096u ? 256u : 4u;
    for (uint round = 0u; round < rounds; round++) {
        uint factor = (WORD((round + item) & 63u) * 2654435760u) | 1u;
        PAIR_STEP(p0, p1)
        PAIR_STEP(p1, p2)
        PAIR_STEP(p2, p3)
        PAIR_STEP(p3, p4)
        PAIR_STEP(p4, p5)
        PAIR_STEP(p5, p6)
        PAIR_STEP(p6, p7)
        PAIR_STEP(p7, p8)
        PAIR_STEP(p8, p9)
        PAIR_STEP(p9, p10)
        PAIR_STEP(p10, p11)
        PAIR_STEP(p11, p12)
        PAIR_STEP(p12, p13)
        PAIR_STEP(p13, p14)
        PAIR_STEP(p14, p15)
        PAIR_STEP(p15, p0)
    }
    Pair all = pair_sum(pair_sum(pair_sum(p0, p1), pair_sum(p2, p3)), pair_sum(pair_sum(p4, p5), pair_sum(p6, p7)));
    all = pair_sum(all, pair_sum(pair_sum(p8, p9), pair_sum(p10, p11)));
    all = pair_sum(all, pair_sum(pair_sum(p12, p13), pair_sum(p14, p15)));
    return all.low ^ (all.high * 31u);
}

// A private array with a dynamic index, in a struct that a function receives by value and changes.
STRUCT(Places)
{
    uint place[16];
};

KERNEL_FN uint changed_in_copy(Places copy, uint a, uint b)
{
    copy.place[a] = copy.place[b] + 16u;
    copy.place[b] = 99u;
    return copy.place[(a + 1u) & 15u] * 7u + copy.place[a] * 3u + copy.place[b];
}

KERNEL_FN uint array_by_dynamic_index(DEFECT_WORDS uint item)
{
    Places own;
    for (uint i = 0u; i < 16u; i++)
        own.place[i] = i;
    uint sum = item * 2654435761u;
    uint rounds = item < 4096u ? 64u : 8u;
    for (uint round = 0u; round < rounds; round++) {
        uint a = (WORD((round + item) & 63u) + round) & 15u;
        uint b = (sum >> 3u) & 15u;
        sum = sum * 31u + changed_in_copy(own, a, b);
        uint kept = own.place[a];
        own.place[a] = own.place[b];
        own.place[b] = kept;
        sum += own.place[(a ^ b) & 15u];
    }
    for (uint i = 0u; i < 16u; i++)
        sum = sum * 31u + own.place[i];
    return sum;
}

// Ways out of loops, loops of one round, a dead branch on an opaque value, and a word of an array that is written by
// one index and read by another.
KERNEL_FN uint zoo_of_exits(DEFECT_WORDS uint item)
{
    uint sum = item * 2654435761u;
    uint ways[4];
    for (uint i = 0u; i < 4u; i++)
        ways[i] = 0u;
    uint rounds = item < 4096u ? 12u : 2u;
    for (uint outer = 0u; outer < rounds; outer++) {
        uint word = WORD((outer * 5u + item) & 63u);
        for (uint inner = 0u; inner < 8u; inner++) {
            switch ((word + inner) % 7u) {
            case 0u:
                sum += 3u;
                // falls through
            case 1u: sum *= 5u; break;
            case 2u: continue;
            case 3u:
                sum ^= word;
                // falls through
            default: sum += inner;
            }
            do {
                if ((sum & 3u) == 1u) break;
                sum += 7u;
                if ((sum & 4u) == 0u) continue;
                sum ^= 5u;
            } while (false);
            if (WORD(63u) != 63u) {
                sum = 0u;
                break;
            }
            ways[sum & 3u] = inner + 1u;
            sum += ways[(sum ^ 4u) & 3u] << 8u;
            if ((sum >> 8u & 63u) == 17u) return sum * 3u + outer;
            if ((sum >> 8u & 15u) == 9u) break;
        }
        if ((sum >> 8u & 127u) == 77u) return sum ^ 0x5A5A5A5Au;
    }
    return sum + ways[0];
}

// Loops that only data end: a chain through the words, a count that wraps, the steps of Collatz, one that never begins
// and would never end, and a bound check after them.
KERNEL_FN uint loops_that_data_end(DEFECT_WORDS uint item)
{
    uint at = item & 63u;
    uint end = (item * 7u + 5u) & 63u;
    uint steps = 0u;
    while (at != end) {
        at = (WORD(at) * 5u + 3u) & 63u;
        steps++;
    }
    uint last = WORD(item & 31u) * 8u;
    uint rounds = 0u;
    for (uint count = 4294967288u; count != last; count += 8u)
        rounds++;
    uint odd_steps = 0u;
    uint number = (item & (item < 4096u ? 1023u : 31u)) + 1u;
    while (number != 1u) {
        odd_steps += number & 1u;
        number = (number & 1u) == 0u ? number >> 1u : number * 3u + 1u;
    }
    while (WORD(63u) != 63u)
        rounds += 2u;
    uint place = steps + rounds;
    uint read = place < 64u ? WORD(place) : 1000u + place;
    while (place >= 64u)
        place -= WORD(21u);
    return ((WORD(place) * 64u + odd_steps) * 2048u + read) ^ (item * 2654435761u);
}

// The bits of a vector's four numbers. Real4, REAL4(a, b, c, d) and LANE(vector, x) to w are defined by the entry file:
// the language's own vector, or in CUDA, whose vectors lack operators, a struct with some.
#define HASH_LANES(hash, vector)                                                                                       \
    hash = hash * 31u + as_bits(LANE(vector, x));                                                                      \
    hash = hash * 31u + as_bits(LANE(vector, y));                                                                      \
    hash = hash * 31u + as_bits(LANE(vector, z));                                                                      \
    hash = hash * 31u + as_bits(LANE(vector, w));

// What a float sum loses (TwoSum, and Dekker's for |a| > |b|), in every spelling that a program may have.
KERNEL_FN real lost_in_sum(real a, real b)
{
    PRECISE real sum = a + b;
    PRECISE real b_part = sum - a;
    PRECISE real lost = (a - (sum - b_part)) + (b - b_part);
    return lost;
}

KERNEL_FN uint lost_in_sums(DEFECT_WORDS uint item)
{
    uint opaque = WORD(item & 63u);
    real a = to_real(8388608u + ((item * 2654435761u) >> 10u));
    real b = to_real(2u * ((item * 747796405u + opaque) & 2047u) + 1u) * real(2.44140625e-4f); // 2^-12
    PRECISE real sum = a + b;
    PRECISE real b_part = sum - a;
    PRECISE real a_part = sum - b_part;
    PRECISE real b_lost = b - b_part;
    PRECISE real a_lost = a - a_part;
    PRECISE real named = a_lost + b_lost;
    PRECISE real nested = (a - ((a + b) - ((a + b) - a))) + (b - ((a + b) - a));
    PRECISE real negated = -(((sum - b_part) - a) + (b_part - b));
    PRECISE real dekker = b - ((a + b) - a);
    bool swaps = (opaque & 1u) == 1u;
    real x = swaps ? b : a;
    real y = swaps ? a : b;
    PRECISE real selected = (x - ((x + y) - ((x + y) - x))) + (y - ((x + y) - x));
    uint hash = as_bits(sum);
    hash = hash * 31u + as_bits(named);
    hash = hash * 31u + as_bits(nested);
    hash = hash * 31u + as_bits(negated);
    hash = hash * 31u + as_bits(dekker);
    hash = hash * 31u + as_bits(selected);
    hash = hash * 31u + as_bits(lost_in_sum(a, b));
    Real4 first = REAL4(a, b, -a, -b);
    Real4 second = REAL4(b, a, -b, -a);
    PRECISE Real4 sums = first + second;
    PRECISE Real4 parts = sums - first;
    PRECISE Real4 lost_of_each = (first - (sums - parts)) + (second - parts);
    HASH_LANES(hash, lost_of_each)
    real firsts[4]; // of which a compiler may make a vector
    real seconds[4];
    for (uint i = 0u; i < 4u; i++) {
        real sign = i < 2u ? real(1.0f) : real(-1.0f);
        firsts[i] = sign * ((i & 1u) == 0u ? a : b);
        seconds[i] = sign * ((i & 1u) == 0u ? b : a);
    }
    for (uint i = 0u; i < 4u; i++) {
        PRECISE real both = firsts[i] + seconds[i];
        PRECISE real part = both - firsts[i];
        PRECISE real lost = (firsts[i] - (both - part)) + (seconds[i] - part);
        hash = hash * 31u + as_bits(lost);
    }
    return hash;
}

// What a float product loses (Dekker's TwoProd), likewise. Whatever fuses a product and a sum changes both zeros.
KERNEL_FN real lost_in_product(real a, real b)
{
    PRECISE real product = a * b;
    PRECISE real a_large = a * real(4097.0f);
    PRECISE real a_high = a_large - (a_large - a);
    PRECISE real a_low = a - a_high;
    PRECISE real b_large = b * real(4097.0f);
    PRECISE real b_high = b_large - (b_large - b);
    PRECISE real b_low = b - b_high;
    PRECISE real lost = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return lost;
}

KERNEL_FN uint lost_in_products(DEFECT_WORDS uint item)
{
    uint opaque = WORD(item & 63u);
    real a = to_real(8388609u + 2u * ((item * 2654435761u) >> 10u));
    real b = to_real(8388609u + 2u * ((item * 747796405u + opaque * 65536u) & 4194303u));
    PRECISE real product = a * b;
    PRECISE real a_high = a * real(4097.0f) - (a * real(4097.0f) - a);
    PRECISE real b_high = b * real(4097.0f) - (b * real(4097.0f) - b);
    PRECISE real nested =
        ((a_high * b_high - a * b) + a_high * (b - b_high) + (a - a_high) * b_high) + (a - a_high) * (b - b_high);
    PRECISE real negated =
        -(((a * b - a_high * b_high) - a_high * (b - b_high) - (a - a_high) * b_high) + (a_high - a) * (b - b_high));
    real other_a = as_real(as_bits(a) ^ WORD(0u)); // it is a, but a compiler cannot know that
    PRECISE real zero = other_a * b - product;
    PRECISE real other_zero = product - b * other_a;
    bool swaps = (opaque & 1u) == 1u;
    uint hash = as_bits(product);
    hash = hash * 31u + as_bits(nested);
    hash = hash * 31u + as_bits(negated);
    hash = hash * 31u + as_bits(zero) + as_bits(other_zero);
    hash = hash * 31u + as_bits(lost_in_product(a, b));
    hash = hash * 31u + as_bits(lost_in_product(swaps ? b : a, swaps ? a : b));
    Real4 factor = REAL4(a, b, -a, -b);
    Real4 other = REAL4(b, a, b, a);
    Real4 split = REAL4(real(4097.0f), real(4097.0f), real(4097.0f), real(4097.0f));
    PRECISE Real4 products = factor * other;
    PRECISE Real4 large = factor * split;
    PRECISE Real4 high = large - (large - factor);
    PRECISE Real4 low = factor - high;
    PRECISE Real4 other_large = other * split;
    PRECISE Real4 other_high = other_large - (other_large - other);
    PRECISE Real4 other_low = other - other_high;
    PRECISE Real4 lost_of_each =
        ((high * other_high - products) + high * other_low + low * other_high) + low * other_low;
    HASH_LANES(hash, lost_of_each)
    real factors[4]; // of which a compiler may make a vector
    for (uint i = 0u; i < 4u; i++)
        factors[i] = i < 2u ? a : -a;
    for (uint i = 0u; i < 4u; i++)
        hash = hash * 31u + as_bits(lost_in_product(factors[i], b));
    return hash;
}

// Denormals, each operation in a kernel of its own. 23 bits are below the smallest normal number.
KERNEL_FN uint denormal_bits(uint item)
{
    return ((item * 2654435761u) >> 10u) + 1u;
}

KERNEL_FN uint denormals_copied(DEFECT_WORDS uint item)
{
    real kept[4];
    for (uint i = 0u; i < 4u; i++)
        kept[i] = as_real(denormal_bits(item) + WORD(i));
    return as_bits(kept[item & 3u]);
}

KERNEL_FN uint denormals_selected(DEFECT_WORDS uint item)
{
    real positive = as_real(denormal_bits(item) + WORD(1u));
    real negative = as_real(0x80000000u | denormal_bits(item));
    real chosen = WORD(item & 63u) % 3u == 0u ? positive : negative;
    return as_bits(chosen);
}

KERNEL_FN uint denormals_in_minima(DEFECT_WORDS uint item)
{
    return as_bits(minimum(as_real(denormal_bits(item) + WORD(1u)), as_real(denormal_bits(item))));
}

KERNEL_FN uint denormals_in_maxima(DEFECT_WORDS uint item)
{
    return as_bits(maximum(as_real(denormal_bits(item) + WORD(1u)), as_real(denormal_bits(item))));
}

KERNEL_FN uint denormals_multiplied(DEFECT_WORDS uint item)
{
    PRECISE real doubled = as_real(denormal_bits(item) + WORD(1u)) * real(2.0f);
    PRECISE real normal = as_real(denormal_bits(item)) * real(16777216.0f);
    return as_bits(doubled) * 31u + as_bits(normal);
}

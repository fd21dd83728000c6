// Numbers of 352 bits in memory, for exact_order.h, which says what each statement does. Each is a loop that is kept:
// an array indexed by one stays in memory, so that a GPU that needs this for few rays keeps its registers for all
// (results/registers.md). They are statements, since a function of this language copies the arrays that it gets.
#define WIDE_WORDS 11u
#define SLOT_0 0u // glslang cannot make these of a number: it does not paste a suffix
#define SLOT_1 11u
#define SLOT_2 22u
#define SLOT_3 33u
#define SLOT_4 44u
#define SLOT_5 55u
#define SLOT_6 66u
#define SLOT(number) SLOT_##number
#define WIDE_SLOTS uint wide[77u];

#define COPY_WIDE(to, from)                                                                                            \
    KEEP_LOOP                                                                                                          \
    for (uint word = 0u; word < WIDE_WORDS; ++word)                                                                    \
        wide[SLOT(to) + word] = wide[SLOT(from) + word];

#define SET_WIDE(to, fixed)                                                                                            \
    {                                                                                                                  \
        Fixed value = fixed;                                                                                           \
        uint sign = is_negative(value) ? ~0u : 0u;                                                                     \
        KEEP_LOOP                                                                                                      \
        for (uint word = 0u; word < WIDE_WORDS; ++word)                                                                \
            wide[SLOT(to) + word] = word == 0u ? value.low : word == 1u ? value.high : sign;                           \
    }

#define NEGATE_WIDE(at)                                                                                                \
    {                                                                                                                  \
        uint carry = 1u;                                                                                               \
        KEEP_LOOP                                                                                                      \
        for (uint word = 0u; word < WIDE_WORDS; ++word) {                                                              \
            uint negated = ~wide[SLOT(at) + word] + carry;                                                             \
            wide[SLOT(at) + word] = negated;                                                                           \
            carry = negated < carry ? 1u : 0u;                                                                         \
        }                                                                                                              \
    }

#define UP_A_WORD(at)                                                                                                  \
    KEEP_LOOP                                                                                                          \
    for (uint word = WIDE_WORDS - 1u; word > 0u; --word)                                                               \
        wide[SLOT(at) + word] = wide[SLOT(at) + word - 1u];                                                            \
    wide[SLOT(at)] = 0u;

// Slot `to` grows, or shrinks if `shrinks`, by slot `from` times 2^(32 up) times a word.
#define ADD_SHIFTED_PRODUCT(to, from, up, factor, shrinks)                                                             \
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

#define ADD_PRODUCT(to, from, factor) ADD_SHIFTED_PRODUCT(to, from, 0u, factor, false)

#define ADD_FIXED_PRODUCT(to, from, factor)                                                                            \
    {                                                                                                                  \
        Fixed signed_factor = factor;                                                                                  \
        bool is_minus = is_negative(signed_factor);                                                                    \
        Fixed size = is_minus ? negated_fixed(signed_factor) : signed_factor;                                          \
        KEEP_LOOP                                                                                                      \
        for (uint up = 0u; up < 2u; ++up)                                                                              \
            ADD_SHIFTED_PRODUCT(to, from, up, up == 0u ? size.low : size.high, is_minus)                               \
    }

#define LOW_WORD(at, word) wide[SLOT(at) + (word)]
#define IS_NEGATIVE_WIDE(at) (wide[SLOT(at) + WIDE_WORDS - 1u] >> 31u != 0u)
#define IS_ZERO_WIDE(at)                                                                                               \
    ((wide[SLOT(at)] | wide[SLOT(at) + 1u] | wide[SLOT(at) + 2u] | wide[SLOT(at) + 3u] | wide[SLOT(at) + 4u] |         \
      wide[SLOT(at) + 5u] | wide[SLOT(at) + 6u] | wide[SLOT(at) + 7u] | wide[SLOT(at) + 8u] | wide[SLOT(at) + 9u] |    \
      wide[SLOT(at) + 10u]) == 0u)

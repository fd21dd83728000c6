// Numbers of 352 bits in variables, for exact_order.h, which says what each statement does: for drivers that end
// loops early, as lavapipe 22.3 does: those of wide_in_memory.h use up an invocation's iterations. A GPU needs twice
// the registers for it.
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
    if (is_negative(factor)) {
        multiplied = negated_wide(a);
        size = negated_fixed(factor);
    }
    return plus_product(plus_product(sum, up_a_word(multiplied), size.high), multiplied, size.low);
}

// Word 0 to 4.
KERNEL_FN uint low_word(Wide a, uint word)
{
    uint even = word == 0u ? a.w0 : word == 2u ? a.w2 : a.w4;
    return word == 1u ? a.w1 : word == 3u ? a.w3 : even;
}

#define WIDE_SLOTS                                                                                                     \
    Wide wide0;                                                                                                        \
    Wide wide1;                                                                                                        \
    Wide wide2;                                                                                                        \
    Wide wide3;                                                                                                        \
    Wide wide4;                                                                                                        \
    Wide wide5;                                                                                                        \
    Wide wide6;
#define COPY_WIDE(to, from) wide##to = wide##from;
#define SET_WIDE(to, fixed) wide##to = wide_of(fixed);
#define NEGATE_WIDE(at) wide##at = negated_wide(wide##at);
#define UP_A_WORD(at) wide##at = up_a_word(wide##at);
#define ADD_PRODUCT(to, from, factor) wide##to = plus_product(wide##to, wide##from, factor);
#define ADD_FIXED_PRODUCT(to, from, factor) wide##to = plus_signed_product(wide##to, wide##from, factor);
#define LOW_WORD(at, word) low_word(wide##at, word)
#define IS_NEGATIVE_WIDE(at) (wide##at.w10 >> 31u != 0u)
#define IS_ZERO_WIDE(at) is_zero(wide##at)

// The kernels' language as OpenCL C 1.2; include it before kernel.h or probe.h.
// Compiler options make math mode fast contract and approximate; exact is set here and by options. CALLS_FUNCTIONS,
// from outside: for a device that must not inline functions. By default PoCL does not inline large functions, which
// halves the speed. STACK_TOP and GROUP_ITEMS, from outside: see kernels/stack.h.
#ifndef MATH_FAST
#pragma OPENCL FP_CONTRACT OFF
#endif
#include "kernels/layouts/layout.h"

#ifdef CALLS_FUNCTIONS
#define KERNEL_FN static inline
#else
#define KERNEL_FN static inline __attribute__((always_inline))
#endif
#define RARE_FN KERNEL_FN
#ifdef PREDICTS_BRANCHES // from outside: for a processor. A compiler makes no select of a branch with such a statement.
#define KEEP_BRANCH __asm__ volatile("")
#endif
#define MAYBE_UNUSED __attribute__((unused))
#define KEEP_LOOP _Pragma("unroll 1")
#define PRECISE // contraction is switched off for the whole program
#define STRUCT(name)                                                                                                   \
    typedef struct name name;                                                                                          \
    struct name
#define VEC3(x, y, z) ((Vec3){(x), (y), (z)})
// An item's words are GROUP_ITEMS apart, so that its neighbours' are in other banks. Only a kernel can declare them.
#define GROUP_WORDS(count)
#define GROUP_WORD(scene, index) ((scene).group_words[(index)*GROUP_ITEMS + get_local_id(0)])
typedef float real;
#define real(value) ((real)(value)) // replaced only if a parenthesis follows
#define HAS_FLOAT4                  // four floats as one value, with operators

KERNEL_FN real as_real(uint bits)
{
    return as_float(bits);
}
KERNEL_FN uint as_bits(real value)
{
    return as_uint(value);
}
KERNEL_FN real magnitude(real value)
{
    return fabs(value);
}
KERNEL_FN real to_real(uint value)
{
    return (real)value;
}
// Rounded down. value: not negative.
KERNEL_FN uint to_uint(real value)
{
    return (uint)value;
}
KERNEL_FN real square_root(real value)
{
    return sqrt(value);
}
// a * b + c, rounded once or twice: only for what decides nothing, such as the boxes of BVHs (docs/spec/bvhs.md, B7).
KERNEL_FN real multiply_add(real a, real b, real c)
{
    return mad(a, b, c);
}
KERNEL_FN real minimum(real a, real b)
{
    return min(a, b); // fmin handles NaN, which takes several instructions on processors
}
KERNEL_FN real maximum(real a, real b)
{
    return max(a, b);
}
KERNEL_FN uint highest_bit(uint value)
{
    return 31u - clz(value);
}
KERNEL_FN uint bit_count(uint value)
{
    return popcount(value);
}
// The high word of the product of two words.
KERNEL_FN uint high_product(uint a, uint b)
{
    return mul_hi(a, b);
}

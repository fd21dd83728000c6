// The kernels' language as GLSL 4.50 for Vulkan; include it before kernel.h or probe.h.
// Macros from outside: MATH_FAST where the compiler may contract; SELECTS_MINIMA, an expression, true where comparing
// and selecting is faster than the built-in minimum (the two differ only for NaNs, which never occur); STACK_TOP, a
// constant, GROUP_ITEMS, the invocations of a work group, and STACK_ENTRIES: see kernels/stack.h.
#include "kernels/layouts/layout.h"

#ifndef SELECTS_MINIMA
#define SELECTS_MINIMA false
#endif
#define KERNEL_FN
#define RARE_FN
#define MAYBE_UNUSED
#ifdef SCENE_IN_TEXELS    // emulated devices, of which some end an invocation's loops after 65,535 iterations
#define WIDE_IN_REGISTERS // kernels/bvh/wide_in_registers.h
#endif
#ifdef WIDE_IN_REGISTERS
#define KEEP_LOOP
#else
#define KEEP_LOOP [[dont_unroll]]
#endif
#define STRUCT(name) struct name
#define VEC3(x, y, z) Vec3(x, y, z)
// An item's words are GROUP_ITEMS apart, so that its neighbours' are in other banks. An array has one word at least.
#define GROUP_WORDS(count) shared uint group_words[(count) == 0u ? 1u : (count)*GROUP_ITEMS];
#define GROUP_WORD(scene, index) group_words[(index)*GROUP_ITEMS + gl_LocalInvocationIndex]
#define real float
#define uint4 uvec4
#ifdef MATH_FAST
#define PRECISE
#else
#define PRECISE precise // works on locals only: on parameters or a result it does not reach into the function
#endif

KERNEL_FN real as_real(uint bits)
{
    return uintBitsToFloat(bits);
}
KERNEL_FN uint as_bits(real value)
{
    return floatBitsToUint(value);
}
KERNEL_FN real magnitude(real value)
{
    return abs(value);
}
KERNEL_FN real to_real(uint value)
{
    return real(value);
}
// Rounded down. value: not negative.
KERNEL_FN uint to_uint(real value)
{
    return uint(value);
}
KERNEL_FN real square_root(real value)
{
    return sqrt(value);
}
// a * b + c, rounded once or twice: only for what decides nothing, such as the boxes of BVHs (docs/spec/bvhs.md, B7).
KERNEL_FN real multiply_add(real a, real b, real c)
{
    return a * b + c;
}
KERNEL_FN real minimum(real a, real b)
{
    return SELECTS_MINIMA ? (a < b ? a : b) : min(a, b);
}
KERNEL_FN real maximum(real a, real b)
{
    return SELECTS_MINIMA ? (a > b ? a : b) : max(a, b);
}
KERNEL_FN uint highest_bit(uint value)
{
    return uint(findMSB(value));
}
KERNEL_FN uint bit_count(uint value)
{
    return uint(bitCount(value));
}
// The high word of the product of two words.
KERNEL_FN uint high_product(uint a, uint b)
{
    uint high;
    uint low;
    umulExtended(a, b, high, low);
    return high;
}

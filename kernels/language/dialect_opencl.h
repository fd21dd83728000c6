// The kernels' language as OpenCL C 1.2; include it before kernel.h or probe.h.
// Math mode fast contracts and approximates by the compiler's options; exact says so here and by its options.
// CALLS_FUNCTIONS, from outside: for a device that must not inline them. PoCL leaves large ones as calls by itself, at
// half the speed.
#ifndef MATH_FAST
#pragma OPENCL FP_CONTRACT OFF
#endif
#include "kernels/layouts/layout.h"

#ifdef CALLS_FUNCTIONS
#define KERNEL_FN static inline
#else
#define KERNEL_FN static inline __attribute__((always_inline))
#endif
#define PRECISE // contraction is switched off for the whole program
#define STRUCT(name)                                                                                                   \
    typedef struct name name;                                                                                          \
    struct name
#define VEC3(x, y, z) ((Vec3){(x), (y), (z)})
typedef float real;
#define real(value) ((real)(value)) // only where a parenthesis follows

KERNEL_FN real as_real(uint bits)
{
    return as_float(bits);
}
KERNEL_FN uint as_bits(real value)
{
    return as_uint(value);
}
KERNEL_FN real to_real(uint value)
{
    return (real)value;
}
KERNEL_FN real square_root(real value)
{
    return sqrt(value);
}
KERNEL_FN real minimum(real a, real b)
{
    return min(a, b); // fmin cares for NaN, which costs processors several instructions
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

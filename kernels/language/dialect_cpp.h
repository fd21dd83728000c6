// language/: what each language needs to read the kernels: dialects, views of a scene, vectors.

// The kernels' language as host C++. Include it, and the kernel headers after it, inside an unnamed namespace: every
// kernel is compiled once per layout and math mode, and their names must not collide.
// Include <bit>, <cassert>, <cstddef>, <cstdint>, <cmath> and core/device/backend.h before it.
#define KERNEL_FN [[maybe_unused, gnu::always_inline]] inline
// What few rays need is a call, so that all others have the registers.
#define RARE_FN [[maybe_unused, gnu::noinline, gnu::cold]] inline
#define MAYBE_UNUSED [[maybe_unused]] // before a parameter that some layouts do not need
#define PRECISE                       // contraction is switched off by the compiler's flags
#define KEEP_BRANCH asm volatile("")  // a compiler makes no select of a branch with such a statement
#define KEEP_LOOP                     // before a loop that a GPU should not unroll
#define STRUCT(name) struct name
#define VEC3(x, y, z) (Vec3{(x), (y), (z)})
#define FETCH(scene, array, index) (assert((index) < (scene).array##_size()), (scene).array()[(index)])

using uint = std::uint32_t;
using uint4 = tetrace::Quad;
#ifndef KERNEL_REAL // the test that counts operations defines its own number type
#define KERNEL_REAL float
#endif
using real = KERNEL_REAL;

KERNEL_FN real as_real(uint bits)
{
    return real(std::bit_cast<float>(bits));
}
#ifdef KERNEL_REAL_HAS_NO_BITS
KERNEL_FN real magnitude(real value)
{
    return value < real(0.0f) ? -value : value;
}
#else
KERNEL_FN real magnitude(real value)
{
    return std::fabs(value);
}
KERNEL_FN uint as_bits(real value)
{
    return std::bit_cast<uint>(value);
}
KERNEL_FN real square_root(real value)
{
    return std::sqrt(value);
}
#endif
KERNEL_FN real to_real(uint value)
{
    return real(static_cast<float>(value));
}
// Rounded down. value: not negative.
KERNEL_FN uint to_uint(real value)
{
    return static_cast<uint>(value);
}

// a * b + c, rounded once or twice: only for what decides nothing, such as the boxes of BVHs (docs/spec/bvhs.md, B7).
KERNEL_FN real multiply_add(real a, real b, real c)
{
    return a * b + c;
}
// Operands are never NaN.
KERNEL_FN real minimum(real a, real b)
{
    return a < b ? a : b;
}
KERNEL_FN real maximum(real a, real b)
{
    return a > b ? a : b;
}
// Index of the highest set bit. value: not 0.
KERNEL_FN uint highest_bit(uint value)
{
    return 31u - static_cast<uint>(std::countl_zero(value));
}
KERNEL_FN uint bit_count(uint value)
{
    return static_cast<uint>(std::popcount(value));
}
// The high word of the product of two words.
KERNEL_FN uint high_product(uint a, uint b)
{
    return static_cast<uint>(std::uint64_t{a} * b >> 32u);
}

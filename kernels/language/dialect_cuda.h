// The kernels' language as CUDA C++, for nvcc and for NVRTC. NVRTC lacks headers, so nothing is included here. Compiler
// options set contraction, division and square root (backends/cuda/CMakeLists.txt).
#define KERNEL_FN [[maybe_unused]] static __device__ inline
// A call here would cost all rays more registers than the code itself.
#define RARE_FN KERNEL_FN
#define MAYBE_UNUSED [[maybe_unused]]
#ifndef KEEP_LOOP // the host's emulation has none
#define KEEP_LOOP _Pragma("unroll 1")
#endif
#define PRECISE // contraction is switched off by the compiler's flags
#define STRUCT(name) struct name
#define VEC3(x, y, z) (Vec3{(x), (y), (z)})

// The lanes of a warp see each other's votes.
#define LANES_VOTE

typedef unsigned int uint;
typedef float real;

// The top of a ray's stack (kernels/stack.h). A launch says how much memory its blocks have. A thread's words are a
// block apart, so that its neighbours' are in other banks.
#define STACK_TOP STACK_TOP_OF_GPUS
#define GROUP_WORDS(count) extern __shared__ uint group_words[];
#define GROUP_WORD(scene, index) group_words[(index)*blockDim.x + threadIdx.x]

KERNEL_FN real as_real(uint bits)
{
    return __uint_as_float(bits);
}
KERNEL_FN uint as_bits(real value)
{
    return __float_as_uint(value);
}
KERNEL_FN real square_root(real value)
{
    return sqrtf(value);
}
KERNEL_FN real magnitude(real value)
{
    return fabsf(value);
}
KERNEL_FN real to_real(uint value)
{
    return __uint2float_rn(value);
}
// Rounded down. value: not negative.
KERNEL_FN uint to_uint(real value)
{
    return static_cast<uint>(value);
}
// a * b + c, rounded once or twice: only for what decides nothing, such as the boxes of BVHs (docs/spec/bvhs.md, B7).
KERNEL_FN real multiply_add(real a, real b, real c)
{
    return __fmaf_rn(a, b, c);
}
KERNEL_FN real minimum(real a, real b)
{
    return fminf(a, b);
}
KERNEL_FN real maximum(real a, real b)
{
    return fmaxf(a, b);
}
KERNEL_FN uint highest_bit(uint value)
{
    return 31u - static_cast<uint>(__clz(static_cast<int>(value)));
}
KERNEL_FN uint bit_count(uint value)
{
    return static_cast<uint>(__popc(value));
}
// The high word of the product of two words.
KERNEL_FN uint high_product(uint a, uint b)
{
    return __umulhi(a, b);
}

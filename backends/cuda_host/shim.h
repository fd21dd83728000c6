#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <bit>

// The parts of CUDA C++ that backends/cuda/*.cu use, for a host compiler; include it before them. The threads of a
// block run one after the other, and a warp is one thread.

#define __device__
#define __global__
#define __shared__ thread_local
#define __restrict__ __restrict
#define KEEP_LOOP

/// CUDA's vectors, which a device loads or stores at once.
struct alignas(8) uint2 {
    std::uint32_t x, y;
};
struct alignas(16) uint4 {
    std::uint32_t x, y, z, w;
};

inline uint2 make_uint2(std::uint32_t x, std::uint32_t y)
{
    return {x, y};
}

namespace tetrace::cuda_host {

/// CUDA's dim3.
struct Dimensions {
    std::uint32_t x = 1, y = 1, z = 1;
};

// constinit: no wrapper function checks whether they are initialised. Hidden: a shared object of a kernel has its own.
[[gnu::visibility("hidden")]] inline constinit thread_local Dimensions current_thread, current_block, block_size;

constexpr std::uint32_t warp_size = 1;
constexpr std::uint32_t max_block_threads = 1024;

// Operands are never NaN. A device has an instruction for this; the host's library would make a call, to handle NaN.
inline float lesser(float a, float b)
{
    return a < b ? a : b;
}
inline float greater(float a, float b)
{
    return a > b ? a : b;
}

} // namespace tetrace::cuda_host

// CUDA's built-in variables. They are macros because a thread's own variables cannot have another name.
#define threadIdx (::tetrace::cuda_host::current_thread)
#define blockIdx (::tetrace::cuda_host::current_block)
#define blockDim (::tetrace::cuda_host::block_size)
#define warpSize (::tetrace::cuda_host::warp_size)
#define fminf(a, b) (::tetrace::cuda_host::lesser((a), (b)))
#define fmaxf(a, b) (::tetrace::cuda_host::greater((a), (b)))

template <class Element>
Element __ldg(const Element* element)
{
    return *element;
}

inline float __uint_as_float(std::uint32_t bits)
{
    return std::bit_cast<float>(bits);
}

inline std::uint32_t __float_as_uint(float value)
{
    return std::bit_cast<std::uint32_t>(value);
}

inline float __fmaf_rn(float a, float b, float c)
{
    return a * b + c; // rounded twice: on CPUs without the instruction, a call would cost more than it gains
}

inline float __uint2float_rn(std::uint32_t value)
{
    return static_cast<float>(value);
}

inline int __clz(int value)
{
    return std::countl_zero(static_cast<std::uint32_t>(value));
}

inline std::uint32_t __umulhi(std::uint32_t a, std::uint32_t b)
{
    return static_cast<std::uint32_t>(std::uint64_t{a} * b >> 32);
}

inline int __popc(std::uint32_t value)
{
    return std::popcount(value);
}

inline std::uint32_t atomicAdd(std::uint32_t* word, std::uint32_t added)
{
    return std::atomic_ref(*word).fetch_add(added, std::memory_order_relaxed);
}

inline std::uint32_t __shfl_sync(std::uint32_t, std::uint32_t value, int)
{
    return value;
}

inline std::uint32_t __ballot_sync(std::uint32_t, bool vote)
{
    return vote ? 1 : 0;
}

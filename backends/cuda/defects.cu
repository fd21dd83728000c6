// The reduced kernels (kernels/defects/defects.h), an entry for each, run_<name>; one item per thread.
#include "kernels/layouts/defect_words.h"
#include "kernels/layouts/layout.h"

#include "kernels/language/dialect_cuda.h"

struct Real4 {
    real x, y, z, w;
};
#define REAL4(a, b, c, d) (Real4{(a), (b), (c), (d)})
#define LANE(vector, name) (vector).name
KERNEL_FN Real4 operator+(Real4 a, Real4 b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
KERNEL_FN Real4 operator-(Real4 a, Real4 b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w};
}
KERNEL_FN Real4 operator*(Real4 a, Real4 b)
{
    return {a.x * b.x, a.y * b.y, a.z * b.z, a.w * b.w};
}

#define DEFECT_WORDS const uint *words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/defects/defects.h"

#define GROUP_FN(name)                                                                                                 \
    KERNEL_FN void name([[maybe_unused]] const uint* words, uint* results, [[maybe_unused]] uint* local_words,         \
                        uint item_count)
#ifndef EACH_ITEM // the host's emulation has its own
#define EACH_ITEM
#define PAUSE
#endif
#define BARRIER __syncthreads();
#define FENCE __threadfence();
#define LOCAL threadIdx.x
#define GROUP_SIZE blockDim.x
#define ITEM (blockIdx.x * blockDim.x + threadIdx.x)
#define ITEM_COUNT item_count
#define RESULT(index) results[index]
#define ADD(index, added) atomicAdd(&results[index], added)
#define LOCAL_WORD(index) local_words[index]
#define LOCAL_ADD(index, added) atomicAdd(&local_words[index], added)
#include "kernels/defects/group_stressors.h"

typedef uint Lanes;
KERNEL_FN uint own_lane()
{
    return threadIdx.x % warpSize; // blocks have one dimension
}
#define lanes_here() __activemask()
#define votes(here, vote) __ballot_sync(here, vote)
#define has_lane(set) (((set) >> own_lane() & 1u) != 0u)
#define lane_count(set) bit_count(set)
#define lane_rank(set) bit_count((set) & ((1u << own_lane()) - 1u))
#define from_first(here, value) __shfl_sync(here, value, static_cast<int>(31u - highest_bit((here) & (0u - (here)))))
#define have_common_lane(a, b) (((a) & (b)) != 0u)
#include "kernels/defects/lane_stressors.h"

#define FAR_FN(name)                                                                                                   \
    KERNEL_FN void name([[maybe_unused]] const uint* words, uint* results, uint* large, uint item_count)
#define FAR(index) large[index]
#define FAR_END words[FAR_END_WORD]
#include "kernels/defects/far_stressors.h"

#define DEFECT(name)                                                                                                   \
    extern "C" __global__ void run_##name(const uint* words, uint* results, uint count)                                \
    {                                                                                                                  \
        uint index = blockIdx.x * blockDim.x + threadIdx.x;                                                            \
        if (index >= count) return;                                                                                    \
        results[index] = name(words, index);                                                                           \
    }
#define GROUP_DEFECT(name)                                                                                             \
    extern "C" __global__ void run_##name(const uint* words, uint* results, uint count)                                \
    {                                                                                                                  \
        __shared__ uint local_words[LOCAL_WORDS];                                                                      \
        name(words, results, local_words, count);                                                                      \
    }
#define LANE_DEFECT GROUP_DEFECT
#define FAR_DEFECT(name)                                                                                               \
    extern "C" __global__ void run_##name(const uint* words, uint* results, uint count, uint* large)                   \
    {                                                                                                                  \
        name(words, results, large, count);                                                                            \
    }
#include "kernels/defects/defect_list.inc"

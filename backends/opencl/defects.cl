// A reduced kernel as an OpenCL program. From outside: DEFECT, its name, or GROUP_DEFECT, that of a kernel whose items
// share memory; LANES if it has subgroups, LARGE if it has a large buffer.
#include "kernels/language/dialect_opencl.h"

#define Real4 float4
#define REAL4(a, b, c, d) ((float4)(a, b, c, d))
#define LANE(vector, name) (vector).name
#define DEFECT_WORDS __global const uint *restrict words,
#define DEFECT_PASSED words,
#define WORD(index) words[index]
#include "kernels/layouts/defect_words.h"
#ifdef GROUP_DEFECT
#if __OPENCL_C_VERSION__ >= 200
#define FENCE                                                                                                          \
    atomic_work_item_fence(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE, memory_order_acq_rel, memory_scope_device);
#else
#define FENCE
#endif
#define GROUP_FN(name)                                                                                                 \
    KERNEL_FN void name(__global const uint* restrict words, __global uint* results, __local uint* local_words,        \
                        uint item_count)
#define EACH_ITEM
#define BARRIER barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
#define PAUSE
#define LOCAL ((uint)get_local_id(0))
#define GROUP_SIZE ((uint)get_local_size(0))
#define ITEM ((uint)get_global_id(0))
#define ITEM_COUNT item_count
#define RESULT(index) results[index]
#define ADD(index, added) atomic_add(&results[index], added)
#define LOCAL_WORD(index) local_words[index]
#define LOCAL_ADD(index, added) atomic_add(&local_words[index], added)
#include "kernels/defects/group_stressors.h"
#ifdef LANES
#define Lanes uint4
#define lanes_here() sub_group_ballot(1)
#define votes(here, vote) sub_group_ballot(vote)
#define has_lane(set) (sub_group_ballot_bit_extract(set, get_sub_group_local_id()) != 0)
#define lane_count(set) sub_group_ballot_bit_count(set)
#define lane_rank(set) sub_group_ballot_exclusive_scan(set)
#define from_first(here, value) sub_group_broadcast_first(value)
#define have_common_lane(a, b) (any(((a) & (b)) != 0u) != 0)
#include "kernels/defects/lane_stressors.h"
#endif
#ifdef LARGE
#define FAR_FN(name)                                                                                                   \
    KERNEL_FN void name(__global const uint* restrict words, __global uint* results, __global uint* large,             \
                        uint item_count)
#define FAR(index) large[index]
#define FAR_END words[FAR_END_WORD]
#include "kernels/defects/far_stressors.h"

__kernel void run_defect(__global const uint* restrict words, __global uint* results, uint count, __global uint* large)
{
    GROUP_DEFECT(words, results, large, count);
}
#else

__kernel void run_defect(__global const uint* restrict words, __global uint* results, uint count)
{
    __local uint local_words[LOCAL_WORDS];
    GROUP_DEFECT(words, results, local_words, count);
}
#endif
#else
#include "kernels/defects/defects.h"

__kernel void run_defect(__global const uint* restrict words, __global uint* results, uint count)
{
    uint item = (uint)get_global_id(0);
    if (item >= count) return;
    results[item] = DEFECT(words, item);
}
#endif

#version 450
// A reduced kernel as a compute shader. DEFECT is its name, or GROUP_DEFECT, that of a kernel whose items share memory;
// LANES if it has subgroups, LARGE if it has a large buffer. Compiled by glslangValidator -V --target-env vulkan1.1
// -DDEFECT=<name>.
#ifdef LANES
#extension GL_KHR_shader_subgroup_ballot : require
#endif
#include "kernels/language/dialect_glsl.h"

layout(local_size_x = 16, local_size_x_id = 0) in;
layout(std430, set = 0, binding = 0) readonly buffer Words
{
    uint words[];
};

#define Real4 vec4
#define REAL4(a, b, c, d) vec4(a, b, c, d)
#define LANE(vector, name) (vector).name
#define DEFECT_WORDS
#define DEFECT_PASSED
#define WORD(index) words[index]
#include "kernels/layouts/defect_words.h"
#ifdef GROUP_DEFECT
layout(std430, set = 0, binding = 1) coherent buffer Results
{
    uint results[];
};
shared uint local_words[LOCAL_WORDS];
#define GROUP_FN(name) void name()
#define EACH_ITEM
#define BARRIER                                                                                                        \
    memoryBarrierShared();                                                                                             \
    memoryBarrierBuffer();                                                                                             \
    barrier();
#define FENCE memoryBarrierBuffer();
#define PAUSE
#define LOCAL gl_LocalInvocationIndex
#define GROUP_SIZE gl_WorkGroupSize.x
#define ITEM gl_GlobalInvocationID.x
#define ITEM_COUNT words[DEFECT_WORD_COUNT]
#define RESULT(index) results[index]
#define ADD(index, added) atomicAdd(results[index], added)
#define LOCAL_WORD(index) local_words[index]
#define LOCAL_ADD(index, added) atomicAdd(local_words[index], added)
#include "kernels/defects/group_stressors.h"
#ifdef LANES
#define Lanes uvec4
#define lanes_here() subgroupBallot(true)
#define votes(here, vote) subgroupBallot(vote)
#define has_lane(set) subgroupBallotBitExtract(set, gl_SubgroupInvocationID)
#define lane_count(set) subgroupBallotBitCount(set)
#define lane_rank(set) subgroupBallotExclusiveBitCount(set)
#define from_first(here, value) subgroupBroadcastFirst(value)
#define have_common_lane(a, b) (((a) & (b)) != uvec4(0u))
#include "kernels/defects/lane_stressors.h"
#endif
#ifdef LARGE
layout(std430, set = 0, binding = 2) coherent buffer Large
{
    uint large[];
};
#define FAR_FN(name) void name()
#define FAR(index) large[index]
#define FAR_END words[FAR_END_WORD]
#include "kernels/defects/far_stressors.h"
#endif

void main()
{
    GROUP_DEFECT();
}
#else
layout(std430, set = 0, binding = 1) writeonly buffer Results
{
    uint results[];
};
#include "kernels/defects/defects.h"

void main()
{
    uint item = gl_GlobalInvocationID.x;
    if (item >= uint(results.length())) return;
    results[item] = DEFECT(item);
}
#endif

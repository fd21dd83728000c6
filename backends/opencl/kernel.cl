// A kernel as an OpenCL program (CMakeLists.txt): a thin entry around the shared text. Build options (session.cpp):
// GROUP_ITEMS, the items of a work group, which traces one tile at a time; PERSISTENT for that schedule; RAYS, SEARCH,
// SEGMENTS, TALLY and ABSORB for those tasks; STARTS_OUTSIDE if no ray of an image begins in a tet; MATH_FAST; TETS_IN_PARTS;
// STACK_TOP, where stacks begin in local memory.
#include "kernels/language/dialect_opencl.h"

#include "kernels/language/vector.h"

#include "kernels/language/scene_view_opencl.h"

#ifdef TALLY
#define LENGTH_SUMS __global uint*
#define HAS_SUMS(sums) true
#define ADD_TO_SUM(sums, word, added) atomic_add((sums) + (word), added)
#endif

#include "kernels/kernel.h"

// rays: that are given.
KERNEL_FN void run_item(SceneView scene, LaunchParams launch, uint tile, __global uint* output,
                        __global const uint4* rays)
{
    Pixel pixel = pixel_of(launch, tile, (uint)get_local_id(0));
    if (!is_in_image(launch, pixel)) return;
#ifdef SEARCH
    uint ray = ray_index(pixel);
    uint count = ray_count(launch);
    output[GUARD_WORDS + ray] = search_exit(scene, rays[ray], rays[count + ray], rays[2u * count + ray]);
#else
    __global uint2* pairs = (__global uint2*)(output + output_word(launch, pixel));
#if defined(SEGMENTS) || defined(TALLY) || defined(ABSORB)
    uint ray = ray_index(pixel);
    uint count = ray_count(launch);
#ifdef TALLY
    LENGTH_SUMS sums = output + GUARD_WORDS + HIT_WORDS * count;
#else
    LENGTH_SUMS sums = NO_SUMS;
#endif
#ifdef ABSORB
    bool absorbs = true;
#else
    bool absorbs = false;
#endif
    Segments all = cross_tets(scene, launch.trace, sums, absorbs, rays[ray], rays[count + ray]);
    pairs[0] = (uint2)(all.first, all.last);
    pairs[1] = (uint2)(all.total, all.hash);
    pairs[2] = (uint2)(all.reversed, all.crossings);
#else
#ifdef RAYS
    uint ray = ray_index(pixel);
    Hit hit = trace_given(scene, launch.trace, rays[ray], rays[ray_count(launch) + ray]);
#else
#ifdef STARTS_OUTSIDE
    launch.trace.start_tet = NO_TET;
#endif
    Hit hit = trace(scene, launch.trace, primary_ray(launch.trace, pixel.x, pixel.y));
#endif
    pairs[0] = (uint2)(hit.face_id, hit.tet);
    pairs[1] = (uint2)(as_bits(hit.t), as_bits(hit.u));
    pairs[2] = (uint2)(as_bits(hit.v), hit.steps);
#endif
#endif
}

// Traces the tiles from launch.first_tile to end_tile - 1. counter: the next tile that no group has taken, for schedule
// persistent. session.cpp sets the arguments in this order.
__kernel __attribute__((reqd_work_group_size(GROUP_ITEMS, 1, 1))) void run_image(
    const LaunchParams launch, const uint end_tile, __global uint* restrict output, __global uint* restrict counter,
    __global const uint4* restrict rays
#define SCENE_ARRAY(element, name, member, binding) , __global const element* restrict name
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
#ifdef TETS_IN_PARTS
#define PART_ARGUMENT(number) , __global const uint4* restrict part_##number
    MORE_TET_PARTS(PART_ARGUMENT)
#endif
)
{
    SceneView scene;
    scene.divisions = launch.divisions;
    scene.domain = launch.domain;
#ifdef STACK_TOP
    __local uint group_words[STACK_ENTRY_WORDS * STACK_TOP * GROUP_ITEMS];
    scene.group_words = group_words;
#endif
#define SCENE_ARRAY(element, name, member, binding) scene.name = name;
#include KERNEL_ARRAYS_HEADER
#undef SCENE_ARRAY
#ifdef TETS_IN_PARTS
    scene.part_log2 = launch.part_log2;
#define SET_PART(number) scene.part_##number = part_##number;
    MORE_TET_PARTS(SET_PART)
#endif

#ifdef PERSISTENT
    // A group stays, and its first item fetches the group's next tile, until none is left (Aila, Laine, Karras 2012).
    // Two words in turn: while some items still read one of them, the next tile goes to the other. One barrier is
    // enough: the first item writes a word again only after a barrier that all items reach when they have read it.
    __local uint fetched[2];
    for (uint turn = 0u;; turn ^= 1u) {
        if (get_local_id(0) == 0u) fetched[turn] = atomic_inc(counter);
        barrier(CLK_LOCAL_MEM_FENCE);
        uint tile = fetched[turn];
        if (tile >= end_tile) break;
        run_item(scene, launch, tile, output, rays);
    }
#else
    run_item(scene, launch, launch.first_tile + (uint)get_group_id(0), output, rays);
#endif
}

#version 450
#extension GL_EXT_control_flow_attributes : require // dont_unroll
// A kernel as a compute shader (CMakeLists.txt): a thin entry around the shared text. A work group is a tile. TRACE,
// RAYS, SEARCH, SEGMENTS, TALLY or ABSORB: the task. With TRACE or RAYS, DEFERS_RAYS: rays at ties are deferred to the program
// with TRACES_DEFERRED, which traces only those.
layout(constant_id = 2) const bool selects_minima = false; // true if the driver's own minimum is slower
#define SELECTS_MINIMA selects_minima
#ifndef SCENE_IN_TEXELS
layout(constant_id = 3) const uint stack_top = 0u;
#define STACK_TOP stack_top
#else // for emulated devices: shared memory is memory as any other, and large arrays cost time (docs/spec/bvhs.md, B3)
layout(constant_id = 4) const uint stack_entries = 0u;
#define STACK_ENTRIES(most) (stack_entries == 0u ? (most) : stack_entries)
#endif
#ifdef DEFERS_RAYS
#define DEFERS_TIES true
#endif
#define GROUP_ITEMS (gl_WorkGroupSize.x * gl_WorkGroupSize.y)
#include "kernels/language/dialect_glsl.h"

layout(local_size_x = TILE_WIDTH, local_size_y_id = 0) in; // constant 0 is the tile's height

#include "kernels/language/vector.h"

#ifdef SCENE_IN_TEXELS
#include "kernels/language/scene_view_texels_glsl.h"
#else
#include "kernels/language/scene_view_glsl.h"
#endif

#ifdef TALLY // sums: their first word's number in the output
layout(std430, set = 0, binding = OUTPUT_BINDING) buffer Output
{
    uint output_words[];
};
#define LENGTH_SUMS uint
#define HAS_SUMS(sums) true
#define ADD_TO_SUM(sums, word, added) atomicAdd(output_words[(sums) + (word)], added)
#endif

#include "kernels/kernel.h"

layout(constant_id = 1) const bool starts_outside = false; // of all rays: no start in a tet is compiled
layout(push_constant) uniform Launch
{
    LaunchParams launch;
};
#ifndef TALLY
layout(std430, set = 0, binding = OUTPUT_BINDING) writeonly buffer Output
{
    uint output_words[];
};
#endif
#if defined(DEFERS_RAYS) || defined(TRACES_DEFERRED)
layout(std430, set = 0, binding = DEFERRED_BINDING) buffer Left
{
    uint deferred_words[];
};
#endif

#ifndef TRACE
#ifdef SCENE_IN_TEXELS
layout(set = 0, binding = FIRST_QUADS_BINDING + RAYS_BINDING) uniform usamplerBuffer rays;
#define RAY_QUAD(index) texelFetch(rays, int(index))
#else
layout(std430, set = 0, binding = RAYS_BINDING) restrict readonly buffer Rays
{
    uint4 rays[];
};
#define RAY_QUAD(index) rays[index]
#endif
#endif

// lavapipe gives each of its threads one run of successive groups, x first, z last. Here each thread has its own z
// (session.cpp), and tiles pass to the next z after every x, so that all threads have about as much to do for any
// image.
uint tile_of_group()
{
    uint run = gl_WorkGroupID.y * gl_NumWorkGroups.z + gl_WorkGroupID.z;
    return launch.first_tile + run * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

SceneView scene_view()
{
    return SceneView(launch.divisions, launch.domain, launch.part_log2);
}

#ifdef RAYS
Hit trace_pixel(Pixel pixel)
{
    uint ray = ray_index(pixel);
    return trace_given(scene_view(), launch.trace, RAY_QUAD(ray), RAY_QUAD(ray_count(launch) + ray));
}
#endif

#ifdef TRACE
Hit trace_pixel(Pixel pixel)
{
    TraceParams params = launch.trace;
    params.start_tet = starts_outside ? NO_TET : params.start_tet;
    return trace(scene_view(), params, primary_ray(params, pixel.x, pixel.y));
}
#endif

#if defined(TRACE) || defined(RAYS)
void write_hit(Hit hit, uint word)
{
    output_words[word] = hit.face_id;
    output_words[word + 1u] = hit.tet;
    output_words[word + 2u] = as_bits(hit.t);
    output_words[word + 3u] = as_bits(hit.u);
    output_words[word + 4u] = as_bits(hit.v);
    output_words[word + 5u] = hit.steps;
}
#endif

#ifdef DEFERS_RAYS
void leave(Pixel pixel)
{
    uint place = atomicAdd(deferred_words[DEFERRED_COUNT], 1u);
    if (place % GROUP_ITEMS == 0u) atomicAdd(deferred_words[0], 1u);
    deferred_words[DEFERRED_PIXELS + place] = pixel.y * launch.trace.width + pixel.x;
}
#endif

#ifdef TRACES_DEFERRED
void main()
{
    uint place = gl_WorkGroupID.x * GROUP_ITEMS + gl_LocalInvocationIndex;
    if (place >= deferred_words[DEFERRED_COUNT]) return;
    uint number = deferred_words[DEFERRED_PIXELS + place];
    Pixel pixel;
    pixel.x = number % launch.trace.width;
    pixel.y = number / launch.trace.width;
    write_hit(trace_pixel(pixel), output_word(launch, pixel));
}
#else
void main()
{
    Pixel pixel = pixel_of(launch, tile_of_group(), gl_LocalInvocationIndex);
    if (!is_in_image(launch, pixel)) return;
#ifdef SEARCH
    SceneView scene = scene_view();
    uint ray = ray_index(pixel);
    uint count = ray_count(launch);
    output_words[GUARD_WORDS + ray] =
        search_exit(scene, RAY_QUAD(ray), RAY_QUAD(count + ray), RAY_QUAD(2u * count + ray));
#elif defined(SEGMENTS) || defined(TALLY) || defined(ABSORB)
    uint ray = ray_index(pixel);
    uint count = ray_count(launch);
    uint sums = GUARD_WORDS + HIT_WORDS * count;
#ifdef ABSORB
    bool absorbs = true;
#else
    bool absorbs = false;
#endif
    Segments all = cross_tets(scene_view(), launch.trace, sums, absorbs, RAY_QUAD(ray), RAY_QUAD(count + ray));
    uint word = output_word(launch, pixel);
    output_words[word] = all.first;
    output_words[word + 1u] = all.last;
    output_words[word + 2u] = all.total;
    output_words[word + 3u] = all.hash;
    output_words[word + 4u] = all.reversed;
    output_words[word + 5u] = all.crossings;
#else
    Hit hit = trace_pixel(pixel);
#ifdef DEFERS_RAYS
    if (hit.face_id == DEFERRED) leave(pixel);
#endif
    write_hit(hit, output_word(launch, pixel));
#endif
}
#endif
